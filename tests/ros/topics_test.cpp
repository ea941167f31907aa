// What a ROS 2 machine sees of a server: endpoints, the graph, and what is on the topics.
#include <signal.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "idl/values/ros_names.h"
#include "ros/ros_client.h"

namespace plab::test
{
namespace
{

namespace msg = wire::ros;

struct Endpoint
{
    std::string type, user_data;
    bool is_reliable = false, is_kept = false;
    std::int32_t depth = 0;
    std::array<unsigned char, 16> key{};
};

/// What discovery says of all endpoints of others whose topics have this prefix.
std::map<std::string, Endpoint> endpoints(const RosClient& client, dds_entity_t builtin, const std::string& prefix)
{
    std::map<std::string, Endpoint> out;
    const wire::Entity reader(dds_create_reader(client.participant().get(), builtin, nullptr, nullptr));
    void* samples[512] = {};
    dds_sample_info_t infos[512];
    const dds_return_t n = dds_read(reader.get(), samples, infos, 512, 512);
    for (int i = 0; i < n; ++i)
    {
        const auto& e = *static_cast<const dds_builtintopic_endpoint_t*>(samples[i]);
        if (!infos[i].valid_data || infos[i].instance_state != DDS_IST_ALIVE || !std::string(e.topic_name).starts_with(prefix)) continue;
        Endpoint& to = out[e.topic_name];
        to.type = e.type_name;
        dds_reliability_kind_t reliability{};
        dds_durability_kind_t durability{};
        dds_history_kind_t history{};
        dds_duration_t blocking = 0;
        (void)dds_qget_reliability(e.qos, &reliability, &blocking);
        (void)dds_qget_durability(e.qos, &durability);
        (void)dds_qget_history(e.qos, &history, &to.depth);
        void* data = nullptr;
        std::size_t size = 0;
        (void)dds_qget_userdata(e.qos, &data, &size);
        to.user_data.assign(static_cast<const char*>(data), data == nullptr ? 0 : size);
        dds_free(data);
        to.is_reliable = reliability == DDS_RELIABILITY_RELIABLE, to.is_kept = durability == DDS_DURABILITY_TRANSIENT_LOCAL;
        std::memcpy(to.key.data(), &e.key, to.key.size());
    }
    (void)dds_return_loan(reader.get(), samples, n);
    return out;
}

TEST_CASE("discovery shows the topics of ROS with their types, QoS and type hashes, and the services")
{
    const RosServer server;
    RosClient client;
    std::map<std::string, Endpoint> topics;
    REQUIRE(eventually([&] { return (topics = endpoints(client, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, "rt/")).size() == 6; }));
    const auto check = [&](const char* name, const char* type, bool is_reliable, bool is_kept, const char* hash)
    {
        const Endpoint& e = topics[name];
        CHECK_MESSAGE(e.type == type, name);
        CHECK_MESSAGE(e.is_reliable == is_reliable, name);
        CHECK_MESSAGE(e.is_kept == is_kept, name);
        CHECK_MESSAGE(has(e.user_data, "typehash=RIHS01_" + std::string(hash)), name << ": " << e.user_data);
    };
    check("rt/clock", "rosgraph_msgs::msg::dds_::Clock_", false, false, "692f7a66");
    check("rt/tf", "tf2_msgs::msg::dds_::TFMessage_", true, false, "e369d0f0");
    check("rt/tf_static", "tf2_msgs::msg::dds_::TFMessage_", true, true, "e369d0f0");
    check("rt/joint_states", "sensor_msgs::msg::dds_::JointState_", true, false, "a13ee3a3");
    check("rt/visualization_marker_array", "visualization_msgs::msg::dds_::MarkerArray_", true, true, "86cb8800");
    check("rt/contacts", "ros_gz_interfaces::msg::dds_::Contacts_", true, false, "2cf36dd5");

    std::map<std::string, Endpoint> requests, replies;
    REQUIRE(eventually([&] { return (requests = endpoints(client, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, "rq/")).size() == 16; }));
    REQUIRE(eventually([&] { return (replies = endpoints(client, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, "rr/")).size() == 16; }));
    const Endpoint& request = requests["rq/" + server.node() + "/get_entitiesRequest"];
    const Endpoint& reply = replies["rr/" + server.node() + "/get_entitiesReply"];
    CHECK(request.type == "simulation_interfaces::srv::dds_::GetEntities_Request_");
    CHECK(reply.type == "simulation_interfaces::srv::dds_::GetEntities_Response_");
    const auto id_of = [](const Endpoint& e) { return e.user_data.substr(0, e.user_data.find(';')); };
    CHECK(id_of(request).starts_with("serviceid="));
    CHECK(id_of(request) == id_of(reply));
}

TEST_CASE("the graph names the node, and all its endpoints belong to it")
{
    const RosServer server(Options{"--ros", "--ros-namespace", "lab/sim"});
    RosClient client;
    auto graph = client.reader<msg::ParticipantEntities>(msg::kGraph);
    std::set<std::array<unsigned char, 16>> readers, writers;
    std::string space, name;
    const auto look = [&]
    {
        (void)graph.take(
            [&](const msg::ParticipantEntities& p)
            {
                REQUIRE(p.node_entities_info_seq._length == 1);
                const auto& node = p.node_entities_info_seq._buffer[0];
                space = node.node_namespace, name = node.node_name;
                const auto keep = [](const auto& gids, std::set<std::array<unsigned char, 16>>& to)
                {
                    for (const auto& gid : wire::items(gids))
                    {
                        std::array<unsigned char, 16> key{};
                        std::memcpy(key.data(), gid.data, key.size());
                        to.insert(key);
                    }
                };
                keep(node.reader_gid_seq, readers), keep(node.writer_gid_seq, writers);
            });
        return !name.empty();
    };
    REQUIRE(eventually(look));
    CHECK(space == "/lab/sim");
    CHECK(name == server.node());
    std::map<std::string, Endpoint> topics;
    REQUIRE(eventually([&] { return (topics = endpoints(client, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, "rt/lab/sim/")).size() == 6; }));
    for (const auto& [topic, e] : topics) CHECK_MESSAGE(writers.contains(e.key), topic);
    std::map<std::string, Endpoint> requests;
    REQUIRE(eventually(
        [&]
        { return (requests = endpoints(client, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, "rq/lab/sim/" + server.node() + "/")).size() == 16; }));
    for (const auto& [topic, e] : requests) CHECK_MESSAGE(readers.contains(e.key), topic);
    CHECK(writers.size() == 22);
    CHECK(readers.size() == 16);
}

/// The program that carries the bus of this server.
struct BusProgram
{
    std::string name;
    int pid = 0;
};
BusProgram bus_of(int server)
{
    for (const auto& entry : std::filesystem::directory_iterator("/proc"))
    {
        std::ifstream status((entry.path() / "stat").string());
        std::string pid, name, state;
        int parent = 0;
        if (status >> pid >> name >> state >> parent && parent == server && name.starts_with("(plab-bus"))
            return {name.substr(1, name.size() - 2), std::stoi(pid)};
    }
    return {};
}

TEST_CASE("without --ros there is no topic of ROS, and the program for it does not run")
{
    const RosServer server(Options{});
    RosClient client;
    REQUIRE(eventually([&] { return !endpoints(client, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, "plab/states").empty(); }));
    for (const char* prefix : {"rt/", "rr/", "ros_"}) CHECK(endpoints(client, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, prefix).empty());
    CHECK(endpoints(client, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, "rq/").empty());
    // The program that looks like a node is plab-bus-ros; plabd itself maps nothing of either.
    CHECK(bus_of(server.process().pid()).name == "plab-bus");
    const RosServer with_ros;
    CHECK(bus_of(with_ros.process().pid()).name == "plab-bus-ros");
}

TEST_CASE("what is published is what the scene does, under names that ROS accepts")
{
    const RosServer server;
    RosClient client;
    auto clock = client.reader<msg::Clock>(msg::kClock);
    auto tf = client.reader<msg::Transforms>(msg::kTransforms);
    auto joints = client.reader<msg::JointState>(msg::kJointStates);
    int clocks = 0, falls = 0, states = 0;
    std::set<std::string> names;
    const auto time_of = [](const msg::Time& t) { return t.sec + 1e-9 * t.nanosec; };
    double now = -1, rail = 0, rail_time = 0;
    const auto look = [&]
    {
        clocks += clock.take(
            [&](const msg::Clock& c)
            {
                CHECK(time_of(c.clock) >= now);
                now = time_of(c.clock);
            });
        (void)tf.take(
            [&](const msg::Transforms& m)
            {
                for (const auto& t : wire::items(m.transforms))
                {
                    names.insert(t.child_frame_id);
                    if (std::string(t.child_frame_id) != "ball") continue;
                    const double at = time_of(t.header.stamp);
                    CHECK(std::fabs(t.transform.translation.z - (100 - 0.5 * 9.81 * at * at)) < 1e-6);
                    ++falls;
                }
            });
        states += joints.take(
            [&](const msg::JointState& s)
            {
                const double at = time_of(s.header.stamp);
                REQUIRE(s.name._length == 3);
                REQUIRE(s.velocity._length == 3);
                for (std::uint32_t i = 0; i < 3; ++i)
                {
                    const std::string name = s.name._buffer[i];
                    const double rate = name == "pivot" ? 2 : name == "rotor" ? 3 : 0.5;
                    CHECK(std::fabs(s.position._buffer[i] - rate * at) < 1e-6);
                    CHECK(std::fabs(s.velocity._buffer[i] - rate) < 1e-9);
                    if (name == "rail") rail = s.position._buffer[i], rail_time = at;
                }
            });
        return clocks > 150 && falls > 150 && states > 150;
    };
    REQUIRE_MESSAGE(eventually(look, 15), clocks << " " << falls << " " << states);
    CHECK(rail > 0.4 * rail_time);
    CHECK(names == std::set<std::string>{"ball", "block", "arm", "cart", "rotor", "a_strange_name____"});
}

TEST_CASE("late joiners of a paused server get its clock, its poses, and what never changes")
{
    const RosServer server(Options{"--ros", "--paused"});
    RosClient first;
    auto clock = first.reader<msg::Clock>(msg::kClock);
    REQUIRE(eventually([&] { return clock.take([](const msg::Clock&) {}) > 0; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    auto fixed = first.reader<msg::Transforms>(msg::kStaticTransforms);
    auto kept = first.reader<msg::MarkerArray>(msg::kMarkers);
    auto tf = first.reader<msg::Transforms>(msg::kTransforms);
    std::uint32_t markers = 0, moving = 0;
    std::string ground;
    const auto look = [&]
    {
        (void)fixed.take([&](const msg::Transforms& m) { ground = m.transforms._buffer[0].child_frame_id; });
        (void)kept.take([&](const msg::MarkerArray& m) { markers = m.markers._length; });
        (void)tf.take([&](const msg::Transforms& m) { moving = m.transforms._length; });
        return !ground.empty() && markers > 0 && moving > 0;
    };
    REQUIRE_MESSAGE(eventually(look, 5), ground << " " << markers << " " << moving);
    CHECK(ground == "ground");
    CHECK(markers == 4);  // the first removes what was there
    CHECK(moving == 6);
}

TEST_CASE("a late reader of markers that keeps nothing, as RViz has it, gets them too")
{
    const RosServer server;
    RosClient client;
    auto clock = client.reader<msg::Clock>(msg::kClock);
    REQUIRE(eventually([&] { return clock.take([](const msg::Clock&) {}) > 0; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    // Alone: what is sent again to a reader that keeps, Cyclone hands to all readers of the process.
    auto markers = client.reader<msg::MarkerArray>(msg::kMarkers, "", msg::Profile{true, false, 10});
    std::uint32_t count = 0;
    CHECK(eventually([&] { return markers.take([&](const msg::MarkerArray& m) { count = m.markers._length; }) > 0; }, 5));
    CHECK(count == 4);
}

TEST_CASE("the node comes back when its process is killed, and the run goes on")
{
    const RosServer server;
    RosClient client;
    auto clock = client.reader<msg::Clock>(msg::kClock);
    double now = 0;
    const auto hears = [&](double after)
    {
        (void)clock.take([&](const msg::Clock& c) { now = c.clock.sec + 1e-9 * c.clock.nanosec; });
        return now > after;
    };
    REQUIRE(eventually([&] { return hears(0.2); }));
    REQUIRE(kill(bus_of(server.process().pid()).pid, SIGKILL) == 0);
    const double killed = now;
    CHECK(eventually([&] { return hears(killed + 1); }));
}

TEST_CASE("contacts come with the step in which they begin")
{
    const RosServer server;
    RosClient client;
    auto contacts = client.reader<msg::Contacts>(msg::kContacts);
    bool found = false;
    // The block falls from 2 m onto the ground at 0.5 m; its lower side is 0.125 m below its origin.
    const double falls = std::sqrt(2 * 1.375 / 9.81);
    const auto look = [&]
    {
        (void)contacts.take(
            [&](const msg::Contacts& m)
            {
                for (const auto& c : wire::items(m.contacts))
                {
                    const std::set<std::string> pair{c.collision1.name, c.collision2.name};
                    CHECK(pair == std::set<std::string>{"block", "ground"});
                    if (c.positions._length == 0) continue;
                    CHECK(std::fabs(std::fabs(c.normals._buffer[0].z) - 1) < 1e-9);
                    CHECK(std::fabs(c.positions._buffer[0].z - 0.5) < 0.02);
                    if (!found) CHECK(std::fabs(m.header.stamp.sec + 1e-9 * m.header.stamp.nanosec - falls) < 0.02);
                    found = true;
                }
            });
        return found;
    };
    CHECK(eventually(look));
}

}  // namespace
}  // namespace plab::test
