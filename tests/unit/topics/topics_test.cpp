// plabctl in processes of its own, against writers in this one.
#include <doctest/doctest.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "foreign.h"
#include "idl/domain.h"
#include "support/process.h"
#include "support/text.h"

using namespace plab;
using namespace plab::test;
using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

namespace
{

std::uint32_t domain() { return 10 + static_cast<std::uint32_t>(getpid()) % 50; }

std::vector<std::string> topics_command(std::vector<std::string> arguments)
{
    std::vector<std::string> all{program("plabctl"), "--domain", std::to_string(domain()), "topics"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return all;
}
Outcome topics(std::vector<std::string> arguments) { return run(topics_command(std::move(arguments)), 30s); }

std::vector<Json> lines(const std::string& text)
{
    std::vector<Json> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) out.push_back(Json::parse(line));
    return out;
}

/// A participant with writers, of pLab's types and of a foreign one.
class Bus
{
public:
    Bus()
    {
        auto joined = wire::join({domain(), {}});
        REQUIRE(joined);
        participant_ = joined.take();
    }
    const wire::Entity& participant() const { return participant_; }

    /// A writer of a foreign type in the default partition.
    wire::Entity foreign(const dds_topic_descriptor_t& type, const char* name, bool keeps)
    {
        const wire::Qos qos(dds_create_qos());
        dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
        if (keeps) dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
        const dds_entity_t topic = dds_create_topic(participant_.get(), &type, name, nullptr, nullptr);
        REQUIRE(topic > 0);
        wire::Entity writer(dds_create_writer(participant_.get(), topic, qos.get(), nullptr));
        REQUIRE(writer.valid());
        return writer;
    }

private:
    wire::Participant participant_;
};

/// Writes `sample` every `period` until the end of its scope.
template <class Write>
class Ticker
{
public:
    Ticker(std::chrono::microseconds period, Write write)
        : thread_(
              [this, period, write]
              {
                  for (auto next = std::chrono::steady_clock::now(); !done_; next += period)
                      write(), std::this_thread::sleep_until(next + period);
              })
    {
    }
    ~Ticker()
    {
        done_ = true;
        thread_.join();
    }

private:
    std::atomic<bool> done_{false};
    std::thread thread_;
};

struct TopicWriters
{
    Bus bus;
    std::string server = unique_name("topics");
    wire::Entity publisher = wire::make_publisher(bus.participant(), server).take();
    wire::DataWriter<plab_v2_Frame> frames = wire::DataWriter<plab_v2_Frame>::make(bus.participant(), publisher).take();
    wire::DataWriter<plab_v2_SceneObject> objects = wire::DataWriter<plab_v2_SceneObject>::make(bus.participant(), publisher).take();
};

plab_v2_SceneObject object(const char* id)
{
    plab_v2_SceneObject o{};
    o.component_id = const_cast<char*>(id);
    o.mass = 0.5;
    return o;
}

stranger_Reading reading()
{
    static stranger_Point points[2]{{{7}, 0.5f, -1.0f}, {{8}, 2.0f, 0.1f}};
    static std::int16_t numbers[3]{1, -2, 3};
    static dds_sequence_short rows[2]{{2, 2, numbers, false}, {1, 1, numbers + 2, false}};
    stranger_Reading r{};
    r.sensor = const_cast<char*>("north");
    std::snprintf(r.place, sizeof r.place, "%s", "on the roof");
    r.color = stranger_BLUE;
    for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 3; ++k) r.matrix[i][k] = 10 * i + k;
    r.points._length = r.points._maximum = 2, r.points._buffer = points;
    r.rows._length = r.rows._maximum = 2;
    r.rows._buffer = reinterpret_cast<decltype(r.rows._buffer)>(rows);
    for (std::uint8_t i = 0; i < 4; ++i) r.raw[i] = static_cast<std::uint8_t>(250 + i);
    r.letter = 'z', r.valid = true, r.count = 1ull << 63;
    return r;
}

}  // namespace

