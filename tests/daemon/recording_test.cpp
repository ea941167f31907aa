// plabd --record, --replay, --load, --save, --shadow, as their user sees them.
#include <doctest/doctest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "idl/recording/cdr.h"
#include "idl/recording/reader.h"
#include "idl/recording/recovery.h"
#include "support/process.h"
#include "support/text.h"

namespace plab::test
{
namespace
{

constexpr Milliseconds kLong(60000);
const std::string kScene = scene_file("fan_and_balloons.xml");

Outcome plabd(std::vector<std::string> arguments)
{
    arguments.insert(arguments.begin(), program("plabd"));
    return run(std::move(arguments), kLong);
}

std::string fresh(const std::string& name)
{
    const std::string file = scratch_file(name);
    std::filesystem::remove(file);
    return file;
}

/// Hashes that --hashes prints, a line for each step.
std::vector<std::string> lines_of(const std::string& text)
{
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
}

/// The last message of a topic.
template <class T>
void read_last(const std::string& file, recording::Sample<T>& sample)
{
    auto reader = recording::McapReader::open(file);
    REQUIRE(reader);
    auto last = reader->last_at(wire::topic_of<T>().name, std::numeric_limits<std::uint64_t>::max());
    REQUIRE(last);
    REQUIRE(*last);
    recording::Decoder decoder;
    REQUIRE(decoder.decode((*last)->data, sample));
}

std::int64_t wall_ns()
{
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// Whether the run has begun, and is in the file.
bool has_hashes(const std::string& file)
{
    if (!std::filesystem::exists(file)) return false;
    const auto reader = recording::McapReader::open(file);
    return reader && !reader->channels_of({wire::topic_of<plab_v2_Hashes>().name}).empty();
}

/// The scene at 1 kHz.
std::string faster_scene()
{
    std::ostringstream text;
    text << std::ifstream(kScene).rdbuf();
    std::string scene = text.str();
    const std::string step = "dt=\"1/240\"";
    REQUIRE(scene.find(step) != std::string::npos);
    scene.replace(scene.find(step), step.size(), "dt=\"1/1000\"");
    const std::string file = scratch_file("fast.xml");
    std::ofstream(file) << scene;
    return file;
}

/// When the last step was made of which the file has the frame, and the hash: ns since 1970.
struct Newest
{
    std::int64_t frame_ns = 0, hash_ns = 0;
};

Newest newest_in(const std::string& file)
{
    auto reader = recording::McapReader::open(file);
    REQUIRE(reader);
    recording::Sample<plab_v2_Hashes> hashes;
    read_last(file, hashes);
    const std::int64_t hashed = hashes->step + hashes->values._length - 1;
    Newest out;
    recording::Decoder decoder;
    recording::Sample<plab_v2_Frame> frame;
    recording::Cursor frames = reader->messages({{wire::topic_of<plab_v2_Frame>().name}});
    for (auto next = frames.next(); next && *next; next = frames.next())
    {
        REQUIRE(decoder.decode((*next)->message.data, frame));
        out.frame_ns = frame->stamp_ns;
        if (frame->step <= hashed) out.hash_ns = frame->stamp_ns;
    }
    return out;
}

}  // namespace

TEST_CASE("a recorded run with swaps is the same run again, for one and for two threads, from any of its snapshots")
{
    const std::string file = fresh("swaps.mcap"), end = fresh("swaps.json");
    const Outcome recorded = plabd({kScene, "--no-bus", "--until", "6", "--record", file, "--record-snapshots", "1", "--out", end, "--swap",
                                    "300:contact.response=Response/None", "--swap", "700:gears=Constraint/AngularVelocity/Impulse", "--set",
                                    "900:red.mass=0.02"});
    REQUIRE_MESSAGE(recorded.code == 0, recorded.errors);
    for (const std::string threads : {"1", "2"})
    {
        const Outcome again = plabd({"--replay", file, "--verify", "--threads", threads});
        CHECK_MESSAGE(again.code == 0, again.output, again.errors);
        CHECK(has(again.output, "verified: 1440 state hashes are identical"));
        CHECK(has(again.output, "3 requests"));
    }
    const Outcome late = plabd({"--replay", file, "--verify", "--from", "1000"});
    CHECK_MESSAGE(late.code == 0, late.output, late.errors);
    CHECK(has(late.output, "verified: 480 state hashes are identical"));

    // The numbers in the file are the server's own, to the last digit.
    const auto json = nlohmann::json::parse(std::ifstream(end));
    recording::Sample<plab_v2_Frame> frame;
    read_last(file, frame);
    CHECK(frame->step == 1440);
    bool found = false;
    for (std::uint32_t i = 0; i < frame->bodies._length; ++i)
        found = found || (frame->bodies._buffer[i].position.x == json["objects"]["red"]["position"][0].get<double>() &&
                          frame->bodies._buffer[i].linear_velocity.z == json["objects"]["red"]["linear_velocity"][2].get<double>());
    CHECK(found);
    std::filesystem::remove(file);
}

TEST_CASE("a recording changes nothing, and without one its library is not there")
{
    const std::string file = fresh("silent.mcap");
    const Outcome with = plabd({kScene, "--no-bus", "--until", "2", "--hashes", "--record", file});
    const Outcome without = plabd({kScene, "--no-bus", "--until", "2", "--hashes"});
    REQUIRE(with.code == 0);
    REQUIRE(lines_of(with.output).size() == 480);
    CHECK(with.output == without.output);
    CHECK(!has(plabd({kScene, "--no-bus", "--until", "0.1", "--maps"}).output, "record.so"));
    CHECK(has(plabd({kScene, "--no-bus", "--until", "0.1", "--maps", "--record", file, "--overwrite"}).output, "record.so"));
    const Outcome twice = plabd({kScene, "--no-bus", "--until", "0.1", "--record", file});
    CHECK(twice.code == 1);
    CHECK_MESSAGE(has(twice.errors, file), twice.errors);
    std::filesystem::remove(file);
}

TEST_CASE("a run that was saved goes on as if it had never been left")
{
    const std::string file = fresh("half.snapshot");
    const Outcome whole = plabd({kScene, "--no-bus", "--until", "2", "--hashes"});
    REQUIRE(plabd({kScene, "--no-bus", "--until", "1", "--save", file}).code == 0);
    const Outcome rest = plabd({"--load", file, "--no-bus", "--until", "2", "--hashes"});
    REQUIRE_MESSAGE(rest.code == 0, rest.errors);
    const std::vector<std::string> all = lines_of(whole.output);
    REQUIRE(all.size() == 480);
    CHECK(lines_of(rest.output) == std::vector<std::string>(all.begin() + 240, all.end()));

    const Outcome shadow = plabd({"--load", file, "--shadow", "contact.response=Response/None", "--for", "1", "--json"});
    REQUIRE_MESSAGE(shadow.code == 0, shadow.errors);
    const auto json = nlohmann::json::parse(shadow.output);
    CHECK(json["from"] == "Response/Impulse");
    CHECK(json["steps"] == 240);
    CHECK(json["without"]["cost_ns_per_step"].get<double>() > 0);
    CHECK(json["differences"].back()["time"].get<double>() == doctest::Approx(2.0));
    const Outcome same = plabd({"--load", file, "--shadow", "contact.response=Response/Impulse", "--for", "1", "--json"});
    REQUIRE(same.code == 0);
    for (const auto& row : nlohmann::json::parse(same.output)["differences"]) CHECK(row["distance"] == 0.0);

    std::ofstream(file, std::ios::trunc) << "no snapshot";
    const Outcome damaged = plabd({"--load", file, "--no-bus", "--until", "2"});
    CHECK(damaged.code == 1);
    CHECK(has(damaged.errors, file));
    std::filesystem::remove(file);
}

TEST_CASE("a request that waits for its step goes with the snapshot, and takes effect there")
{
    const std::string file = fresh("waiting.snapshot");
    const std::string swap = "300:contact.response=Response/None", set = "310:red.mass=0.02";
    const Outcome whole = plabd({kScene, "--no-bus", "--until", "4", "--hashes", "--swap", swap, "--set", set});
    const Outcome half = plabd({kScene, "--no-bus", "--until", "1", "--swap", swap, "--set", set, "--save", file});
    CHECK_MESSAGE(half.code == 0, half.errors);
    const Outcome rest = plabd({"--load", file, "--no-bus", "--until", "4", "--hashes"});
    REQUIRE_MESSAGE(rest.code == 0, rest.errors);
    const std::vector<std::string> all = lines_of(whole.output);
    REQUIRE(all.size() == 960);
    CHECK(lines_of(rest.output) == std::vector<std::string>(all.begin() + 240, all.end()));
    // Without them the motion differs.
    const Outcome plain = plabd({kScene, "--no-bus", "--until", "4", "--hashes"});
    CHECK(lines_of(plain.output).back() != all.back());
    std::filesystem::remove(file);
}

TEST_CASE("killed at any moment: what is older than 20 ms is in the file, and is the same run again")
{
    constexpr int kKills = 10;
    // At 240 and at 1000 steps a second: each step's hash for itself, and hashes that are gathered.
    const std::string fast = faster_scene();
    // What a step is late by itself, and what else runs on the machine: one kill may be hit by that, half of them not.
    constexpr double kStep = 1000.0 / 240, kHeldUp = 40;
    std::vector<double> frames, hashes;  // ms: age of the last one in the file
    for (int i = 0; i < kKills; ++i)
    {
        const std::string file = fresh("killed.mcap"), saved = fresh("recovered.mcap");
        Process server({program("plabd"), i % 2 == 0 ? kScene : fast, "--no-bus", "--rate", "real", "--record", file});
        const auto begin = std::chrono::steady_clock::now();
        while (!has_hashes(file) && std::chrono::steady_clock::now() - begin < kLong) std::this_thread::sleep_for(Milliseconds(2));
        std::this_thread::sleep_for(Milliseconds(60 + 17 * i));
        // Before the signal: what is older than 20 ms by then is older still when the process dies.
        const std::int64_t killed = wall_ns();
        server.signal(SIGKILL);
        REQUIRE(server.wait(kLong) == 128 + SIGKILL);
        const auto report = recording::recover(file, saved);
        REQUIRE_MESSAGE(report, report.error().text());
        CHECK(report->verdict != recording::Verdict::NothingUsable);
        const Newest newest = newest_in(saved);
        frames.push_back(static_cast<double>(killed - newest.frame_ns) * 1e-6);
        hashes.push_back(static_cast<double>(killed - newest.hash_ns) * 1e-6);
        CHECK(frames.back() < 20 + kStep + kHeldUp);
        CHECK(hashes.back() < 20 + kStep + kHeldUp);
        const Outcome again = plabd({"--replay", saved, "--verify"});
        CHECK_MESSAGE(again.code == 0, again.output, again.errors);
        CHECK(has(again.output, "state hashes are identical"));
        std::filesystem::remove(file), std::filesystem::remove(saved);
    }
    std::sort(frames.begin(), frames.end()), std::sort(hashes.begin(), hashes.end());
    MESSAGE("ms lost, median and most: frames ", frames[kKills / 2], " ", frames.back(), ", hashes ", hashes[kKills / 2], " ",
            hashes.back());
    CHECK(frames[kKills / 2] < 20 + kStep);
    CHECK(hashes[kKills / 2] < 20 + kStep);
}

TEST_CASE("options that make no sense together are refused")
{
    CHECK(plabd({"--verify", kScene}).code == 2);
    CHECK(plabd({kScene, "--record-moved"}).code == 2);
    CHECK(plabd({kScene, "--load", "x"}).code == 2);
    CHECK(plabd({kScene, "--shadow", "a=b"}).code == 2);
    CHECK(plabd({kScene, "--record", "x.mcap", "--record-states", "-1"}).code == 2);
    CHECK(plabd({"--replay", "/nowhere/x.mcap"}).code == 1);
}

}  // namespace plab::test
