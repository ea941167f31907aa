// Rocking and walking on edges: contacts that are taken over by others. C23 (Housner's block), C24 (rimless wheel).
//
// C23: half-diagonal 1, alpha = .2, released at theta = .1. I_o theta'' = -m g R sin(alpha - theta): quarter period
// .48608973195735393546 s, spin at the impact .46883536463483484333 rad/s (quadrature and energy, mpmath, 40 digits; the small-angle
// formula gives .4855195874 s). At the impact the old edge separates: w'/w = 1 - 1.5 sin^2(alpha).
// C24: eight spokes of 1 m, slope .08, mass 1 at the hub, with a small inertia I about its axle (a point would spin freely):
//   w+ = r w-,  r = (I + cos 45) / (I + 1);   w-^2 = w+^2 + 2 g (cos(.08 - pi/8) - cos(.08 + pi/8)) / (1 + I)
// fixed point 1.0954628 and contraction of w^2 cos^2 45 = .5 for I = 0; 1.0958222331616213, .50041388537773225 for I = 1e-3.
//
// | problem | algorithm                         | bound                                                              |
// |---------|-----------------------------------|--------------------------------------------------------------------|
// | C23     | impact alone, all that locate     | w'/w to 6e-8 (started 1e-7 rad before it: the arms differ by that) |
// |         | quarter period, located + Impulse | .15 h: a resting edge is stepped with order 1 (asserted)           |
// |         | located + Rows                    | 1.5 h^2/s: a corner is held in the middle of the step, order 2     |
// |         | None, Speculative + either        | 1.15 h: .15 h, found at the end of a step                          |
// | C24     | located + Impulse                 | fixed point to 12 h rad/s, contraction .5 -+ .035 at h = .001      |
// |         | None + Rows                       | fixed point to 6 h rad/s                                           |
// |         | Speculative, LocalRoot + Rows     | 12 h                                                               |
//
// Why 12 h: with Impulse, a stance loses 2.5 h J by its steps of order 1 (measured), 2.3 h rad/s of the fixed point. A landing corner
// belongs to the pair that is at rest, so its impact is not located but answered before its step, up to h early: 3.1 h rad/s, twice that at
// the fixed point (a deviation halves from step to step). And the spin is measured at the step's end, up to 3 h rad/s later. In all
// 11.5 h; reached 10.7 h.
//
// Aims not reached: the fixed point to more digits. Landing corners are not located, and Impulse holds resting contacts at the level of
// speeds, with order 1.
#include <algorithm>

#include "rocking.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("C23: at the impact of a rocking block the old edge separates")
{
    for (const Algorithm& algorithm : kAlgorithms)
    {
        if (!algorithm.locates()) continue;
        CAPTURE(algorithm.name());
        Scene s(block(1e-7, 1, 1e-7, algorithm), "dt=\"1/100\"");  // no gravity: at 1 rad/s the impact is after 1e-7 s
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = s.keep_events = true;
        s.step();
        CHECK(s.count("contact.impact") >= 2);
        CHECK(std::fabs(-s.vec("block", "angular_velocity").y - kKept) < 6e-8);
    }
}

TEST_CASE("C23: a rocking block lands after Housner's quarter period")
{
    for (const Algorithm& algorithm : kAlgorithms)
    {
        CAPTURE(algorithm.name());
        double off[3];
        int k = 0;
        for (const double h : {0.01, 0.0025, 0.000625}) off[k] = std::fabs(first_impact(algorithm, h) - kQuarter), ++k;
        const double share = algorithm.locates() ? 0.15 : 1.15;
        for (k = 0; k < 3; ++k)
        {
            const double h = 0.01 / (1 << (2 * k));
            CHECK(off[k] < (algorithm.locates() && algorithm.rows() ? 1.5 * h * h : share * h));
        }
        if (algorithm.locates() && !algorithm.rows()) CHECK((off[0] / off[1] > 3 && off[0] / off[1] < 6));
    }
    CHECK(std::fabs(first_impact({"LocalRoot", "Impulse"}, 0.000625) - kQuarter) < 0.5 * (kQuarter - 0.485519587413140505));
}

TEST_CASE("C24: a rimless wheel converges to its limit cycle: each step halves the deviation")
{
    constexpr double kFixed = 1.0958222331616213;
    for (const Algorithm& algorithm : {Algorithm{"LocalRoot", "Impulse"}, Algorithm{"LocalBisection", "Impulse"}, Algorithm{"None", "Rows"},
                                       Algorithm{"Speculative", "Rows"}, Algorithm{"LocalRoot", "Rows"}})
        for (const double h : {0.0025, 0.001})
        {
            CAPTURE(algorithm.name());
            CAPTURE(h);
            const std::vector<double> w = walk(algorithm, h, 8);
            REQUIRE(w.size() >= 7);
            const auto [low, high] = std::minmax_element(w.begin() + 6, w.end());
            const double bound = (algorithm.rows() && algorithm.is("None") ? 6 : 12) * h;
            CHECK(*high < kFixed + bound);
            CHECK(*low > kFixed - bound);
            if (algorithm.rows() || h > 0.001) continue;
            const double end = w.back() * w.back(), first = w[0] * w[0] - end, second = w[1] * w[1] - end;
            CHECK(std::fabs(second / first - 0.5) < 0.035);
        }
}

TEST_CASE("a wheel that walks on its edges at long steps gains no energy, however its contacts change")
{
    // Corners that landed undetected used to sink in, be separated by lifting the wheel, and sink in again: 0.06 J per step.
    for (const char* resolution : {"LocalRoot", "LocalBisection"})
    {
        CAPTURE(std::string(resolution));
        Scene s(wheel({resolution, "Impulse"}), "dt=\"1/100\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = true;
        const auto& bodies = s.simulation().world().host().bodies;
        const std::uint32_t b = s.simulation().world().component(s.simulation().world().find("wheel")).host_index;
        const auto total = [&] { return bodies.kinetic_energy(b) - dot(kDownhill, bodies.position[b]); };
        double before = total(), worst = 0;
        for (int i = 0; i < 1000; ++i)
        {
            s.step();
            const double now = total();
            worst = std::max(worst, now - before), before = now;
        }
        CHECK(worst < 2e-3);
        CHECK(s.vec("wheel", "angular_velocity").y < 1.5);
    }
}
