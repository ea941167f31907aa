#include "ros/node.h"

#include <cstring>

#include "ros/messages.h"

namespace plab::ros
{
namespace
{

void read_gid(dds_entity_t entity, rmw_dds_common_msg_dds__Gid_& out)
{
    dds_guid_t guid{};
    (void)dds_get_guid(entity, &guid);
    static_assert(sizeof out.data == sizeof guid.v);
    std::memcpy(out.data, guid.v, sizeof out.data);
}

/// The value of "key=value;" in the USER_DATA of an endpoint; "" if there is none.
std::string user_value(const dds_builtintopic_endpoint_t* endpoint, const std::string& key)
{
    void* data = nullptr;
    std::size_t size = 0;
    if (endpoint == nullptr || !dds_qget_userdata(endpoint->qos, &data, &size)) return {};
    const std::string text(static_cast<const char*>(data), data == nullptr ? 0 : size);
    dds_free(data);
    const std::size_t at = (";" + text).find(";" + key + "=");
    if (at == std::string::npos) return {};
    const std::size_t begin = at + key.size() + 1;
    return text.substr(begin, text.find(';', begin) - begin);
}

std::string client_of_writer(const wire::Entity& reader, dds_instance_handle_t writer)
{
    dds_builtintopic_endpoint_t* const endpoint = dds_get_matched_publication_data(reader.get(), writer);
    std::string out = user_value(endpoint, "clientid");
    if (endpoint != nullptr) dds_builtintopic_free_endpoint(endpoint);
    return out;
}

bool has_reader_of(const wire::Entity& writer, const std::string& client)
{
    std::vector<dds_instance_handle_t> readers(readers_of(writer));
    const dds_return_t n = dds_get_matched_subscriptions(writer.get(), readers.data(), readers.size());
    readers.resize(std::min(readers.size(), static_cast<std::size_t>(std::max(0, n))));
    bool found = false;
    for (const dds_instance_handle_t reader : readers)
    {
        dds_builtintopic_endpoint_t* const endpoint = dds_get_matched_subscription_data(writer.get(), reader);
        found = found || user_value(endpoint, "clientid") == client;
        if (endpoint != nullptr) dds_builtintopic_free_endpoint(endpoint);
    }
    return found;
}

}  // namespace

std::uint32_t readers_of(const wire::Entity& writer)
{
    dds_publication_matched_status_t status{};
    return dds_get_publication_matched_status(writer.get(), &status) < 0 ? 0 : status.current_count;
}

std::uint32_t writers_of(const wire::Entity& reader)
{
    dds_subscription_matched_status_t status{};
    return dds_get_subscription_matched_status(reader.get(), &status) < 0 ? 0 : status.current_count;
}

void ClientCheck::wait_for_reader(const wire::Entity& requests, const wire::Entity& responses, dds_instance_handle_t request_writer)
{
    constexpr std::size_t kMost = 1024;
    constexpr int kTries = 10;
    if (seen_.size() >= kMost) seen_.clear();
    if (!seen_.insert(request_writer).second) return;
    const std::string client = client_of_writer(requests, request_writer);
    // rmw_cyclonedds_cpp has had these ids since 2020; whoever has none is answered at once.
    if (client.empty()) return;
    for (int i = 0; i < kTries && !has_reader_of(responses, client); ++i) dds_sleepfor(DDS_MSECS(10));
}

Result<Node> Node::join(const NodeOptions& options)
{
    auto participant = wire::join(options.domain);
    if (!participant) return participant.errors();
    Node node;
    node.options_ = options, node.participant_ = participant.take();
    const wire::Qos qos(dds_create_qos());
    const std::string enclave = "enclave=/;";
    dds_qset_userdata(qos.get(), enclave.data(), enclave.size());
    if (const auto code = dds_set_qos(node.participant_.get(), qos.get()); code < 0) return wire::failed("cannot name the enclave", code);
    node.publisher_ = wire::Entity(dds_create_publisher(node.participant_.get(), nullptr, nullptr));
    node.subscriber_ = wire::Entity(dds_create_subscriber(node.participant_.get(), nullptr, nullptr));
    if (!node.publisher_.valid() || !node.subscriber_.valid()) return reason("cannot make a ROS node");
    // Not among the endpoints of the node: ROS counts it as the participant's.
    const msg::MessageTopic& graph = msg::kGraph;
    auto writer = node.make(&dds_create_writer, node.publisher_, graph.name, graph.type, msg::qos_of(graph.profile, graph.type_hash));
    if (!writer) return writer.errors();
    node.graph_ = writer.take();
    return node;
}

Result<wire::Entity> Node::make(Create create, const wire::Entity& parent, const std::string& topic, const dds_topic_descriptor_t* type,
                                const wire::Qos& qos)
{
    // An endpoint holds its topic.
    const wire::Entity made(dds_create_topic(participant_.get(), type, topic.c_str(), nullptr, nullptr));
    if (!made.valid()) return wire::failed("cannot create topic " + topic, made.get());
    const dds_entity_t endpoint = create(parent.get(), made.get(), qos.get(), nullptr);
    if (endpoint < 0) return wire::failed("cannot join topic " + topic, endpoint);
    return wire::Entity(endpoint);
}

Result<wire::Entity> Node::make_writer(const std::string& topic, const dds_topic_descriptor_t* type, const msg::Profile& profile,
                                       const std::string& hash, const std::string& extra)
{
    auto out = make(&dds_create_writer, publisher_, topic, type, msg::qos_of(profile, hash, extra));
    if (out) writers_.push_back(out->get());
    return out;
}

Result<wire::Entity> Node::make_reader(const std::string& topic, const dds_topic_descriptor_t* type, const msg::Profile& profile,
                                       const std::string& hash, const std::string& extra)
{
    auto out = make(&dds_create_reader, subscriber_, topic, type, msg::qos_of(profile, hash, extra));
    if (out) readers_.push_back(out->get());
    return out;
}

Result<void> Node::announce()
{
    wire::SequenceMemory memory;
    msg::ParticipantEntities entities{};
    read_gid(participant_.get(), entities.gid);
    auto& node = make_sequence(entities.node_entities_info_seq, 1, memory)[0];
    const std::string space = options_.space.empty() ? "/" : options_.space;
    std::strncpy(node.node_namespace, space.c_str(), sizeof node.node_namespace - 1);
    std::strncpy(node.node_name, options_.name.c_str(), sizeof node.node_name - 1);
    const auto readers = make_sequence(node.reader_gid_seq, readers_.size(), memory);
    const auto writers = make_sequence(node.writer_gid_seq, writers_.size(), memory);
    for (std::size_t i = 0; i < readers_.size(); ++i) read_gid(readers_[i], readers[i]);
    for (std::size_t i = 0; i < writers_.size(); ++i) read_gid(writers_[i], writers[i]);
    if (const auto code = dds_write(graph_.get(), &entities); code < 0) return wire::failed("cannot announce the ROS node", code);
    return {};
}

}  // namespace plab::ros
