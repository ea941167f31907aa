// Levels of detail over time, as a report draws them.
#include "control/recording/analysis/levels.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "control/recording/analysis/report.h"
#include "made_recording.h"
#include "support/text.h"

using namespace plab;
using namespace plab::analysis;
using namespace plab::test;

namespace
{

/// The last value at or before this time.
double count_at(const figures::Curve& curve, double time)
{
    double out = 0;
    for (const auto& [t, value] : curve.points)
        if (t <= time) out = value;
    return out;
}

std::string report_of(const std::string& file)
{
    auto log = Log::open(file);
    REQUIRE(log.ok());
    auto summary = summary_of(*log);
    REQUIRE(summary.ok());
    return report_html(*log, *summary);
}

}  // namespace

TEST_CASE("how many components each governor has at each level, from change to change and to the end")
{
    auto log = Log::open(make_recording("levels.mcap", {.governed = 10}));
    REQUIRE(log.ok());
    const auto curves = levels_over_time(*log);
    REQUIRE(curves.size() == 2);
    CHECK(curves[0].name == "Solver/Cheap");
    CHECK(curves[1].name == "Solver/Fine");
    for (const figures::Curve& curve : curves) CHECK(curve.unit == "components of lod");
    const auto all = [&](double time) { return count_at(curves[0], time) + count_at(curves[1], time); };
    for (const double time : {0.5, 0.99}) CHECK(count_at(curves[0], time) == 10);
    for (const double time : {1.01, 1.5, 2.0}) CHECK(count_at(curves[1], time) == 4);
    for (const double time : {0.5, 1.01, 2.0}) CHECK(all(time) == 10);
    CHECK(curves[1].points.back().first == doctest::Approx(2));
}

TEST_CASE("a reset begins anew: the levels of the run before do not count any more")
{
    auto log = Log::open(make_recording("levels_reset.mcap", {.steps_after = 50, .governed = 10}));
    REQUIRE(log.ok());
    const auto curves = levels_over_time(*log);
    REQUIRE(curves.size() == 2);
    CHECK(count_at(curves[0], 2.3) == 10);
    CHECK(count_at(curves[1], 2.3) == 0);
}

TEST_CASE("the report draws the levels, with a name for each; without a governor it does not mention them")
{
    const std::string page = report_of(make_recording("report_levels.mcap", {.governed = 10}));
    CHECK(has(page, "<h2>Levels of detail"));
    for (const char* name : {"Solver/Cheap", "Solver/Fine", "components of lod", "level.changed"}) CHECK_MESSAGE(has(page, name), name);
    CHECK_FALSE(has(report_of(make_recording("report_no_levels.mcap")), "Levels of detail"));
}
