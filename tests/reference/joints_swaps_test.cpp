// Joints that are added, removed and exchanged while a scene runs: momentum is conserved, no energy is added, and removed joints
// leave no trace.
#include "support/joints.h"

using namespace plab;
using namespace plab::simulation;
using namespace plab::test;

namespace
{

/// Two free bodies that tumble, held together at a point between them.
std::string pair(const std::string& joint_type)
{
    return solver_is("RungeKutta4") + body("a", 2, {.2, .3, .4}, {0, 0, 0}, "linear_velocity='1 0 0.3' angular_velocity='0.5 1 -0.4'") +
           body("b", 1, {.1, .1, .15}, {1, 0, 0}, "linear_velocity='-0.5 1 0' angular_velocity='1 -2 0.7'") +
           joint("j", joint_type, "a", "b", "anchor='0.6 0 0'");
}

struct Kept
{
    Vec3 momentum, angular;
    double energy = 0;
};
Kept kept(Scene& s)
{
    const auto totals = s.simulation().totals();
    return {totals.momentum, totals.angular_momentum, totals.kinetic};
}

}  // namespace

TEST_CASE("Ball, Hinge, Fixed, Slider in turn: momentum is conserved to rounding, energy only falls, by the amount booked")
{
    Scene s(pair("Ball"), dt(500));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const double start = kept(s).energy;
    s.run(.2);
    for (const std::string type : {"Hinge", "Fixed", "Slider", "Ball"})
    {
        CAPTURE(type);
        const Kept before = kept(s);
        REQUIRE(s.ask(SwapOperation{"j", "Constraint/" + type, {}}).done);
        s.step();
        const Kept after = kept(s);
        CHECK(distance(before.momentum, after.momentum) < 1e-13);
        CHECK(distance(before.angular, after.angular) < 1e-9);
        CHECK(after.energy < before.energy + 1e-12);
        s.step(100);
        CHECK(s.real("j", "position_error") < 1e-14);
        CHECK(std::fabs(kept(s).energy - after.energy) < 1e-9);
        CHECK(std::fabs(kept(s).energy - s.simulation().totals().work - start) < 1e-9);
    }
}

TEST_CASE("a joint that is removed leaves its bodies free, at the speeds that they had")
{
    Scene s(pair("Hinge"), dt(500));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(.5);
    const Kept before = kept(s);
    const Vec3 v = s.vec("a", "linear_velocity"), at = s.vec("a", "position");
    REQUIRE(s.ask(RemoveOperation{"j"}).done);
    CHECK(s.vec("a", "linear_velocity") == v);
    s.run(1);
    CHECK(distance(s.vec("a", "position"), at + .5 * v) < 1e-13);
    CHECK(std::fabs(kept(s).energy - before.energy) < 1e-12);
    CHECK(s.simulation().world().find("j") == kNoIndex);
}
