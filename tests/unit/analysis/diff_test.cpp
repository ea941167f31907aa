// Where two recordings differ, and how the difference grows: known beforehand, as one was altered on purpose.
#include <doctest/doctest.h>

#include <cmath>

#include "control/recording/analysis/diff.h"
#include "made_recording.h"

using namespace plab;
using namespace plab::analysis;
using namespace plab::test;

namespace
{

Difference difference(const MadeOptions& a, const MadeOptions& b)
{
    auto log_a = Log::open(make_recording("diff_a.mcap", a));
    auto log_b = Log::open(make_recording("diff_b.mcap", b));
    REQUIRE(log_a.ok());
    REQUIRE(log_b.ok());
    return difference_of(*log_a, *log_b);
}

const Growth& growth_of(const Difference& d, const std::string& object)
{
    for (const Growth& g : d.objects)
        if (g.object == object) return g;
    FAIL("no growth of " << object);
    return d.objects.front();
}

}  // namespace

TEST_CASE("a recording does not differ from itself, whatever the compression")
{
    const Difference d = difference({.steps_after = 30}, {.steps_after = 30, .compression = recording::Compression::Lz4});
    CHECK(d.is_none());
    CHECK(!d.is_unknown());
    CHECK(d.hashes_compared == 230);
    CHECK(d.frames_compared == 201 + 31);
    CHECK(d.objects.size() == 3);
    CHECK(d.objects.front().largest == 0);
}

TEST_CASE("a run that only one of them has is a difference, and is named")
{
    const Difference d = difference({.steps_after = 30}, {});
    CHECK(d.runs_a == 2);
    CHECK(d.runs_b == 1);
    REQUIRE(d.not_compared.size() == 1);
    CHECK(d.not_compared[0].run == 2);
    CHECK(d.not_compared[0].is_in_a);
    CHECK(!d.first_hash);
    CHECK(!d.is_none());
    const Difference other = difference({}, {.steps_after = 30});
    REQUIRE(other.not_compared.size() == 1);
    CHECK(!other.not_compared[0].is_in_a);
}

TEST_CASE("the first difference is named: step, object, quantity, both values")
{
    const Difference d = difference({}, {.differs_from = 57});
    CHECK(!d.is_none());
    REQUIRE(d.first_hash);
    CHECK(d.first_hash->step == 57);
    CHECK(d.first_hash->run == 1);
    CHECK(d.first_hash->a == made_hash(1, 57, false));
    CHECK(d.first_hash->b == made_hash(1, 57, true));
    REQUIRE(d.first_state);
    CHECK(d.first_state->step == 57);
    CHECK(d.first_state->time == 57 * kMadeStep);
    CHECK(d.first_state->object == "red");
    CHECK(d.first_state->quantity == "position.y");
    CHECK(d.first_state->a == std::sin(57 * kMadeStep));
    CHECK(d.first_state->b == std::sin(57 * kMadeStep) + 1e-13);
}

TEST_CASE("the times at which the difference exceeds each decade are reported")
{
    // 1e-13 m at step 50, twice as much every ten steps.
    const Difference d = difference({}, {.differs_from = 50, .difference = 1e-13});
    const Growth& red = growth_of(d, "red");
    CHECK(d.objects.front().object == "red");
    REQUIRE(red.exceeded[0]);
    CHECK(*red.exceeded[0] == doctest::Approx(0.5 + 0.1 * std::log2(10)).epsilon(0.02));
    CHECK(*red.exceeded[1] == doctest::Approx(0.5 + 0.1 * std::log2(1e4)).epsilon(0.02));
    CHECK(!red.exceeded[2]);
    CHECK(red.largest == doctest::Approx(1e-13 * std::exp2(15)).epsilon(1e-3));
    CHECK(red.position == doctest::Approx(1e-13 * std::exp2(15)).epsilon(1e-3));
    CHECK(red.orientation == 0);
    CHECK(growth_of(d, "blue").largest == 0);
    CHECK(growth_of(d, "axle").is_shaft);
    const Difference large = difference({}, {.differs_from = 50, .difference = 2e-6});
    CHECK(*growth_of(large, "red").exceeded[2] == 0.5);
    CHECK(*growth_of(large, "red").exceeded[3] == doctest::Approx(0.5 + 0.1 * std::log2(500)).epsilon(0.02));
}

TEST_CASE("recordings of different rates are compared where both have a step")
{
    const Difference d = difference({.frame_every = 2}, {.frame_every = 3, .differs_from = 57});
    CHECK(d.frames_a == 101);
    CHECK(d.frames_b == 67);
    CHECK(d.frames_compared == 34);
    REQUIRE(d.first_state);
    CHECK(d.first_state->step == 60);
    CHECK(d.first_hash->step == 57);
}

TEST_CASE("frames that name only moved objects are compared as if they named all")
{
    const Difference same = difference({.only_moved = true}, {.only_moved = true});
    CHECK(same.is_none());
    CHECK(same.frames_compared == 201);
    const Difference other = difference({.only_moved = true}, {.differs_from = 57, .only_moved = true});
    REQUIRE(other.first_state);
    CHECK(other.first_state->step == 57);
    CHECK(other.first_state->object == "red");
}

TEST_CASE("runs are compared one by one, as far as both extend")
{
    const Difference d = difference({.steps_after = 40}, {.steps_after = 50});
    CHECK(d.is_none());
    CHECK(d.frames_compared == 201 + 41);
    CHECK(d.frames_b == 201 + 51);
}

TEST_CASE("recordings of which one is longer, one has no hashes, one has no names")
{
    CHECK(difference({.steps = 100}, {}).frames_compared == 101);
    const Difference no_hashes = difference({.with_hashes = false}, {});
    CHECK(no_hashes.hashes_compared == 0);
    CHECK(no_hashes.hashes_b == 200);
    CHECK(no_hashes.is_none());
    const Difference no_names = difference({.with_catalogue = false}, {});
    CHECK(no_names.is_none());
    CHECK(no_names.objects.size() == 3);
    CHECK(difference({}, {.with_catalogue = false}).objects.size() == 3);
}

TEST_CASE("an object that only one of them has is a difference")
{
    const Difference more = difference({}, {.with_axle = false});
    CHECK(more.only_in_a == std::vector<std::string>{"axle"});
    CHECK(more.only_in_b.empty());
    CHECK(!more.is_none());
    CHECK(difference({.with_axle = false}, {}).only_in_b == std::vector<std::string>{"axle"});
}

TEST_CASE("the chart of a difference has a curve per object")
{
    auto a = Log::open(make_recording("diff_chart_a.mcap"));
    auto b = Log::open(make_recording("diff_chart_b.mcap", {.differs_from = 100, .difference = 1e-9}));
    REQUIRE(a.ok());
    REQUIRE(b.ok());
    const figures::Chart chart = difference_chart(*a, *b, {"red", "blue"});
    REQUIRE(chart.curves.size() == 2);
    CHECK(chart.curves[0].points.back().second == doctest::Approx(1e-9 * std::exp2(10)).epsilon(1e-3));
    CHECK(draw(chart).svg(false).find("nan") == std::string::npos);
}