TEST_CASE("list shows pLab's topics and foreign ones")
{
    TopicWriters writers;
    const wire::Entity writer = writers.bus.foreign(stranger_Reading_desc, "readings", true);
    const auto reader = wire::make_subscriber(writers.bus.participant(), writers.server);
    const Outcome out = topics({"--json"});
    REQUIRE_MESSAGE(out.code == 0, out.errors);
    Json frames, readings;
    const Json all = Json::parse(out.output);
    for (const Json& topic : all["topics"])
    {
        if (topic["topic"] == "plab/states" && topic["partitions"][0] == writers.server) frames = topic;
        if (topic["topic"] == "readings") readings = topic;
    }
    CHECK(frames["type"] == "plab::v2::Frame");
    CHECK(frames["plab"] == true);
    CHECK(frames["writers"] == 1);
    CHECK(has(frames["qos"][0].get<std::string>(), "reliable"));
    CHECK(readings["type"] == "stranger::Reading");
    CHECK(readings["plab"] == false);
    CHECK(readings["partitions"] == Json::array({""}));
    CHECK(has(readings["qos"][0].get<std::string>(), "transient local"));
    const Outcome table = topics({"list"});
    CHECK(has(table.output, "plab/states"));
    CHECK(has(table.output, "(default)"));
}

TEST_CASE("a foreign sample is printed with its names, as a tree and as JSON")
{
    Bus bus;
    const wire::Entity writer = bus.foreign(stranger_Reading_desc, "readings", true);
    const stranger_Reading sample = reading();
    REQUIRE(dds_write(writer.get(), &sample) == 0);
    const Outcome out = topics({"print", "readings", "-n", "1", "--json"});
    REQUIRE_MESSAGE(out.code == 0, out.errors);
    CHECK(Json::parse(out.output)["sample"].dump() ==
          R"({"sensor":"north","place":"on the roof","color":"BLUE","matrix":[[0.0,1.0,2.0],[10.0,11.0,12.0]],)"
          R"("points":[{"id_number":7,"x":0.5,"y":-1.0},{"id_number":8,"x":2.0,"y":0.1}],)"
          R"("rows":[[1,-2],[3]],"raw":[250,251,252,253],"letter":"z","valid":true,"count":9223372036854775808})");
    const Outcome tree = topics({"print", "readings", "-n", "1"});
    CHECK(has(tree.output, "sensor: \"north\"\n"));
    CHECK(has(tree.output, "points:\n  - {id_number: 7, x: 0.5, y: -1}\n"));
}

TEST_CASE("an appendable type, which only XCDR2 carries, is read as well")
{
    Bus bus;
    const wire::Entity writer = bus.foreign(stranger_Growing_desc, "growing", true);
    char* words[2]{const_cast<char*>("one"), const_cast<char*>("three")};
    stranger_Growing sample{};
    sample.number = -5, sample.value = 0.25, sample.color = stranger_RED;
    sample.words._length = sample.words._maximum = 2, sample.words._buffer = words;
    REQUIRE(dds_write(writer.get(), &sample) == 0);
    const Outcome out = topics({"print", "growing", "-n", "1", "--json"});
    REQUIRE_MESSAGE(out.code == 0, out.errors);
    CHECK(Json::parse(out.output)["sample"].dump() == R"({"number":-5,"words":["one","three"],"color":"RED","value":0.25})");
}

TEST_CASE("types that are not understood are reported by name, and are measured nevertheless")
{
    Bus bus;
    const wire::Entity writer = bus.foreign(stranger_Undecided_desc, "undecided", false);
    stranger_Undecided sample{};
    sample.choice._d = 1;
    const Ticker ticker(20ms, [&] { (void)dds_write(writer.get(), &sample); });
    const Outcome out = topics({"print", "undecided", "-n", "1"});
    CHECK(out.code == 1);
    CHECK(has(out.errors, "'choice' is a union, which is not supported"));
    CHECK(topics({"rate", "undecided", "-n", "1"}).code == 0);
    const wire::Entity labels = bus.foreign(stranger_Labelled_desc, "labelled", false);
    const Outcome labelled = topics({"rate", "labelled", "-n", "1"});
    CHECK(labelled.code == 1);
    CHECK(has(labelled.errors, "a bounded string in its key"));
}

