// Counts of what a recording holds.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "control/recording/analysis/summary.h"
#include "made_recording.h"

using namespace plab;
using namespace plab::analysis;
using namespace plab::test;

namespace
{

Summary summary_of_file(const std::string& path)
{
    auto log = Log::open(path);
    REQUIRE_MESSAGE(log.ok(), log.error().text());
    auto summary = summary_of(*log);
    REQUIRE(summary.ok());
    return summary.take();
}

const TopicSummary& topic(const Summary& s, const std::string& name)
{
    for (const TopicSummary& t : s.topics)
        if (t.name == name) return t;
    FAIL("no topic " << name);
    return s.topics.front();
}

}  // namespace

TEST_CASE("a whole recording: its writer, its duration, the amount of each topic")
{
    const Summary s = summary_of_file(make_recording("summary.mcap"));
    CHECK(s.is_whole());
    CHECK(s.head.at("server") == "lab");
    CHECK(s.duration() == doctest::Approx(2.0));
    CHECK(s.wall_duration() == doctest::Approx(2.0));
    REQUIRE(s.runs.size() == 1);
    CHECK(s.runs[0].first_step == 0);
    CHECK(s.runs[0].last_step == 200);
    CHECK(s.runs[0].last_time == doctest::Approx(2.0));
    CHECK(s.runs[0].cause.empty());
    CHECK(topic(s, "plab/states").messages == 201);
    CHECK(topic(s, "plab/states").rate() == doctest::Approx(100));
    CHECK(topic(s, "plab/states").schema == "plab::v2::Frame");
    CHECK(topic(s, "plab/metrics").messages == 9);
    CHECK(s.bodies == 2);
    CHECK(s.shafts == 1);
    // Three objects for two seconds.
    CHECK(s.state_bytes_per_object_second() == doctest::Approx(static_cast<double>(topic(s, "plab/states").bytes) / 6));
    CHECK(s.file_bytes == std::filesystem::file_size(s.path));
    CHECK(s.file_bytes_per_object_second() < s.state_bytes_per_object_second());
    CHECK(s.raw_bytes > s.chunk_bytes);
    REQUIRE(s.attachments.size() == 1);
    CHECK(s.attachments[0].name == "blueprint.xml");
}

TEST_CASE("swaps, events by kind and severity, snapshots, requests")
{
    const Summary s = summary_of_file(make_recording("summary_swaps.mcap"));
    REQUIRE(s.swaps.size() == 1);
    CHECK(s.swaps[0].component == "contact.response");
    CHECK(s.swaps[0].from == "Response/Impulse");
    CHECK(s.swaps[0].to == "Response/None");
    CHECK(s.swaps[0].step == 100);
    CHECK(s.swaps[0].log_time == 100 * kMadeStepNs);
    CHECK(s.requests == 1);
    REQUIRE(s.events.size() == 2);
    CHECK(s.events[0].severity == "info");
    CHECK(s.events[0].count == 3);
    CHECK(s.events[1].severity == "warning");
    CHECK(s.events[1].count == 1);
    REQUIRE(s.collisions.size() == 1);
    CHECK(s.collisions[0].count == 10);
    REQUIRE(s.snapshots.size() == 1);
    CHECK(s.snapshots[0].cause == "begin");
    CHECK(s.snapshots[0].bytes == 100);
}

TEST_CASE("without a journal the catalogue shows a swap")
{
    const Summary s = summary_of_file(make_recording("summary_no_journal.mcap", {.with_journal = false}));
    REQUIRE(s.swaps.size() == 1);
    CHECK(s.swaps[0].from == "Response/Impulse");
    CHECK(s.swaps[0].to == "Response/None");
    CHECK(s.swaps[0].step == 100);
}

TEST_CASE("a reset begins a run, and time continues")
{
    const Summary s = summary_of_file(make_recording("summary_runs.mcap", {.steps_after = 50}));
    REQUIRE(s.runs.size() == 2);
    CHECK(s.runs[1].cause == "reset");
    CHECK(s.runs[1].begin == 201 * kMadeStepNs);
    CHECK(s.runs[1].first_step == 0);
    CHECK(s.runs[1].last_step == 50);
    CHECK(s.duration() == doctest::Approx(2.51));
    // A new run has the algorithm of its scene again: that is no swap.
    CHECK(s.swaps.size() == 1);
}

TEST_CASE("a frame whose number occurs but which is absent counts as missing")
{
    const Summary s = summary_of_file(make_recording("summary_missing.mcap", {.missing_frame = 77}));
    CHECK(topic(s, "plab/states").missing == 1);
    CHECK(topic(s, "plab/states").gaps == 1);
    CHECK(topic(s, "plab/events").missing == 0);
}

TEST_CASE("a recording that was not closed is read, and this is reported")
{
    const std::string path = make_recording("summary_cut.mcap");
    std::filesystem::resize_file(path, std::filesystem::file_size(path) * 2 / 3);
    const Summary s = summary_of_file(path);
    CHECK(!s.is_closed);
    CHECK(!s.is_whole());
    CHECK(topic(s, "plab/states").messages > 50);
    CHECK(topic(s, "plab/states").messages < 201);
    CHECK(s.duration() > 0.5);
}

TEST_CASE("damage is counted, and the rest is read")
{
    const std::string path = make_recording("summary_damaged.mcap", {.compression = recording::Compression::None});
    const auto middle = static_cast<std::streamoff>(std::filesystem::file_size(path) / 2);
    {
        std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(middle);
        file.write("damaged", 7);
    }
    const Summary s = summary_of_file(path);
    CHECK(s.is_closed);
    CHECK(!s.is_whole());
    CHECK(s.troubles.count == 1);
    CHECK(topic(s, "plab/states").messages < 201);
    CHECK(topic(s, "plab/states").missing > 0);
}

TEST_CASE("a file that is not a recording is an error that names it")
{
    const std::string path = fresh_path("none.mcap");
    std::ofstream(path) << "<plab/>";
    const auto log = Log::open(path);
    REQUIRE(!log.ok());
    CHECK(log.error().text().find(path) != std::string::npos);
    CHECK(!Log::open(path + ".not").ok());
}
