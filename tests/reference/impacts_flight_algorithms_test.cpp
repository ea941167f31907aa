// Bounces with flight between them, on every algorithm of contacts (contact_algorithms.h) and of solvers: C4 and C9 of the catalogue.
#include <numbers>

#include "impacts.h"
#include "motion.h"
#include "support/gravity.h"

using namespace plab;
using namespace plab::test;

namespace
{
constexpr double kLinear = 1e7, kHertz = 1e9;

/// s: duration of the contact of 10 kg that have fallen 5 m. Linear: z'' = -g - k z / m, z' = -v at z = 0. Hertz: by quadrature,
/// 30 digits.
double contact_time(const Algorithm& algorithm)
{
    if (!algorithm.springs()) return 0;
    if (algorithm.law() == "HuntCrossley") return 0.001283802726746103;
    const double w = std::sqrt(kLinear / 10), v = std::sqrt(2 * kG * 5);
    return 2 / w * (std::numbers::pi - std::atan(v * w / kG));
}

/// C4 with five balls: the largest relative error of the energy, and the largest error of the first ball's height while it
/// flies, m.
std::array<double, 2> bouncing(const Algorithm& algorithm, double h, double until, const SolverAlgorithm& solved_by = {"Automatic"})
{
    std::string balls, all;
    for (int i = 0; i < 5; ++i)
    {
        const std::string id = "b" + std::to_string(i);
        balls += sphere(id, 0.1, at({0.5 * i, 0, 5.1 + 0.01 * i}, {}, 10) + " solver=\"solver\"");
        all += id + " ";
    }
    Scene s(solver(solved_by) + kGround + balls + gravity(all) +
                contact(all, algorithm, 1, 0, "against=\"ground\" " + stiffness(algorithm, kLinear, kHertz)),
            "dt=\"" + text(h) + "\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const double lasts = contact_time(algorithm), fall = std::sqrt(2 * 5 / kG), start = energy(s);
    std::array<double, 2> worst{};
    while (s.simulation().time() < until - h / 2)
    {
        s.step();
        const simulation::Totals now = s.simulation().totals();
        worst[0] = std::max(worst[0], std::fabs((now.kinetic + now.stored) / start - 1));
        const double phase = std::fmod(s.simulation().time() + fall, 2 * fall + lasts) - fall;
        if (phase > fall) continue;  // on its spring
        worst[1] = std::max(worst[1], std::fabs(s.vec("b0", "position").z - 0.1 - (5 - 0.5 * kG * phase * phase)));
    }
    return worst;
}
}  // namespace

TEST_CASE("C4: elastic balls with every algorithm: energy, and height over 20 s at 1/100 and over 10 s at 1/400")
{
    // If it is not located, each of ten bounces is up to 2 h late, at 9.9 m/s: 198 h in 20 s, 99 h in 10 s.
    constexpr double late = 198 * 0.01, less = 99 * 0.0025;
    constexpr Bound<3> table[] = {
        {"located", "*", {1.3e-14, 2e-13, 4.2e-13}},
        {"None", "Rows/SoftStep", {2.5e-4, late, less}, {2e-5, 0.03, 3e-3}},
        // Restitution is applied at the end of the step in which a gap may close, above the ground: energy is lost, and the
        // timing changes.
        {"Speculative", "Rows/SoftStep", {0.36, 9.9, 0.9}, {0.08, 2, 0.1}},
        {"*", "Penalty", {1.2e-9, 5.2e-8, 1.1e-8}},
        {"*", "HuntCrossley", {2.4e-7, 1.4e-5, 3.2e-6}},
        {"at ends", "*", {1.3e-14, late, less}, {0, 0.03, 3e-3}},
    };
    check_algorithms(every_algorithm(), table,
                     [](const Algorithm& algorithm)
                     {
                         const auto coarse = bouncing(algorithm, 0.01, 20), fine = bouncing(algorithm, 0.0025, 10);
                         return std::array{std::max(coarse[0], fine[0]), coarse[1], fine[1]};
                     });
}

TEST_CASE("C4: elastic balls with every solver, impacts located: exact for all but semi-implicit Euler, which is of order 1")
{
    for (const SolverAlgorithm& by : {SolverAlgorithm{"StoermerVerlet"},
                                      {"RungeKutta4"},
                                      {"RotationSplitting", "order=\"2\""},
                                      {"RotationSplitting"},
                                      {"ImplicitMidpoint"},
                                      {"Exact"},
                                      {"Automatic"},
                                      {"DormandPrince54"},
                                      {"Radau5"},
                                      {"Exponential"}})
        for (const char* resolution : {"LocalRoot", "LocalBisection"})
        {
            CAPTURE(by.type);
            CAPTURE(by.attributes);
            CAPTURE(std::string(resolution));
            const auto off = bouncing({resolution, "Impulse"}, 0.01, 20, by);
            CHECK(off[0] < 2e-14);
            CHECK(off[1] < 9e-13);
        }
    const Algorithm located{"LocalRoot", "Impulse"};
    const auto coarse = bouncing(located, 0.01, 1.9, {"SemiImplicitEuler"}), fine = bouncing(located, 0.0025, 1.9, {"SemiImplicitEuler"});
    // Its parabola is wrong by g h t / 2: 1 % of the height in a fall of 1 s.
    CHECK(coarse[0] < 0.037);
    CHECK(coarse[1] < 0.17);
    CHECK(std::fabs(observed_order(coarse[0], fine[0]) / 2 - 1) < 0.01);
    CHECK(std::fabs(observed_order(coarse[1], fine[1]) / 2 - 1) < 0.01);
}

namespace
{
/// C9: relative deviation of the small ball's speed from that after sequential impacts. `away`: m, initial distance of the big
/// ball from the ground, when it was released from rest at 1 m.
double cannon(const Algorithm& algorithm, double h, double away, double until)
{
    const double v0 = std::sqrt(2 * kG * (1 - away)), v = std::sqrt(2 * kG), t1 = (v - v0) / kG, t2 = t1 + 1e-3 / (2 * v);
    Scene s(kGround + sphere("big", 0.1, at({0, 0, 0.1 + away}, {0, 0, -v0})) +
                sphere("small", 0.05, at({0, 0, 0.251 + away}, {0, 0, -v0}, 0.1)) + gravity("big small") +
                contact("big small ground", algorithm, 1, 0, stiffness(algorithm, 1e6, 1e8)),
            "dt=\"" + text(h) + "\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(until);
    const double up = v - kG * (t2 - t1), down = -v0 - kG * t2, M = 1, m = 0.1;
    const double after = (m * down + M * up + M * (up - down)) / (M + m);
    return std::fabs(s.vec("small", "linear_velocity").z / (after - kG * (s.simulation().time() - t2)) - 1);
}
}  // namespace

TEST_CASE("C9: Galileo's cannon with every algorithm, at 1/60, where the gap closes within a step, and at 1e-5")
{
    // Springs push both balls at the same time, and give a different result.
    constexpr Bound<2> table[] = {
        {"located", "*", {4e-15, 2e-13}},
        {"at ends", "Rows/SoftStep", {0.5, 7e-5}, {0.05, 0}},
        {"*", "springs", {1, 1}, {0.1, 0.1}},
        {"at ends", "*", {1, 4e-5}, {0.1, 0}},
    };
    check_algorithms(every_algorithm(), table,
                     [](const Algorithm& algorithm) {
                         return std::array{cannon(algorithm, 1.0 / 60, 1, 0.6), cannon(algorithm, 1e-5, 4e-3, 0.01)};
                     });
}