TEST_CASE("disposed instances are reported by their key")
{
    TopicWriters writers;
    // A key as long as ids are: Cyclone DDS has a field of 16 bytes for those that it takes for short ones.
    const plab_v2_SceneObject red = object("red.arm.upper.hinge.with_a_long_name"), blue = object("blue");
    Process process(topics_command({"print", "plab/objects", "--partition", writers.server, "--json", "-n", "3"}));
    REQUIRE(writers.objects.write(red) == 0);
    REQUIRE(writers.objects.write(blue) == 0);
    REQUIRE(process.wait_for("\"red.arm", 10s));
    REQUIRE(writers.objects.dispose(red) == 0);
    REQUIRE(process.wait(10s) == 0);
    const auto all = lines(process.output());
    REQUIRE(all.size() == 3);
    CHECK(all[0]["sample"]["mass"] == 0.5);
    CHECK(all[2]["gone"] == true);
    CHECK(all[2]["key"].dump() == R"({"component_id":"red.arm.upper.hinge.with_a_long_name"})");
}

TEST_CASE("rate and bandwidth measure what is written")
{
    TopicWriters writers;
    std::vector<plab_v2_BodyState> bodies(100);
    plab_v2_Frame frame{};
    frame.bodies._length = frame.bodies._maximum = 100, frame.bodies._buffer = bodies.data();
    const Ticker ticker(10ms, [&] { (void)writers.frames.write(frame); });
    const Outcome rate = topics({"rate", "plab/states", "--partition", writers.server, "-n", "2", "--json"});
    REQUIRE_MESSAGE(rate.code == 0, rate.errors);
    const auto reports = lines(rate.output);
    REQUIRE(reports.size() == 2);
    CHECK(reports[1]["rate"].get<double>() == doctest::Approx(100).epsilon(0.2));
    CHECK(reports[1]["period"]["mean"].get<double>() == doctest::Approx(0.01).epsilon(0.2));
    CHECK(reports[1]["period"]["min"] <= reports[1]["period"]["mean"]);
    CHECK(reports[1]["period"]["max"] >= reports[1]["period"]["mean"]);
    const Outcome bytes = topics({"bandwidth", "plab/states", "--partition", writers.server, "-n", "1", "--json"});
    REQUIRE(bytes.code == 0);
    const Json report = lines(bytes.output).at(0);
    // Encoding, six numbers, count, 100 bodies of a handle and 13 numbers (the first is aligned as it is), count.
    CHECK(report["size"]["mean"] == 4 + 48 + 4 + 108 + 99 * 112 + 4);
    CHECK(report["size"]["stddev"] == 0);
    const Outcome human = topics({"rate", "plab/states", "--partition", writers.server, "-d", "1.2"});
    CHECK(has(human.output, " /s "));
    CHECK(has(human.output, "stddev"));
}

TEST_CASE("a topic without writers gives 3, with the nearest name; wrong use gives 2; Ctrl-C is a normal end")
{
    TopicWriters writers;
    const Outcome none = topics({"print", "plab/stats", "--timeout", "0.5"});
    CHECK(none.code == 3);
    CHECK(has(none.errors, "there is no writer of 'plab/stats'"));
    CHECK(has(none.errors, "plab/states"));
    // A server's name of this test's own: another test's server may be in this domain.
    CHECK(topics({"rate", "plab/states", "--partition", unique_name("silent"), "-d", "0.5"}).code == 3);
    CHECK(topics({"print"}).code == 2);
    CHECK(topics({"list", "plab/states"}).code == 2);
    CHECK(topics({"dance"}).code == 2);
    Process process(topics_command({"rate", "plab/states"}));
    REQUIRE(process.wait_for("/s", 10s));
    process.signal(SIGINT);
    CHECK(process.wait(5s) == 130);
}
