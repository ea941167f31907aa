// Locating a time inside a step.
#include <doctest/doctest.h>

#include "bodies.h"
#include "resolution/searches.h"
#include "support/events.h"

using namespace plab;
using namespace plab::test;

namespace
{
/// Takes the host's part: brackets the zero of `gap`, which is > 0 at the start of the step and < 0 at its end.
template <class Gap>
EventBracket locate(const resolution::BisectionRows& rows, double step, Gap gap)
{
    EventBracket t;
    t.step = t.end = step;
    for (;; ++t.iteration)
    {
        resolution::bisect({}, 0, rows, t);
        if (t.decision != EventBracket::Decision::Try) return t;
        REQUIRE(t.next > t.begin);
        REQUIRE(t.next < t.end);
        (gap(t.next) > 0 ? t.begin : t.end) = t.next;
    }
}
}  // namespace

TEST_CASE("bisection finds the time of a falling ball's impact to 1e-15 s, before the overlap")
{
    OneRow<resolution::BisectionRows> row;
    const auto gap = [](double t) { return 1e-3 - 0.01 * t - 0.5 * 9.81 * t * t; };
    const double want = (-0.01 + std::sqrt(1e-4 + 2 * 9.81 * 1e-3)) / 9.81;
    const EventBracket t = locate(row.rows, 1.0 / 60, gap);
    CHECK(t.decision == EventBracket::Decision::Accept);
    CHECK(std::fabs(t.begin - want) < 1.1e-15);
    CHECK(gap(t.begin) > 0);
    CHECK(t.iteration <= 48);
}

TEST_CASE("the tolerance is met, and is never finer than the rounding of the time")
{
    OneRow<resolution::BisectionRows> row;
    row.rows.time_tolerance[0] = 1e-6;
    const EventBracket coarse = locate(row.rows, 0.01, [](double t) { return 0.003 - t; });
    CHECK(coarse.end - coarse.begin <= 1e-6);
    CHECK(coarse.end - coarse.begin > 0.5e-6);
    row.rows.time_tolerance[0] = 0;
    const EventBracket fine = locate(row.rows, 0.01, [](double t) { return 0.003 - t; });
    CHECK(fine.decision == EventBracket::Decision::Accept);
    CHECK(fine.iteration <= 49);
}

TEST_CASE("an impact at the very start of the step ends at the start")
{
    OneRow<resolution::BisectionRows> row;
    const EventBracket t = locate(row.rows, 0.01, [](double) { return -1.0; });
    CHECK(t.decision == EventBracket::Decision::Accept);
    CHECK(t.begin == 0);
}

TEST_CASE("when it has used all trials, it gives up and reports that")
{
    OneRow<resolution::BisectionRows> row;
    row.rows.max_iterations[0] = 5;
    Events events;
    StepContext context;
    context.events = &events;
    EventBracket t;
    t.step = t.end = 0.01, t.iteration = 5;
    resolution::bisect(context, 0, row.rows, t);
    CHECK(t.decision == EventBracket::Decision::GiveUp);
    REQUIRE(events.all.size() == 1);
    CHECK(events.all[0].kind == "resolution.gave_up");
}

TEST_CASE("without location the end of the step is taken")
{
    EventBracket t;
    t.decision = EventBracket::Decision::Try;
    resolution::accept_end({}, 0, {}, t);
    CHECK(t.decision == EventBracket::Decision::Accept);
}
