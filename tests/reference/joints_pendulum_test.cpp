// Pendulums, chains and tops on joints (catalogue: A4, A9, E1, E5, E6). Digits: closed forms and 113-bit integration.
#include <numbers>

#include "reference/pendulums.h"
#include "support/gravity.h"

using namespace plab;
using namespace plab::test;

namespace
{

struct PendulumRun
{
    double error = 0, drift = 0;
};
PendulumRun swing(const std::string& joint, const std::string& solver, int per_second)
{
    Scene s(pendulum(solver_is(solver), joint), dt(per_second));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    PendulumRun run;
    for (int i = 0; i < 10 * per_second; ++i)
    {
        s.step();
        run.drift = std::fmax(run.drift, s.real("j", "position_error"));
    }
    run.error = angle_error(s.vec("bob", "position"), kPendulumAt10);
    return run;
}

}  // namespace

TEST_CASE("E1: a pendulum satisfies its joint to rounding, and the solver keeps its order")
{
    for (const std::string joint : {"Distance", "Ball", "Hinge"})
    {
        CAPTURE(joint);
        const PendulumRun coarse = swing(joint, "RungeKutta4", 400), fine = swing(joint, "RungeKutta4", 800);
        CAPTURE(coarse.error);
        CAPTURE(fine.error);
        CHECK(coarse.drift < 1e-14);
        CHECK(fine.drift < 1e-14);
        const double order = std::log2(coarse.error / fine.error);
        CHECK(order > 3.8);
        CHECK(order < 4.6);
        CHECK(fine.error < 1e-8);
        const double first = std::log2(swing(joint, "SemiImplicitEuler", 2000).error / swing(joint, "SemiImplicitEuler", 4000).error);
        CHECK(first > 0.8);
        CHECK(first < 1.4);
    }
    CHECK(swing("Hinge", "RungeKutta4", 2000).error < 1e-11);
}

TEST_CASE("A9: a double pendulum of two points on rods")
{
    const auto ends = [](int per_second, double t)
    {
        Scene s(double_pendulum(solver_is("RungeKutta4")), dt(per_second));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(t);
        return double_pendulum_angles(s);
    };
    const auto at1 = ends(1000, 1);
    CHECK(near(at1[0], kDoublePendulumAt1[0], 1e-9));
    CHECK(near(at1[1], kDoublePendulumAt1[1], 1e-9));
    const auto at5 = ends(10000, 5);
    CHECK(near(at5[0], kDoublePendulumAt5[0], 1e-9));
    CHECK(near(at5[1], kDoublePendulumAt5[1], 1e-9));
    MESSAGE("errors at 5 s: ", at5[0] - kDoublePendulumAt5[0], " ", at5[1] - kDoublePendulumAt5[1]);
}

TEST_CASE("A4: Lagrange's top on a ball joint")
{
    const auto axis_at = [](const std::string& solver, int per_second, double t)
    {
        Scene s(top(solver_is(solver)), dt(per_second));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(t);
        return top_axis(s);
    };
    const double coarse = distance(axis_at("RungeKutta4", 1000, .1), kTopAtTenth),
                 fine = distance(axis_at("RungeKutta4", 2000, .1), kTopAtTenth);
    const double late = distance(axis_at("RungeKutta4", 1000, 1), kTopAt1);
    MESSAGE("errors ", coarse, " ", fine, " ", late);
    CHECK(coarse < 1e-6);
    CHECK(std::log2(coarse / fine) > 3.7);
    CHECK(late < 1e-4);
    CHECK(distance(axis_at("RungeKutta4", 4000, 1), kTopAt1) < 1e-6);
}

TEST_CASE("E5: a chain of 100 links carries a ball of a tonne")
{
    // Each joint carries the weight below it.
    Scene s(heavy_chain(solver_is("RungeKutta4"), 100), dt(60));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(5);
    for (int i = 0; i <= 100; ++i)
    {
        CAPTURE(i);
        CHECK(near(length(s.vec("j" + chain_id(i), "force")), (1100 - i) * kG, 1e-11));
        CHECK(std::fabs(s.real("j" + chain_id(i), "distance") - .1) < 1e-14);
    }
    CHECK(std::fabs(s.vec(chain_id(100), "position").z + 10.1) < 1e-12);
}

TEST_CASE("E6: the modes of a hanging chain are zeros of Laguerre's polynomial")
{
    // It returns after one period.
    for (const double w : kModes)
    {
        CAPTURE(w);
        const int steps = 400;
        Scene s(mode_chain(solver_is("RungeKutta4"), w), "dt='" + text(2 * std::numbers::pi / w / steps) + "'");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.step(steps);
        const auto x = mode_shape(w);
        for (int k = 0; k < kModeLinks; ++k)
            CHECK(std::fabs(s.vec(mode_id(k), "position").x - kModeAmplitude * x[static_cast<std::size_t>(k)]) < 1e-10);
        // At rest again, to second order in the error of w.
        CHECK(length(s.vec(mode_id(0), "linear_velocity")) < kModeAmplitude * w * 1e-4);
    }
}
