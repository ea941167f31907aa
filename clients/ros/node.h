/// A ROS 2 node on DDS: its participant, the names of its endpoints, and what it says of itself to `ros2 node list`.
#pragma once

#include <functional>
#include <memory>
#include <set>

#include "idl/domain.h"
#include "idl/ros_topics.h"

namespace plab::ros
{

namespace msg = wire::ros;

struct NodeOptions
{
    wire::DomainOptions domain;
    std::string space;  ///< namespace: "", or with '/' in front
    std::string name;   ///< a token
};

/// Endpoints of the node. Readers and writers must not outlive it.
class Node
{
public:
    static Result<Node> join(const NodeOptions& options);

    /// An endpoint of this topic. Once all are made, call announce().
    Result<wire::Entity> make_writer(const std::string& topic, const dds_topic_descriptor_t* type, const msg::Profile& profile,
                                     const std::string& hash, const std::string& extra = {});
    Result<wire::Entity> make_reader(const std::string& topic, const dds_topic_descriptor_t* type, const msg::Profile& profile,
                                     const std::string& hash, const std::string& extra = {});
    /// Tells other nodes of this one and its endpoints.
    Result<void> announce();

    const wire::Entity& participant() const { return participant_; }
    const NodeOptions& options() const { return options_; }

private:
    using Create = dds_entity_t (*)(dds_entity_t, dds_entity_t, const dds_qos_t*, const dds_listener_t*);
    Result<wire::Entity> make(Create create, const wire::Entity& parent, const std::string& topic, const dds_topic_descriptor_t* type,
                              const wire::Qos& qos);

    NodeOptions options_;
    wire::Participant participant_;
    wire::Entity publisher_, subscriber_, graph_;
    std::vector<dds_entity_t> readers_, writers_;
};

/// Number of the endpoints that are matched now.
std::uint32_t readers_of(const wire::Entity& writer);
std::uint32_t writers_of(const wire::Entity& reader);

template <class Message>
class Publisher
{
public:
    static Result<Publisher> make(Node& node, const msg::MessageTopic& topic)
    {
        auto writer = node.make_writer(msg::topic_name(node.options().space, topic.name), topic.type, topic.profile, topic.type_hash);
        if (!writer) return writer.errors();
        Publisher out;
        out.writer_ = writer.take();
        return out;
    }
    void write(const Message& message) { (void)dds_write(writer_.get(), &message); }
    std::uint32_t readers() const { return readers_of(writer_); }
    /// Whether readers have come since the last call.
    bool has_newcomers()
    {
        dds_publication_matched_status_t status{};
        if (dds_get_publication_matched_status(writer_.get(), &status) < 0) return false;
        const bool is_new = status.total_count != ever_;
        ever_ = status.total_count;
        return is_new;
    }

private:
    wire::Entity writer_;
    std::uint32_t ever_ = 0;
};

/// Who asked for a service.
struct ServiceCaller
{
    std::uint64_t client = 0;  ///< as it named itself; sent back
    std::int64_t sequence_number = 0;
    dds_instance_handle_t writer = 0;  ///< of the request
};

/// Finds out whether the client that wrote a request can already receive the response, as rmw_cyclonedds_cpp does: its reader and its
/// writer have the same `clientid` in their USER_DATA. Waits for its reader, 0.1 s at most; a client that let it wait in vain is not waited
/// for again.
class ClientCheck
{
public:
    void wait_for_reader(const wire::Entity& requests, const wire::Entity& responses, dds_instance_handle_t request_writer);

private:
    std::set<dds_instance_handle_t> seen_;  ///< writers whose reader was found, or waited for in vain
};

/// One end of a service: requests in, responses out.
template <class OneService>
class ServiceServer
{
public:
    using Request = typename OneService::Request;
    using Response = typename OneService::Response;

    static Result<std::unique_ptr<ServiceServer>> make(Node& node, const std::string& id)
    {
        const msg::ServiceInfo& info = msg::service_of<OneService>();
        const NodeOptions& o = node.options();
        const std::string extra = "serviceid=" + id + ";";
        auto out = std::make_unique<ServiceServer>();
        // The writer comes first: a client that has found the reader, and asks at once, then has a writer to get its response from.
        auto responses =
            node.make_writer(msg::reply_name(o.space, o.name, info.name), info.response, msg::kServiceProfile, info.response_hash, extra);
        if (!responses) return responses.errors();
        auto requests =
            node.make_reader(msg::request_name(o.space, o.name, info.name), info.request, msg::kServiceProfile, info.request_hash, extra);
        if (!requests) return requests.errors();
        out->responses_ = responses.take(), out->requests_ = requests.take();
        return out;
    }

    /// Hands over one request, if there is one: handle(const Request&, ServiceCaller).
    template <class Handle>
    bool take(Handle&& handle)
    {
        void* sample = nullptr;
        dds_sample_info_t info{};
        const dds_return_t n = dds_take(requests_.get(), &sample, &info, 1, 1);
        if (n <= 0) return false;
        if (info.valid_data)
        {
            const auto& request = *static_cast<const Request*>(sample);
            handle(request, ServiceCaller{request.client, request.sequence_number, info.publication_handle});
        }
        (void)dds_return_loan(requests_.get(), &sample, n);
        return true;
    }
    void respond(const ServiceCaller& caller, Response& response)
    {
        response.client = caller.client, response.sequence_number = caller.sequence_number;
        check_.wait_for_reader(requests_, responses_, caller.writer);
        (void)dds_write(responses_.get(), &response);
    }
    std::uint32_t clients() const { return writers_of(requests_); }
    const wire::Entity& requests() const { return requests_; }

private:
    wire::Entity responses_, requests_;
    ClientCheck check_;
};

}  // namespace plab::ros
