// Work and wrenches that joints report, against closed forms.
#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

double work_of(Scene& s, const std::string& id) { return s.simulation().stepper().work()[s.simulation().world().find(id)]; }

}  // namespace

TEST_CASE("a joint that is added removes kinetic energy, and books it; a passive one does no work")
{
    // Two points of 1 and 3 kg are connected by a rod: their speeds along it become equal.
    Scene s(solver_is("RungeKutta4") + body("p", 1, {1, 1, 1}, {0, 0, 0}, "linear_velocity='0 4 0'") + body("q", 3, {1, 1, 1}, {0, 2, 0}) +
                joint("rod", "Distance", "p", "q", ""),
            dt(100));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1);
    CHECK(near(s.vec("p", "linear_velocity").y, 1, 1e-14));
    CHECK(near(work_of(s, "rod"), .5 * 4 - .5 * 16, 1e-13));
    CHECK(near(s.simulation().totals().kinetic, 2, 1e-13));
}

TEST_CASE("a motor's work is the energy of its load, lifted and spun up")
{
    // 2 kg lifted at 0.5 m/s for 3 s: m g z + m v^2 / 2. A rotor spun up by a servo: its kinetic energy.
    Scene s(solver_is("RungeKutta4") + gravity() + body("load", 2, {.1, .1, .1}, {0, 0, 0}) +
                joint("rail", "Slider", "", "load", "axis='0 0 1'") +
                joint("winch", "Motor", "", "load", "along='slide' axis='0 0 1' speed='0.5'") +
                "<component id='rotor' type='State/Shaft' inertia='2'/>" +
                joint("servo", "Motor", "", "rotor", "mode='servo' target='4' speed='inf' gain='3'"),
            dt(100));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(3);
    CHECK(near(work_of(s, "winch"), 2 * 9.81 * 1.5 + .25, 1e-12));
    CHECK(std::fabs(work_of(s, "rail")) < 1e-13);
    CHECK(near(s.vec("winch", "force").z, 2 * 9.81, 1e-13));
    // 144 J that it supplied at once and then removed again: the quadrature of the solver.
    CHECK(near(work_of(s, "servo"), s.simulation().totals().kinetic - .25, 1e-5));
}

TEST_CASE("wrenches act on b: a hinge carries the weight and the moment of the bodies that hang on it")
{
    // A bracket of 1 m along x, fixed to the wall at the origin; a lamp of 3 kg hangs on its end.
    Scene s(solver_is("RungeKutta4") + gravity() + body("bracket", 2, {.1, .1, .1}, {.5, 0, 0}) +
                body("lamp", 3, {.1, .1, .1}, {1, 0, -.5}) + joint("wall", "Fixed", "", "bracket", "anchor='0 0 0'") +
                joint("hook", "Hinge", "bracket", "lamp", "anchor='1 0 0' axis='0 1 0'"),
            dt(100));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1);
    CHECK(distance(s.vec("hook", "force"), {0, 0, 3 * 9.81}) < 1e-12);
    CHECK(distance(s.vec("wall", "force"), {0, 0, 5 * 9.81}) < 1e-12);
    // About the bracket's centre of mass: the lamp's weight has a lever arm of 0.5 m, and the wall balances it.
    CHECK(distance(s.vec("wall", "torque"), {0, -3 * 9.81 * .5, 0}) < 1e-12);
}
