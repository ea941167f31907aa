// Earlier and alternative states of a live server: snapshots, branches, shadows, and a recorder beside a reader of the bus.
#include "server.h"

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

using namespace plab;
using namespace plab::test;
using Json = nlohmann::json;

namespace
{

Json parse(const Outcome& outcome)
{
    REQUIRE_MESSAGE(outcome.code == 0, outcome.errors);
    const Json out = Json::parse(outcome.output, nullptr, false);
    REQUIRE_MESSAGE(!out.is_discarded(), outcome.output);
    return out;
}

struct StepHash
{
    std::int64_t step = -1;
    std::uint64_t hash = 0;
    bool operator==(const StepHash&) const = default;
};

/// The present state of a server: a new reader of snapshots gets one.
StepHash hash_of(const std::string& server)
{
    link::SessionOptions options;
    options.server = server;
    const auto session = link::Session::find(options, Seconds(5));
    REQUIRE_MESSAGE(session.ok(), session.error().text());
    auto reader = session->reader<plab_v2_Snapshot>();
    REQUIRE(reader.ok());
    StepHash out;
    for (int i = 0; i < 50 && out.step < 0; ++i)
    {
        (void)session->wait(*reader, Seconds(0.1));
        (void)reader->take(
            [&](const plab_v2_Snapshot& s, const dds_sample_info_t& info)
            {
                if (info.valid_data) out = {s.step, s.state_hash};
            });
    }
    REQUIRE(out.step >= 0);
    return out;
}

void step(const std::string& server, std::int64_t from, std::int64_t to)
{
    REQUIRE(run({program("plabctl"), "--server", server, "step", std::to_string(to - from)}).code == 0);
    REQUIRE(run({program("plabctl"), "--server", server, "wait", "--step", std::to_string(to)}).code == 0);
}

std::vector<std::string> with(std::vector<std::string> options, const std::vector<std::string>& more)
{
    options.insert(options.end(), more.begin(), more.end());
    return options;
}

/// A paused server that moves only when it is stepped, at step 60.
Server at_sixty(const std::vector<std::string>& options = {})
{
    Server server(scene_file("fan_and_balloons.xml"), with({"--paused", "--rate", "max"}, options));
    step(server.name(), 0, 60);
    return server;
}

/// A server that plabctl started for this test: it ends with the object.
class Stranger
{
public:
    explicit Stranger(int process) : process_(process) {}
    Stranger(const Stranger&) = delete;
    Stranger& operator=(const Stranger&) = delete;
    ~Stranger() { (void)::kill(process_, SIGKILL); }

private:
    int process_;
};

/// What `plabctl servers` shows about one of them.
Json shown(const std::string& name)
{
    const Json all = parse(run({program("plabctl"), "servers", "--json"}));
    for (const Json& s : all["servers"])
        if (s["name"] == name) return s;
    FAIL("no server ", name, " is shown");
    return {};
}

}  // namespace

TEST_CASE("a snapshot has a name, is listed, and is restored bit for bit")
{
    Server server = at_sixty();
    const StepHash before = hash_of(server.name());
    REQUIRE(before.step == 60);
    CHECK(control(server, {"snapshot", "before"}).code == 0);
    for (const char* name : {"a/b", "a b", ""}) CHECK(control(server, {"snapshot", name}).code == 2);
    CHECK(control(server, {"snapshot", std::string(65, 'a')}).code == 2);
    step(server.name(), 60, 90);
    CHECK(hash_of(server.name()).hash != before.hash);
    const Json kept = parse(control(server, {"snapshots", "--json"}));
    REQUIRE(kept["snapshots"].size() == 1);
    CHECK(kept["snapshots"][0]["name"] == "before");
    CHECK(kept["snapshots"][0]["step"] == 60);
    CHECK(kept["rewind_from"] == 0);
    CHECK(control(server, {"restore", "befor"}).code == 4);
    CHECK(control(server, {"restore", "before"}).code == 0);
    CHECK(hash_of(server.name()) == before);
    // A negative number does not say how far back to go.
    for (const char* option : {"--to", "--by"})
    {
        const Outcome negative = control(server, {"rewind", option, "-0.1"});
        CHECK(negative.code == 2);
        CHECK_MESSAGE(has(negative.errors, "negative"), negative.errors);
    }
    step(server.name(), 60, 84);
    CHECK(control(server, {"rewind", "--by", "0.1"}).code == 0);
    CHECK(hash_of(server.name()) == before);
    CHECK(server.end() == 0);
}

