// A7 by every solver: m = 1 on k = 1, dt = 0.01 s, 1e5 steps (1e3 rad). Runs of 1e7 steps: motion_long_test.cpp.
//
// What the energy x^2 + v^2 does, by theory:
//   SemiImplicitEuler     keeps x^2 + v^2 - h x v: oscillates by h/2 about 1, no slope
//   StoermerVerlet        keeps v^2 + (1 - h^2/4) x^2: oscillates by h^2/8, no slope
//   RotationSplitting 2   keeps x^2 + (1 - h^2/4) v^2: the same
//   RotationSplitting 4   symplectic: no slope
//   ImplicitMidpoint      keeps x^2 + v^2 if it iterates to rounding. By default the iteration ends at 1e-12 of a step's change, of
//                         which a contraction by h/2 remains, of one sign: a slope below 1e-12 h/2 per step
//   Exponential           exact
//   RungeKutta4           |R(i h)|^2 = 1 - h^6/72 per step; Automatic is RungeKutta4 here, Exact is RotationSplitting 4
//   DormandPrince54       |R(i h)|^2 = 1 - h^6/1800 where it does not divide the step; less where its tolerance does
//   Radau5                |R(i h)|^2 = 1 - h^6/3600
#include <vector>

#include "reference/algorithms.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kStep = 0.01;

struct Swing
{
    double drift = 0, swing = 0;  ///< of x^2 + v^2: slope of the fitted line times the time, and the largest deviation from that line
};

Swing swing_of(const SolverAlgorithm& algorithm, int steps)
{
    Scene s(spring_scene(algorithm, 1, 0), "dt=\"0.01\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    std::vector<double> energy;
    for (int i = 0; i < steps; ++i)
    {
        s.step();
        const double x = s.vec("mass", "position").x, v = s.vec("mass", "linear_velocity").x;
        energy.push_back(x * x + v * v - 1);
    }
    // Least squares over t = -1 .. 1.
    const auto n = static_cast<double>(steps);
    double mean = 0, moment = 0, square = 0;
    const auto at = [&](int i) { return (2 * i + 1 - n) / n; };
    for (int i = 0; i < steps; ++i)
    {
        const double e = energy[static_cast<std::size_t>(i)];
        mean += e / n, moment += at(i) * e, square += at(i) * at(i);
    }
    Swing out;
    out.drift = 2 * moment / square;
    for (int i = 0; i < steps; ++i)
        out.swing = std::fmax(out.swing, std::fabs(energy[static_cast<std::size_t>(i)] - mean - at(i) * moment / square));
    return out;
}

}  // namespace

TEST_CASE("A7: the energy of an oscillator with every solver: no slope if the method is symplectic, otherwise the slope of its law")
{
    struct Row
    {
        SolverAlgorithm algorithm;
        int steps;
        double swing;      ///< the largest deviation from the line; 0: rounding
        double per_step;   ///< the law's slope
        double loose = 0;  ///< and the tolerance of it
    };
    const double h2 = kStep * kStep, h6 = h2 * h2 * h2;
    const Row table[] = {
        {{"SemiImplicitEuler"}, 100'000, kStep / 2, 0},
        {{"StoermerVerlet"}, 100'000, h2 / 8, 0},
        {{"RotationSplitting", "order=\"2\""}, 100'000, h2 / 8, 0},
        {{"RotationSplitting"}, 50'000, 1.4e-12, 0},
        {{"Exact"}, 10'000, 1.4e-12, 0},
        {{"ImplicitMidpoint"}, 100'000, 0, 0, 1e-12 * kStep / 2},
        {{"ImplicitMidpoint", "relative_tolerance=\"1e-15\""}, 50'000, 0, 0},
        {{"Exponential"}, 10'000, 0, 0},
        {{"RungeKutta4"}, 100'000, 0, -h6 / 72},
        {{"Automatic"}, 100'000, 0, -h6 / 72},
        {{"DormandPrince54", "relative_tolerance=\"1e-7\""}, 50'000, 0, -h6 / 1800},
        {{"DormandPrince54"}, 50'000, 0, -h6 / 3600, h6 / 3600},
        {{"Radau5"}, 10'000, 0, -h6 / 3600},
    };
    for (const Row& row : table)
    {
        const std::string name = name_of(row.algorithm);
        CAPTURE(name);
        const Swing found = swing_of(row.algorithm, row.steps);
        const double law = row.per_step * row.steps, loose = row.loose * row.steps, rounding = 1e-12 * std::sqrt(row.steps / 1e6);
        MESSAGE(name << ": drift " << found.drift << " (" << law << "), swing " << found.swing << " (" << row.swing << ")");
        // The fit of an oscillation over a number of periods that is not whole leaves 3 / (2 w T) of it.
        CHECK(std::fabs(found.drift - law) < 0.02 * std::fabs(law) + 0.01 * row.swing + loose + rounding);
        CHECK(found.swing < 1.01 * row.swing + 0.02 * (std::fabs(law) + loose) + rounding);
        CHECK(found.swing > 0.99 * row.swing);
    }
}
