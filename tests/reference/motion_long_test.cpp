// A7 and A8: 1e7 steps. A7, oscillator w = 1, dt = 0.01 s, relative energy error
//   StoermerVerlet  1e7 steps   swings within h^2 / 4 (1 + 1e-3); what it keeps, v^2 + (1 - h^2/4) x^2, to 1e-12 sqrt(n / 1e6)
//   RungeKutta4     1e6 steps   loses n h^6 / 72, its law
//   Exponential     1e5 steps   1e-12
// A8, the clock: n dt to the last bit after 1e7 steps of 1e-3 s and of 1/60 s
#include "reference/motion.h"

using namespace plab;
using namespace plab::test;

namespace
{

struct Swing
{
    double worst = 0, kept = 0, last = 0;  ///< relative: of the energy, of the method's own invariant; energy at the end
};

Swing swing(const SolverRung& rung, std::int64_t steps)
{
    Scene s(spring_scene(rung, 1, 0), "dt=\"0.01\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const double h2 = 1e-4;
    Swing out;
    for (std::int64_t i = 0; i < steps; i += 997)
    {
        s.step(std::min<std::int64_t>(997, steps - i));
        const double x = s.vec("mass", "position").x, v = s.vec("mass", "linear_velocity").x;
        out.last = x * x + v * v - 1;
        out.worst = std::fmax(out.worst, std::fabs(out.last));
        out.kept = std::fmax(out.kept, std::fabs((v * v + (1 - h2 / 4) * x * x) / (1 - h2 / 4) - 1));
    }
    return out;
}

}  // namespace

TEST_CASE("A7: energy over 1e7 steps: bounded where it should be, lost by the law where not")
{
    const Swing verlet = swing({"StoermerVerlet"}, 10'000'000);
    MESSAGE("StoermerVerlet: " << verlet.worst << " " << verlet.kept);
    CHECK(verlet.worst < 0.25e-4 * 1.001);
    CHECK(verlet.kept < 1e-12 * std::sqrt(10.0));
    const Swing classical = swing({"RungeKutta4"}, 1'000'000);
    MESSAGE("RungeKutta4: " << classical.last);
    CHECK(classical.last == doctest::Approx(-1e6 * 1e-12 / 72).epsilon(0.01));
    const Swing exact = swing({"Exponential"}, 100'000);
    MESSAGE("Exponential: " << exact.worst);
    CHECK(exact.worst < 1e-12);
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
