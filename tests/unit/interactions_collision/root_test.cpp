// Zeros of a gap: number of evaluations and accuracy.
#include <doctest/doctest.h>

#include "bodies.h"
#include "resolution/bracket.h"
#include "resolution/searches.h"
#include "support/events.h"

using namespace plab;
using namespace plab::test;

namespace
{
/// Takes the host's part, with an overlap known at the end.
template <class Gap, class Rate>
EventBracket close_in(double step, Gap gap, Rate rate)
{
    OneRow<resolution::RootRows> row;
    EventBracket t;
    t.step = t.end = step;
    t.gap_begin = gap(0), t.rate_begin = rate(0), t.gap_end = gap(step), t.rate_end = rate(step);
    for (;; ++t.iteration)
    {
        resolution::find_root({}, 0, row.rows, t);
        if (t.decision != EventBracket::Decision::Try) return t;
        REQUIRE(t.next > t.begin);
        REQUIRE(t.next < t.end);
        const double g = gap(t.next);
        t.last = t.next, t.last_gap = g, t.last_rate = rate(t.next);
        if (g > 0)
            t.begin = t.next, t.gap_begin = g, t.rate_begin = t.last_rate;
        else
            t.end = t.next, t.gap_end = g, t.rate_end = t.last_rate;
    }
}
}  // namespace

TEST_CASE("a falling ball's impact takes a few evaluations where bisection takes 48")
{
    const auto gap = [](double t) { return 1e-3 - 0.01 * t - 0.5 * 9.81 * t * t; };
    const auto rate = [](double t) { return -0.01 - 9.81 * t; };
    const double want = (-0.01 + std::sqrt(1e-4 + 2 * 9.81 * 1e-3)) / 9.81;
    const EventBracket t = close_in(1.0 / 60, gap, rate);
    CHECK(t.decision == EventBracket::Decision::Accept);
    CHECK(std::fabs(t.begin - want) < 1e-15);
    CHECK(gap(t.begin) >= 0);
    CHECK(t.end - t.begin <= 0x1p-47 / 60);
    CHECK(t.iteration <= 7);
}

TEST_CASE("rotating corners, springs that push back, steep and flat gaps: few evaluations each")
{
    struct Case
    {
        double step, want;
        double (*gap)(double);
        double (*rate)(double);
        int most_evaluations;
    };
    const Case cases[] = {
        {0.05, std::asin(0.5) / 40, [](double t) { return 0.5 - std::sin(40 * t); }, [](double t) { return -40 * std::cos(40 * t); }, 9},
        {1, std::log(2.0), [](double t) { return 2 - std::exp(t); }, [](double t) { return -std::exp(t); }, 12},
        {1, 0.5, [](double t) { return (0.5 - t) * (0.5 - t) * (0.5 - t) + 1e-6 * (0.5 - t); },
         [](double t) { return -3 * (0.5 - t) * (0.5 - t) - 1e-6; }, 60},
    };
    for (const Case& c : cases)
    {
        const EventBracket t = close_in(c.step, c.gap, c.rate);
        CHECK(std::fabs(t.begin - c.want) < 1e-14 * c.step);
        CHECK(t.iteration <= c.most_evaluations);
    }
}

TEST_CASE("without rates it is the secant method, and still ends")
{
    const auto unknown = [](double) { return std::nan(""); };
    const EventBracket t = close_in(
        1, [](double s) { return 0.3 - s * s; }, unknown);
    CHECK(std::fabs(t.begin - std::sqrt(0.3)) < 1e-14);
    CHECK(t.iteration <= 55);  // like bisection, and hardly more
}

TEST_CASE("a Hermite cubic's zero is exact for a cubic")
{
    const auto g = [](double s) { return 1 - 0.3 * s - 0.4 * s * s - 0.9 * s * s * s; };
    const auto r = [](double s) { return -0.3 - 0.8 * s - 2.7 * s * s; };
    const double zero = resolution::hermite_zero(0, g(0), r(0), 1, g(1), r(1));
    CHECK(std::fabs(g(zero)) < 1e-15);
}

TEST_CASE("conservative advancement steps by gap over closing speed, and accepts a gap within its tolerance")
{
    OneRow<resolution::AdvancementRows> row;
    EventBracket t;
    t.step = t.end = 0.1, t.begin = t.last = 0.02, t.gap_begin = 0.3, t.closing = 10;
    t.gap_end = std::nan("");
    resolution::advance_to_contact({}, 0, row.rows, t);
    CHECK(t.decision == EventBracket::Decision::Try);
    CHECK(t.next == 0.02 + 0.3 / 10);
    t.gap_begin = 0.9e-12;
    resolution::advance_to_contact({}, 0, row.rows, t);
    CHECK(t.decision == EventBracket::Decision::Accept);
}

TEST_CASE("conservative advancement stays within a bracket whose end overlaps, although the bound says that this takes longer")
{
    OneRow<resolution::AdvancementRows> row;
    EventBracket t;
    t.step = t.end = 0.1, t.begin = t.last = 0.02, t.gap_begin = 0.3, t.gap_end = -0.01, t.closing = 0.5;
    resolution::advance_to_contact({}, 0, row.rows, t);
    CHECK(t.decision == EventBracket::Decision::Try);
    CHECK(t.next == doctest::Approx(0.06));
}

TEST_CASE("bodies that graze for too long are reported")
{
    Events events;
    StepContext context;
    context.events = &events;
    OneRow<resolution::AdvancementRows> steps;
    OneRow<resolution::RootRows> root;
    EventBracket t;
    t.step = t.end = 0.1, t.gap_begin = 1e-7, t.closing = 10, t.rate_begin = -1, t.gap_end = std::nan("");
    t.iteration = 1000;
    resolution::advance_to_contact(context, 0, steps.rows, t);
    CHECK(t.decision == EventBracket::Decision::GiveUp);
    resolution::find_root(context, 0, root.rows, t);
    CHECK(t.decision == EventBracket::Decision::GiveUp);
    REQUIRE(events.all.size() == 2);
    CHECK(events.all[0].kind == "resolution.grazing");
    CHECK(events.all[1].severity == Severity::Warning);
}