TEST_CASE("a branch appears beside its server and continues from the same state")
{
    Server server = at_sixty();
    const std::string name = unique_name("branch"), log = scratch_file("branch.log");
    const Json born = parse(control(server, {"branch", name, "--paused", "--log", log, "--json"}));
    const Stranger branch(born["process"].get<int>());
    CHECK(born["server"] == name);
    CHECK(born["step"] == 60);
    CHECK(hash_of(name) == hash_of(server.name()));
    CHECK(has(shown(name)["scene_file"].get<std::string>(), "fan_and_balloons.xml"));
    step(name, 60, 90);
    CHECK(hash_of(server.name()).step == 60);
    step(server.name(), 60, 90);
    CHECK(hash_of(name) == hash_of(server.name()));
    CHECK(run({program("plabctl"), "--server", name, "shutdown"}).code == 0);
    CHECK(control(server, {"branch", server.name(), "--log", log}).code == 1);  // the name is taken
    CHECK(server.end() == 0);
    std::filesystem::remove(log);
}

TEST_CASE("a shadow reports what a swap would do, without doing it")
{
    Server server = at_sixty();
    const StepHash before = hash_of(server.name());
    const Json reported = parse(control(server, {"shadow", "contact.response", "--with", "Response/None", "--for", "0.2", "--json"}));
    CHECK(reported["steps"] == 48);
    CHECK(reported["differences"].back()["time"].get<double>() == doctest::Approx(0.45));
    for (const char* future : {"without", "with"})
        for (const char* cost : {"cost_ns_per_step", "mean_cost_ns_per_step"}) CHECK(reported[future][cost].get<double>() > 0);
    // There is no contact yet: the two are the same, to the bit.
    CHECK(reported["differences"][0]["distance"] == 0.0);
    CHECK(reported["differences"][0]["turn"] == 0.0);
    CHECK(control(server, {"shadow", "contact.response", "--with", "Field/Gravity"}).code == 1);
    CHECK(hash_of(server.name()) == before);
    CHECK(server.end() == 0);
}

TEST_CASE("a snapshot is saved to a file, and a run from there equals the original run")
{
    const std::string file = scratch_file("keep.snapshot");
    Server server = at_sixty();
    REQUIRE(control(server, {"snapshot", "keep", "-o", file}).code == 0);
    step(server.name(), 60, 66);
    const StepHash after = hash_of(server.name());
    const Outcome loaded = run({program("plabd"), "--load", file, "--no-bus", "--until", "0.275", "--hashes"});
    REQUIRE_MESSAGE(loaded.code == 0, loaded.errors);
    char last[40];
    (void)std::snprintf(last, sizeof last, "66 %016llx\n", static_cast<unsigned long long>(after.hash));
    CHECK_MESSAGE(loaded.output.ends_with(last), loaded.output, last);
    const Outcome early = run({program("plabd"), "--load", file, "--no-bus", "--until", "0.2"});
    CHECK(early.code == 2);
    CHECK_MESSAGE(has(early.errors, "0.25"), early.errors);
    CHECK(server.end() == 0);
    std::filesystem::remove(file);
}

TEST_CASE("a recorder and a reader of the bus each receive all of their own samples")
{
    const std::string file = scratch_file("beside.mcap");
    std::filesystem::remove(file);
    {
        // The recorder gets each step or every fourth, the reader those due in real time: the two are independent.
        Server server(scene_file("fan_and_balloons.xml"), {"--record", file, "--record-states", "60", "--states", "25"});
        const Outcome watched = control(server, {"watch", "states", "-n", "12"});
        CHECK(watched.code == 0);
        CHECK_MESSAGE(!has(watched.errors, "not delivered"), watched.errors);
        CHECK(shown(server.name())["recording"]["file"] == file);
        CHECK(server.end() == 0);
    }
    const Outcome info = run({program("plabctl"), "info", file});
    CHECK_MESSAGE(info.code == 0, info.errors);
    CHECK_MESSAGE(!has(info.output, "gap"), info.output);
    std::filesystem::remove(file);
}
