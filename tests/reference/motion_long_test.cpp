// A7 and A8: 1e7 steps. A7, oscillator w = 1, dt = 0.01 s: the quantity that each symplectic method conserves instead of the energy
// is constant to rounding, 1e-12 sqrt(n / 1e6) relative, and the energy within what that allows. Every other solver, with its law:
// motion_oscillator_algorithms_test.cpp.
//   SemiImplicitEuler     1e7 steps   keeps x^2 + v^2 - h x v       energy within h/2
//   StoermerVerlet        1e7         v^2 + (1 - h^2/4) x^2         h^2/4
//   RotationSplitting 2   1e7         x^2 + (1 - h^2/4) v^2         h^2/4
//   RotationSplitting 4   1e6         the energy to 6e-12
//   ImplicitMidpoint      1e6         x^2 + v^2, with relative_tolerance 1e-15; with the default to 5e-15 n
//   RungeKutta4           1e6         loses n h^6 / 72, its law
//   Exponential           1e5         1e-12
// A8, the clock: n dt to the last bit after 1e7 steps of 1e-3 s and of 1/60 s
#include "reference/algorithms.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kLongStep = 0.01;

struct LongSwing
{
    double worst = 0, kept = 0, last = 0;  ///< relative: of the energy, of x^2 + a x v + b v^2; energy at the end
};

/// a, b: the method conserves x^2 + a x v + b v^2, which is 1 at the start.
LongSwing swing(const SolverAlgorithm& algorithm, std::int64_t steps, double a = 0, double b = 1)
{
    Scene s(spring_scene(algorithm, 1, 0), "dt=\"0.01\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    LongSwing out;
    for (std::int64_t i = 0; i < steps; i += 997)
    {
        s.step(std::min<std::int64_t>(997, steps - i));
        const double x = s.vec("mass", "position").x, v = s.vec("mass", "linear_velocity").x;
        out.last = x * x + v * v - 1;
        out.worst = std::fmax(out.worst, std::fabs(out.last));
        out.kept = std::fmax(out.kept, std::fabs(x * x + a * x * v + b * v * v - 1));
    }
    MESSAGE(name_of(algorithm) << ": energy " << out.worst << ", kept " << out.kept << ", at the end " << out.last);
    return out;
}

}  // namespace

TEST_CASE("A7: energy over 1e7 steps: bounded for symplectic methods, otherwise lost by the method's law")
{
    const double h2 = kLongStep * kLongStep;
    struct Row
    {
        SolverAlgorithm algorithm;
        std::int64_t steps;
        double a, b, worst;
    };
    const Row table[] = {{{"SemiImplicitEuler"}, 10'000'000, -kLongStep, 1, kLongStep / 2},
                         {{"StoermerVerlet"}, 10'000'000, 0, 1 / (1 - h2 / 4), h2 / 4},
                         {{"RotationSplitting", "order=\"2\""}, 10'000'000, 0, 1 - h2 / 4, h2 / 4},
                         {{"ImplicitMidpoint", "relative_tolerance=\"1e-15\""}, 1'000'000, 0, 1, 0}};
    for (const Row& row : table)
    {
        const std::string name = name_of(row.algorithm);
        CAPTURE(name);
        const LongSwing found = swing(row.algorithm, row.steps, row.a, row.b);
        const double rounding = 1e-12 * std::sqrt(static_cast<double>(row.steps) / 1e6);
        CHECK(found.kept < rounding);
        CHECK(found.worst < 1.01 * row.worst + rounding);
        CHECK(found.worst >= 0.99 * row.worst);
    }
    // With the default setting, its iteration ends at 1e-12 of a step's change: a slope below 1e-12 h/2 per step.
    CHECK(swing({"ImplicitMidpoint"}, 1'000'000).worst < 1e6 * 1e-12 * kLongStep / 2);
    CHECK(swing({"RotationSplitting"}, 1'000'000).worst < 6e-12);
    // The ratio is compared, as doctest::Approx allows an absolute epsilon near 0.
    CHECK(swing({"RungeKutta4"}, 1'000'000).last / (-1e6 * 1e-12 / 72) == doctest::Approx(1).epsilon(0.005));
    CHECK(swing({"Exponential"}, 100'000).worst < 1e-12);
}

TEST_CASE("A8: the clock is n dt to the last bit after 1e7 steps")
{
    Scene milli("", "dt=\"0.001\"");
    REQUIRE_MESSAGE(milli.loaded(), milli.error());
    milli.step(10'000'000);
    CHECK(milli.simulation().time() == 10000.0);
    Scene sixty("", "dt=\"1/60\"");
    sixty.step(10'000'001);
    CHECK(sixty.simulation().time() == 10000001.0 / 60.0);
}
