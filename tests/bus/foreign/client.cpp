// A client of another vendor (eProsima Fast DDS) that uses nothing of pLab but idl/plab.idl: it reads frames, exchanges an
// interaction and gets the reply. It prints its results, one "name value" per line.
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <plabPubSubTypes.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace
{

namespace dds = eprosima::fastdds::dds;
using Clock = std::chrono::steady_clock;
using namespace plab::v2;

/// Loopback, UDP over IPv4, no multicast, like the server. Peers are contacted at the ports of participants 0 to 60.
dds::DomainParticipantQos loopback(std::uint32_t domain)
{
    dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
    auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList = {"127.0.0.1"};
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(udp);
    eprosima::fastrtps::rtps::Locator_t here;
    here.kind = LOCATOR_KIND_UDPv4;
    eprosima::fastrtps::rtps::IPLocator::setIPv4(here, "127.0.0.1");
    here.port = 0;
    qos.wire_protocol().builtin.metatrafficUnicastLocatorList.push_back(here);
    for (std::uint32_t i = 0; i <= 60; ++i)
    {
        here.port = 7400 + 250 * domain + 10 + 2 * i;
        qos.wire_protocol().builtin.initialPeersList.push_back(here);
    }
    return qos;
}

bool until(const std::function<bool()>& holds, double seconds)
{
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    while (!holds())
    {
        if (Clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
    return true;
}

class Client
{
public:
    Client(std::uint32_t domain, const std::string& server)
    {
        participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(domain, loopback(domain));
        dds::PublisherQos publisher = dds::PUBLISHER_QOS_DEFAULT;
        dds::SubscriberQos subscriber = dds::SUBSCRIBER_QOS_DEFAULT;
        publisher.partition().push_back(server.c_str()), subscriber.partition().push_back(server.c_str());
        publisher_ = participant_->create_publisher(publisher);
        subscriber_ = participant_->create_subscriber(subscriber);
    }
    ~Client()
    {
        participant_->delete_contained_entities();
        dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
    }
    template <class Type>
    dds::DataReader* reader(const char* topic, bool late_too = false)
    {
        dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
        qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
        if (late_too) qos.durability().kind = dds::TRANSIENT_LOCAL_DURABILITY_QOS;
        // Samples are as large as the scene: no memory is reserved for the largest one.
        qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
        return subscriber_->create_datareader(made<Type>(topic), qos);
    }
    template <class Type>
    dds::DataWriter* writer(const char* topic)
    {
        dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
        qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
        qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
        qos.history().kind = dds::KEEP_ALL_HISTORY_QOS;
        qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
        return publisher_->create_datawriter(made<Type>(topic), qos);
    }

private:
    template <class Type>
    dds::Topic* made(const char* topic)
    {
        dds::TypeSupport type(new Type);
        type.register_type(participant_);
        return participant_->create_topic(topic, type.get_type_name(), dds::TOPIC_QOS_DEFAULT);
    }

    dds::DomainParticipant* participant_;
    dds::Publisher* publisher_;
    dds::Subscriber* subscriber_;
};

/// Received samples, one after the other.
template <class T, class Handle>
void take(dds::DataReader* reader, Handle handle)
{
    T sample;
    dds::SampleInfo info;
    while (reader->take_next_sample(&sample, &info) == ReturnCode_t::RETCODE_OK)
        if (info.valid_data) handle(sample);
}

bool is_matched(dds::DataWriter* writer)
{
    dds::PublicationMatchedStatus status;
    writer->get_publication_matched_status(status);
    return status.current_count > 0 || status.total_count > 0;
}

bool is_matched(dds::DataReader* reader)
{
    dds::SubscriptionMatchedStatus status;
    reader->get_subscription_matched_status(status);
    return status.current_count > 0 || status.total_count > 0;
}

int fail(const char* why) { return std::fprintf(stderr, "foreign client: %s\n", why), 1; }

/// 16 random bytes, chosen once.
plab::v2::ClientId some_id()
{
    std::random_device random;
    plab::v2::ClientId id{};
    for (std::uint8_t& byte : id) byte = static_cast<std::uint8_t>(random());
    return id;
}

Request a_swap(std::uint64_t number, const std::string& target, const std::string& type)
{
    Operation swap;
    swap.verb("swap"), swap.target(target), swap.argument(type);
    Request request;
    static const plab::v2::ClientId id = some_id();
    request.client(id), request.number(number), request.at(-1), request.revision(-1);
    request.operations({swap});
    return request;
}

int run(std::uint32_t domain, const std::string& server, const std::string& target, const std::vector<std::string>& types)
{
    Client client(domain, server);
    dds::DataReader* const objects = client.reader<SceneObjectPubSubType>("plab/objects", true);
    dds::DataReader* const frames = client.reader<FramePubSubType>("plab/states");
    dds::DataReader* const replies = client.reader<ReplyPubSubType>("plab/replies");
    dds::DataWriter* const requests = client.writer<RequestPubSubType>("plab/requests");
    if (!until([&] { return is_matched(frames) && is_matched(replies) && is_matched(requests) && is_matched(objects); }, 10))
        return fail("no match with the server");

    std::size_t seen = 0, bodies = 0, catalogue = 0;
    std::int64_t step = -1;
    const auto note = [&](const Frame& f) { ++seen, bodies = f.bodies().size(), step = std::max<std::int64_t>(step, f.step()); };
    if (!until([&] { return take<Frame>(frames, note), seen >= 30; }, 10)) return fail("no frames");
    (void)until([&] { return take<SceneObject>(objects, [&](const SceneObject&) { ++catalogue; }), catalogue > 0; }, 5);
    std::printf("frames %zu\nbodies %zu\nobjects %zu\nstep %lld\n", seen, bodies, catalogue, static_cast<long long>(step));

    std::vector<double> ms;
    for (std::uint64_t number = 1; number <= 20; ++number)
    {
        const auto begin = Clock::now();
        const Request request = a_swap(number, target, types[number % types.size()]);
        bool answered = false, done = false;
        std::string why;
        const auto listen = [&](const Reply& r)
        {
            if (r.number() != number) return;
            answered = true, done = r.outcome() == "done";
            if (!r.reasons().empty()) why = r.reasons()[0];
        };
        // Like every client, it repeats the request until there is an answer; the number makes that harmless.
        for (int i = 0; i < 5 && !answered; ++i)
        {
            requests->write(const_cast<Request*>(&request));
            (void)until([&] { return take<Reply>(replies, listen), answered; }, 1);
        }
        if (!answered) return fail("no reply");
        if (!done) return fail(why.c_str());
        ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
    }
    std::sort(ms.begin(), ms.end());
    std::printf("swaps %zu\nreply_ms_median %.3f\nreply_ms_longest %.3f\n", ms.size(), ms[ms.size() / 2], ms.back());
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc < 6) return std::fputs("usage: foreign_client DOMAIN SERVER COMPONENT TYPE TYPE...\n", stderr), 2;
    return run(static_cast<std::uint32_t>(std::atoi(argv[1])), argv[2], argv[3], {argv + 4, argv + argc});
}
