// Mechanisms whose joints have several axes: between these stand links of next to no mass, as imported robots have them, and rotors. Where
// such a mechanism touches something, its contacts are solved in their impulses alone (interactions/managers/delassus.h), so the joints
// hold to rounding.
//
//   a machine at rest whose rotors hang on its own joints    gravity does no work: 1e-9 J (it did 32 J, and the links moved)
//   a tail of 11 links, two axes each, dropped               its energy never rises, and joints hold to 1e-6 m
//   a stool on five legs with brakes in each of three axes   stands still to 1e-9 m, whatever way its feet share the load
#include "support/gravity.h"
#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

const char* const kLevelFloor = "<component id='floor' type='Shape/Plane'/><component id='ground' type='State/Static' shape='floor'/>";

/// A link without shape, of a hundred-thousandth of the mass of its neighbours.
std::string light_link(const std::string& id, double mass, const Vec3& position)
{
    const double m = 1e-5 * mass, inertia = 1e-3 * m;
    return body(id, m, {inertia, inertia, inertia}, position);
}

double energy_of(const Scene& s)
{
    const simulation::Totals totals = s.simulation().totals();
    return totals.kinetic + totals.stored;
}

constexpr int kLinks = 12;

/// A block of 20 kg with a tail of capsules of 2 g that begins level, 0.1 m above the floor. Each joint has two axes, a light link between
/// them, a rotor on each axis, and dampers that stop a link within a small part of a step.
std::string tail()
{
    std::string out = std::string(kLevelFloor) + kGravity +
                      "<component id='c' type='CDetection/ODE' between='*' resolution='Resolution/Speculative' response.friction='0.9'/>"
                      "<component id='bone' type='Shape/Capsule' radius='0.01' length='0.02' orientation='0.7071067811865476 0 "
                      "0.7071067811865476 0'/>" +
                      body("b0", 20, {0.3, 0.3, 0.3}, {-0.18, 0, 0.1}, "shape='Shape/Box' shape.half_extents='0.15 0.15 0.1'");
    for (int i = 1; i < kLinks; ++i)
    {
        const std::string id = std::to_string(i), before = "b" + std::to_string(i - 1), half = "h" + id, own = "b" + id;
        const double x = 0.045 * i - 0.0225;
        out += body(own, 0.002, {1e-7, 4e-7, 4e-7}, {x + 0.0225, 0, 0.1},
                    "shape='bone' angular_velocity='" + std::string(i % 2 == 0 ? "1" : "-2") + " 3 0'");
        out += light_link(half, 0.002, {x, 0, 0.1});
        const auto add_axis = [&](const std::string& name, const std::string& a, const std::string& b, const std::string& axis)
        {
            const std::string how = "anchor='" + text(x) + " 0 0.1' axis='" + axis + "'";
            out += joint(name + id, "Hinge", a, b, how) +
                   joint("s" + name + id, "TorsionSpring", a, b, how + " stiffness='0.02' damping='0.005'");
            out += "<component id='r" + name + id + "' type='State/Shaft' position='" + text(x) + " 0 0.1' axis='" + axis +
                   "' inertia='1e-6'/><component id='g" + name + id + "' type='Constraint/Gear' driver='" + b + "' driven='r" + name + id +
                   "' carrier='" + a + "' driver_axis='" + axis + "'/>";
        };
        add_axis("u", before, half, "0 1 0");
        add_axis("v", half, own, "0 0 1");
    }
    return out;
}

}  // namespace

