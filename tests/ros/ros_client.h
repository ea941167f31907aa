/// A participant that uses topics and services as rmw_cyclonedds_cpp does.
#pragma once

#include <doctest/doctest.h>

#include <chrono>
#include <functional>
#include <optional>
#include <thread>

#include "idl/domain.h"
#include "ros/messages.h"
#include "ros/node.h"
#include "support/process.h"
#include "support/text.h"

namespace plab::test
{

/// Of these tests alone.
inline constexpr std::uint32_t kRosDomain = 91;

inline constexpr const char* kRosScene = PLAB_SOURCE_DIR "/tests/ros/scene.xml";

using Options = std::vector<std::string>;

class RosServer
{
public:
    explicit RosServer(const Options& options = {"--ros"}, const std::string& scene = kRosScene)
        : name_(unique_name("ros")), process_(command(scene, options))
    {
        REQUIRE_MESSAGE(process_.wait_for("ready after", Milliseconds(10000)), process_.errors());
    }
    Process& process() { return process_; }
    const Process& process() const { return process_; }
    const std::string& name() const { return name_; }
    std::string node() const { return wire::ros::token_of(name_); }

private:
    std::vector<std::string> command(const std::string& scene, const Options& options) const
    {
        std::vector<std::string> out{program("plabd"), scene, "--name", name_, "--domain", std::to_string(kRosDomain)};
        out.insert(out.end(), options.begin(), options.end());
        return out;
    }

    std::string name_;
    Process process_;
};

template <class Condition>
bool eventually(Condition condition, double seconds = 10)
{
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!condition())
    {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
}

template <class Message>
class RosReader
{
public:
    explicit RosReader(wire::Entity reader) : reader_(std::move(reader)) {}
    /// Hands over all that has arrived; their number.
    int take(const std::function<void(const Message&)>& handle)
    {
        int count = 0;
        void* sample = nullptr;
        dds_sample_info_t info{};
        while (dds_take(reader_.get(), &sample, &info, 1, 1) > 0)
        {
            if (info.valid_data) handle(*static_cast<const Message*>(sample)), ++count;
            (void)dds_return_loan(reader_.get(), &sample, 1);
        }
        return count;
    }
    std::uint32_t writers() const { return ros::writers_of(reader_); }

private:
    wire::Entity reader_;
};

class RosClient
{
public:
    RosClient()
    {
        auto participant = wire::join({kRosDomain, ""});
        REQUIRE(participant.ok());
        participant_ = participant.take();
    }
    const wire::Entity& participant() const { return participant_; }

    template <class Message>
    RosReader<Message> reader(const wire::ros::MessageTopic& topic, const std::string& space = "",
                              std::optional<wire::ros::Profile> profile = {})
    {
        const bool is_graph = topic.type == wire::ros::kGraph.type;
        return RosReader<Message>(endpoint(&dds_create_reader, is_graph ? topic.name : wire::ros::topic_name(space, topic.name), topic.type,
                                           wire::ros::qos_of(profile.value_or(topic.profile), topic.type_hash)));
    }
    wire::Entity endpoint(dds_entity_t (*create)(dds_entity_t, dds_entity_t, const dds_qos_t*, const dds_listener_t*),
                          const std::string& name, const dds_topic_descriptor_t* type, const wire::Qos& qos)
    {
        const wire::Entity topic(dds_create_topic(participant_.get(), type, name.c_str(), nullptr, nullptr));
        wire::Entity out(create(participant_.get(), topic.get(), qos.get(), nullptr));
        REQUIRE(out.valid());
        return out;
    }

private:
    wire::Participant participant_;
};

/// A client of one service.
template <class S>
class RosCaller
{
public:
    RosCaller(RosClient& client, const std::string& node, const std::string& space = "")
    {
        const wire::ros::ServiceInfo& info = wire::ros::service_of<S>();
        const std::string extra = "clientid=test" + std::to_string(++last_) + ";";
        requests_ = client.endpoint(&dds_create_writer, wire::ros::request_name(space, node, info.name), info.request,
                                    wire::ros::qos_of(wire::ros::kServiceProfile, info.request_hash, extra));
        responses_ = client.endpoint(&dds_create_reader, wire::ros::reply_name(space, node, info.name), info.response,
                                     wire::ros::qos_of(wire::ros::kServiceProfile, info.response_hash, extra));
        dds_instance_handle_t handle = 0;
        (void)dds_get_instance_handle(requests_.get(), &handle);
        id_ = handle;
        REQUIRE(eventually([&] { return ros::readers_of(requests_) == 1 && ros::writers_of(responses_) == 1; }));
    }
    void send(typename S::Request request)
    {
        request.client = id_, request.sequence_number = ++number_;
        REQUIRE(dds_write(requests_.get(), &request) == DDS_RETCODE_OK);
    }
    /// Sends the request, and hands over its response.
    void call(const typename S::Request& request, const std::function<void(const typename S::Response&)>& handle, double seconds = 10)
    {
        send(request);
        bool is_there = false;
        const auto look = [&]
        {
            void* sample = nullptr;
            dds_sample_info_t info{};
            while (dds_take(responses_.get(), &sample, &info, 1, 1) > 0)
            {
                const auto& response = *static_cast<const typename S::Response*>(sample);
                if (info.valid_data && response.client == id_ && response.sequence_number == number_) handle(response), is_there = true;
                (void)dds_return_loan(responses_.get(), &sample, 1);
            }
            return is_there;
        };
        REQUIRE_MESSAGE(eventually(look, seconds), wire::ros::service_of<S>().name);
    }
    /// The code of the result, and its text.
    std::pair<int, std::string> result(const typename S::Request& request, double seconds = 10)
    {
        std::pair<int, std::string> out;
        call(
            request,
            [&](const auto& response) {
                out = {response.result.result, ros::text_of(response.result.error_message)};
            },
            seconds);
        return out;
    }

private:
    static inline int last_ = 0;
    wire::Entity requests_, responses_;
    std::uint64_t id_ = 0;
    std::int64_t number_ = 0;
};

}  // namespace plab::test
