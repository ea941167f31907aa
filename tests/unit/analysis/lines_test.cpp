// Events of a recording as the lines that plab-log writes, and a report.
#include <doctest/doctest.h>

#include <fstream>
#include <sstream>

#include "control/recording/analysis/lines.h"
#include "control/recording/analysis/report.h"
#include "control/recording/analysis/report_tables.h"
#include "made_recording.h"
#include "support/text.h"

using namespace plab;
using namespace plab::analysis;
using namespace plab::test;

namespace
{

std::vector<std::string> lines(const std::string& file, const LineOptions& options)
{
    auto log = Log::open(file);
    REQUIRE(log.ok());
    const std::string path = fresh_path("lines.txt");
    auto out = program::TextOut::open(path);
    REQUIRE(out.ok());
    const auto written = write_lines(*log, options, *out);
    REQUIRE(written.ok());
    CHECK(written->count == 0);
    std::vector<std::string> all;
    std::ifstream in(path);
    for (std::string line; std::getline(in, line);) all.push_back(line);
    return all;
}

}  // namespace

TEST_CASE("all entries in the order of time, and a line for a new run")
{
    const std::vector<std::string> all = lines(make_recording("lines.mcap", {.steps_after = 50}), {});
    REQUIRE(all.size() == 4 + 10 + 1 + 1 + 2);
    CHECK(all[0] == "    0.2020 s  collision.impact      red blue  at (1 2 3) m, impulse 0.5 N s, depth 0.125 m");
    CHECK(all[2] == "    0.3010 s  script.print          gears red: a \"quoted\", word [1.5 2]");
    CHECK(all[14] == "-- run 2 begins: the scene was loaded or reset");
}

TEST_CASE("filters: topics, kinds, objects, severity, a span, a number")
{
    const std::string file = make_recording("lines_filters.mcap");
    const auto count = [&](const logger::Filter& filter) { return lines(file, {.filter = filter}).size(); };
    CHECK(count({}) == 14);
    CHECK(count({.collisions = false}) == 4);
    CHECK(count({.events = false}) == 10);
    CHECK(count({.kinds = {"collision.impact", "other."}}) == 10);
    CHECK(count({.kinds = {"script."}}) == 4);
    CHECK(count({.objects = {"floor"}}) == 5);
    CHECK(count({.objects = {"gears", "floor"}}) == 9);
    CHECK(count({.objects = {"nobody"}}) == 0);
    CHECK(count({.severity = logger::Severity::Warning}) == 1);
    CHECK(count({.severity = logger::Severity::Failure}) == 0);
    CHECK(lines(file, {.count = 3}).size() == 3);
    CHECK(lines(file, {.span = {1.0, 1.3}}).size() == 3);
}

TEST_CASE("lines of JSON")
{
    const std::vector<std::string> all = lines(make_recording("lines_json.mcap"), {.json = true});
    CHECK(has(all[0], R"("type":"collision","run":1,"sequence_number":1,"step":20,"time":0.202)"));
}

TEST_CASE("segments: the cost of each algorithm while it was in use")
{
    auto log = Log::open(make_recording("segments.mcap", {.steps_after = 50}));
    REQUIRE(log.ok());
    const std::vector<Segment> segments = segments_of(*log);
    REQUIRE(segments.size() == 3);
    CHECK(segments[0].algorithm == "Response/Impulse");
    CHECK(segments[0].samples == 4);
    CHECK(segments[0].mean_cost == doctest::Approx(2000));
    CHECK(segments[0].work == doctest::Approx(-0.75));
    CHECK(segments[1].algorithm == "Response/None");
    CHECK(segments[1].begin == 1.0);
    CHECK(segments[1].mean_cost == doctest::Approx(100));
    CHECK(segments[1].work == doctest::Approx(-1.25));
    CHECK(segments[1].largest_error == doctest::Approx(3e-6));
    CHECK(segments[2].run == 2);
    CHECK(segments[2].work == doctest::Approx(-0.5));
    CHECK(segments[2].mean_cost == doctest::Approx(2000));  // without the first sample of the run
}

TEST_CASE("a report is one page without external resources, and mentions the swap")
{
    auto log = Log::open(make_recording("report.mcap", {.steps_after = 50}));
    REQUIRE(log.ok());
    auto summary = summary_of(*log);
    REQUIRE(summary.ok());
    const std::string page = report_html(*log, *summary);
    CHECK(has(page, "<title>Recording: made</title>"));
    CHECK(has(page,
              "At 1 s (step 100) contact.response was exchanged, Response/Impulse → Response/None: 2 µs per step before, 0.1 µs after"));
    CHECK(has(page, "1 warning and 0 failures"));
    CHECK(has(page, "The recording is complete, and nothing is missing."));
    CHECK(has(page, "run 2: reset"));
    for (const char* heading : {"Energy and momentum", "Cost and error of the interactions", "Pace", "Requests", "Events", "Runs"})
        CHECK_MESSAGE(has(page, std::string("<h2>") + heading), heading);
    for (const char* outside : {"src=", "href=\"http", "@import", "nan"}) CHECK_MESSAGE(!has(page, outside), outside);
}

TEST_CASE("a report of an almost empty recording is a page as well")
{
    auto log = Log::open(make_recording("report_small.mcap", {.steps = 0, .with_catalogue = false, .with_journal = false}));
    REQUIRE(log.ok());
    auto summary = summary_of(*log);
    REQUIRE(summary.ok());
    CHECK(has(report_html(*log, *summary), "</html>"));
}