TEST_CASE("a tail of light links with two axes falls on the floor: joints hold, and no energy comes from nothing")
{
    Scene s(tail(), "dt='1/200'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = true;
    double least = energy_of(s), risen = 0, apart = 0, worst = 0;
    int swept = 0;
    for (int i = 0; i < 200; ++i)
    {
        s.step();
        worst = std::fmax(worst, s.real("c.response.manager", "residual"));
        swept += std::get<std::int64_t>(s.get("c.response.manager", "fallbacks")) > 0 ? 1 : 0;
        risen = std::fmax(risen, energy_of(s) - least), least = std::fmin(least, energy_of(s));
        for (int k = 1; k < kLinks; ++k)
            for (const char* const joint : {"u", "v"}) apart = std::fmax(apart, s.real(joint + std::to_string(k), "position_error"));
    }
    MESSAGE("worst residual " << worst << " m/s, swept " << swept << " times, apart " << apart << " m, risen " << risen << " J");
    CHECK(worst < 1e-8);  // with a damper for each joint: 3e-8
    CHECK(swept == 0);
    CHECK(risen < 1e-9);
    CHECK(apart < 1e-6);
    for (int i = 1; i < kLinks; ++i) CHECK(s.vec("b" + std::to_string(i), "position").z < 0.1);
}

TEST_CASE("rotors on the joints of a machine at rest: gravity does no work on it")
{
    // Three links of 30 kg on two light ones, level, on rails and upright hinges. The rows of a rotor refer to both bodies of its hinge, so
    // they are refined (row_equations.h), which must not stop because nothing moves.
    std::string scene = std::string(kGravity) + light_link("x", 30, {}) + light_link("y", 30, {}) +
                        joint("jx", "Slider", "", "x", "axis='1 0 0'") + joint("jy", "Slider", "x", "y", "axis='0 1 0'");
    std::string before = "y";
    for (int i = 0; i < 3; ++i)
    {
        const std::string id = std::to_string(i), link = "l" + id, anchor = "anchor='" + std::to_string(i) + " 0 0' axis='0 0 1'";
        scene += body(link, 30, {0.2, 3, 3}, {i + 0.5, 0, 0}) + joint("j" + id, "Hinge", before, link, anchor);
        scene += "<component id='r" + id + "' type='State/Shaft' position='" + std::to_string(i) + " 0 0' axis='0 0 1' inertia='0.1'/>";
        scene += "<component id='a" + id + "' type='Constraint/Gear' driver='" + link + "' driven='r" + id + "' carrier='" + before +
                 "' driver_axis='0 0 1'/>";
        before = link;
    }
    Scene s(scene, "dt='0.01'");
    s.run(1);
    CHECK(std::fabs(s.simulation().totals().work) < 1e-9);
    CHECK(s.simulation().totals().kinetic < 1e-15);
}

TEST_CASE("a stool stands still on five legs with brakes in three axes each")
{
    std::string scene = std::string(kLevelFloor) + kGravity +
                        "<component id='c' type='CDetection/ODE' between='*' response.friction='0.8' response.manager='manager'/>"
                        "<component id='manager' type='Manager/Automatic'/>" +
                        body("seat", 5, {0.1, 0.1, 0.2}, {0, 0, 0.5}, "shape='Shape/Cylinder' shape.radius='0.3' shape.height='0.04'");
    for (int i = 0; i < 5; ++i)
    {
        const std::string id = std::to_string(i), leg = "leg" + id, middle[] = {"seat", "x" + id, "y" + id, leg};
        const double angle = 2 * 3.14159265358979 * i / 5, x = 0.25 * std::cos(angle), y = 0.25 * std::sin(angle);
        scene += body(leg, 0.3, {6e-3, 6e-3, 1e-4}, {x, y, 0.25}, "shape='Shape/Sphere' shape.radius='0.03' shape.position='0 0 -0.22'");
        const Vec3 hip{x, y, 0.48};
        scene += light_link("x" + id, 0.3, hip) + light_link("y" + id, 0.3, hip);
        const char* const axes[] = {"1 0 0", "0 1 0", "0 0 1"};
        for (int k = 0; k < 3; ++k)
        {
            const std::string how = "anchor='" + text(hip) + "' axis='" + axes[k] + "'";
            scene += joint("h" + std::to_string(k) + id, "Hinge", middle[k], middle[k + 1], how);
            scene += joint("m" + std::to_string(k) + id, "Motor", middle[k], middle[k + 1],
                           how + " speed='0' max_effort='20' manager='manager'");
        }
    }
    Scene s(scene, "dt='1/240'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(0.5);
    const Vec3 seat = s.vec("seat", "position");
    CHECK(distance(seat, {0, 0, 0.5}) < 1e-9);
    CHECK(length(s.vec("seat", "angular_velocity")) < 1e-9);
    CHECK(s.real("manager", "residual") < 1e-9);
    for (int i = 0; i < 5; ++i)
        for (int k = 0; k < 3; ++k) CHECK(s.real("h" + std::to_string(k) + std::to_string(i), "position_error") < 1e-9);
}
