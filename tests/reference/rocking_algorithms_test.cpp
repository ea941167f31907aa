// C23 and C24 by every algorithm of contacts (contact_algorithms.h); rocking_test.cpp has the closed forms and the reasons for the
// losses.
#include "rocking.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("C23: spin after the impact of a rocking block, with every algorithm")
{
    // rad/s, after one step (located) or ten.
    constexpr Bound<1> table[] = {
        {"located", "*", {6e-8}},
        {"None", "Impulse", {0.13}, {0.03}},
        {"at ends", "Rows/Direct", {2.6e-8}},
        {"at ends", "Rows/SequentialImpulse", {2.6e-8}},
        {"at ends", "Rows/SoftStep", {1.3e-3}, {3e-4}},
        // The old edge is released while the new one is loaded, not instantly: the result is w before the impact, less the work
        // of the damper.
        {"*", "springs", {0.13}, {0.03}},
    };
    check_algorithms(standing_algorithms(), table,
                     [](const Algorithm& algorithm)
                     {
                         Scene s(block(1e-7, 1, 1e-7, algorithm), "dt=\"1/1000\"");
                         REQUIRE_MESSAGE(s.loaded(), s.error());
                         s.warnings_expected = true;
                         s.step(algorithm.locates() ? 1 : 10);
                         return std::array{std::fabs(-s.vec("block", "angular_velocity").y - kKept)};
                     });
}

TEST_CASE("C23: Housner's quarter period, with every algorithm")
{
    // Error in steps, at 1/100 and 1/400. Located: Impulse steps a resting edge with order 1, Rows with order 2. At ends: the impact is
    // found at the end of a step. Springs find it in time; the block is tilted a little because its edge sinks in: 3e-4 s.
    constexpr Bound<2> table[] = {
        {"located", "Impulse", {0.15, 0.15}}, {"located", "Rows", {0.015, 0.0025}},         {"at ends", "Impulse", {1.15, 1.15}},
        {"at ends", "Rows", {1.15, 1.15}},    {"*", "springs", {0.09, 0.35}, {0.01, 0.05}},
    };
    check_algorithms(standing_algorithms(), table,
                     [](const Algorithm& algorithm)
                     {
                         return std::array{std::fabs(first_impact(algorithm, 0.01) - kQuarter) / 0.01,
                                           std::fabs(first_impact(algorithm, 0.0025) - kQuarter) / 0.0025};
                     });
}

TEST_CASE("C24: a rimless wheel at 1/400, with every algorithm")
{
    // rad/s, over h: the largest spin of the later steps relative to the fixed point's, and how far the smallest one lies below it.
    // Why 12 h: rocking_test.cpp. Springs are left out: on them the wheel leaves the cycle.
    constexpr Bound<2> table[] = {
        {"*", "Impulse", {12, 12}},
        {"None", "Rows/Direct", {6, 6}},
        {"*", "Rows/Direct", {12, 12}},
        {"None", "Rows/SequentialImpulse", {11, 11}},
        {"Speculative", "Rows/SequentialImpulse", {12, 12}},
        {"*", "Rows/SoftStep", {20, 28}},
    };
    std::vector<Algorithm> algorithms = standing_algorithms();
    std::erase_if(algorithms, [](const Algorithm& algorithm) { return algorithm.springs(); });
    check_algorithms(algorithms, table,
                     [](const Algorithm& algorithm) -> std::array<double, 2>
                     {
                         constexpr double kFixed = 1.0958222331616213, h = 0.0025;
                         const std::vector<double> w = walk(algorithm, h, 8);
                         if (w.size() < 7) return {HUGE_VAL, HUGE_VAL};
                         const auto [low, high] = std::minmax_element(w.begin() + 6, w.end());
                         return {std::fabs(*high - kFixed) / h, (kFixed - *low) / h};
                     });
}
