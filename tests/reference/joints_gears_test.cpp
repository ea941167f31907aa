// Gears between bodies and shafts, planetary trains, motors and springs on joints (catalogue: F6, F8).
#include <numbers>

#include "support/gravity.h"
#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

std::string shaft(const std::string& id, double inertia, double speed = 0, bool prescribed = false)
{
    return "<component id='" + id + "' type='State/Shaft' inertia='" + text(inertia) + "' angular_velocity='" + text(speed) + "'" +
           (prescribed ? " prescribed='true'" : "") + "/>";
}
std::string torque(const std::string& id, const std::string& on, double value)
{
    return "<component id='" + id + "' type='Script/Lua' driven='" + on +
           "'><param name='code'>function force(t, state) driven:add_torque(" + text(value) + ") end</param></component>";
}
std::string component(const std::string& id, const std::string& type, const std::string& more)
{
    return "<component id='" + id + "' type='" + type + "' " + more + "/>";
}
/// A wheel on a hinge about z.
std::string wheel(const std::string& id, double inertia, const Vec3& at, const std::string& more = "")
{
    return body(id, 1, {inertia, inertia, inertia}, at, more) + joint("bearing_" + id, "Hinge", "", id, "axis='0 0 1'");
}

}  // namespace

TEST_CASE("F6: Willis: with the ring held, a sun at 100 rad/s drives its carrier at 20")
{
    Scene s(shaft("sun", 1, 100, true) + shaft("ring", 1, 0, true) + shaft("carrier", 3) +
                component("train", "Constraint/Planetary", "sun='sun' ring='ring' carrier='carrier' sun_teeth='20' ring_teeth='80'"),
            dt(100));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(10);
    CHECK(near(s.spin("carrier"), 20, 1e-15));
    CHECK(near(s.angle("carrier"), 200, 1e-14));
    CHECK(std::fabs(s.real("train", "phase_error")) < 1e-11);
}

TEST_CASE("F6: a free train: accelerations and torques of d'Alembert")
{
    // c = (.2, .8, -1), lambda = -(c . M^-1 T) / (c . M^-1 c).
    Scene s(shaft("sun", 1) + shaft("ring", 2) + shaft("carrier", 4) + torque("t", "sun", 3) +
                component("train", "Constraint/Planetary", "sun='sun' ring='ring' carrier='carrier' sun_teeth='20' ring_teeth='80'"),
            dt(100));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(2);
    const double lambda = -(.2 * 3) / (.04 + .64 / 2 + 1. / 4);
    CHECK(near(s.spin("sun"), 2 * (3 + .2 * lambda), 1e-14));
    CHECK(near(s.spin("ring"), 2 * (.8 * lambda / 2), 1e-14));
    CHECK(near(s.spin("carrier"), 2 * (-lambda / 4), 1e-14));
    CHECK(near(s.real("train", "torque"), -lambda, 1e-14));
}

TEST_CASE("F8: a pendulum geared to a flywheel swings with the inertia of both, at any amplitude")
{
    // About the pivot: inertia .5, m g l = 4.905; flywheel .005 at ratio 10: w^2 = 9.81 / 2 for small angles.
    const double w = std::sqrt(4.905 / (.5 + 100 * .005));
    CHECK(near(w, 2.21472345903501, 1e-14));
    const double period = 4 * 1.8540746773013719 / w;  // K(sin 45 deg): released horizontally
    const auto error = [&](int steps)
    {
        Scene s(solver_is("RungeKutta4") + gravity() + body("bob", 1, {.25, .25, .25}, {.5, 0, 0}) +
                    joint("pivot", "Hinge", "", "bob", "anchor='0 0 0' axis='0 1 0'") + shaft("wheel", .005) +
                    component("gear", "Constraint/Gear", "driver='bob' driven='wheel' velocity_factor='10' driver_axis='0 1 0'"),
                "dt='" + text(period / steps) + "'");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.step(steps);
        CHECK(std::fabs(s.real("gear", "phase_error")) < 1e-13);
        CHECK(std::fabs(s.angle("wheel") - 10 * s.real("pivot", "angle")) < 1e-12);
        return distance(s.vec("bob", "position"), {.5, 0, 0}) + length(s.vec("bob", "linear_velocity"));
    };
    const double coarse = error(200), fine = error(400);
    MESSAGE("errors after a period: ", coarse, " ", fine);
    CHECK(fine < 1e-6);
    CHECK(std::log2(coarse / fine) > 3.7);
}

TEST_CASE("a wheel geared to a hinge beyond a slider and a hinge: what the joints hold does not fall")
{
    // Hinge and gear are a loop, the rest is a tree that hangs on the ground: its elimination must not begin there.
    const auto bar = [](const std::string& id, double x)
    {
        return "<component id='" + id + "' type='State/RigidBody' position='" + std::to_string(x) +
               " 0 0' mass='35' center_of_mass='-0.5 0 0' inertia='0.2 3.9 3.9'/>";
    };
    Scene s(std::string(kGravity) + bar("cart", 0) + bar("first", 0) + bar("second", -1) +
                component("slide", "Constraint/Slider", "b='cart' anchor='0 0 0' axis='1 0 0'") +
                component("hinge", "Constraint/Hinge", "a='cart' b='first' anchor='0 0 0' axis='0 0 1'") +
                component("knee", "Constraint/Hinge", "a='first' b='second' anchor='-1 0 0' axis='0 0 1'") +
                "<component id='wheel' type='State/Shaft' inertia='0.1'/>" +
                component("gear", "Constraint/Gear", "driver='second' driven='wheel' carrier='first' driver_axis='0 0 1'"),
            "dt='0.01'");
    s.run(1);
    for (const char* const id : {"cart", "first", "second"}) CHECK(std::fabs(s.vec(id, "position").z) < 1e-9);
}

TEST_CASE("F9: forces between helical teeth: 1000 N m at a pitch radius of 2 m, 20 deg of pressure, 10 deg of helix")
{
    // P_t = T / r, P_r = P_t tan 20 deg / cos 10 deg, P_a = P_t tan 10 deg, to 16 digits.
    constexpr double tangential = 500, radial = 184.79253090409537, axial = 88.1634903542325;
    for (const double sign : {1., -1.})
    {
        CAPTURE(sign);
        const std::string turn = text(-2000 * sign), hold = text(-1000 * sign);
        const auto script = [](const std::string& on, const std::string& value)
        {
            return "<component id='on_" + on + "' type='Script/Lua' driven='" + on +
                   "'><param name='code'>function force(t, state) driven:add_torque(" + value + ") end</param></component>";
        };
        const std::string mesh = " driven_radius='2' pressure_angle='20 deg' helix_angle='10 deg'";
        // Wheels of 4 and 2 m, at rest: on shafts against a locked one, and on bodies whose loads are in balance.
        Scene s(solver_is("RungeKutta4") + shaft("a", 1) + shaft("b", 1, 0, true) + script("a", turn) +
                    component("on_shafts", "Constraint/Gear", "driver='a' driven='b' velocity_factor='-2'" + mesh) +
                    wheel("c", 1, {0, 0, 0}) + wheel("d", 1, {6, 0, 0}) + script("c", "vec(0, 0, " + turn + ")") +
                    script("d", "vec(0, 0, " + hold + ")") +
                    component("on_bodies", "Constraint/Gear", "driver='c' driven='d' velocity_factor='-2'" + mesh) +
                    component("no_radius", "Constraint/Gear", "driver='e' driven='f' velocity_factor='-2'") + shaft("e", 1) +
                    shaft("f", 1, 0, true) + script("e", turn),
                dt(100));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(1);
        for (const char* gear : {"on_shafts", "on_bodies"})
        {
            CAPTURE(gear);
            CHECK(near(s.real(gear, "torque"), sign * 1000, 1e-12));
            CHECK(near(s.real(gear, "tangential_force"), sign * tangential, 1e-12));
            CHECK(near(s.real(gear, "radial_force"), radial, 1e-12));
            CHECK(near(s.real(gear, "axial_force"), sign * axial, 1e-12));
        }
        // A pure couple: the bearings of the wheels carry no load.
        CHECK(length(s.vec("bearing_d", "force")) < 1e-9);
        CHECK(near(s.real("no_radius", "torque"), sign * 1000, 1e-12));
        for (const char* output : {"tangential_force", "radial_force", "axial_force"}) CHECK(s.real("no_radius", output) == 0);
    }
}

TEST_CASE("the torque of a gear in motion is what accelerates its driven wheel, and tooth angles beyond 90 deg are refused")
{
    // A torque of 6 N m on J = 10, ratio -0.1, J = 100: F1.
    const std::string pair = shaft("a", 10) + shaft("b", 100) + torque("t", "a", 6);
    const std::string gear = "driver='a' driven='b' velocity_factor='-0.1' driven_radius='0.5'";
    Scene s(pair + component("gear", "Constraint/Gear", gear), dt(100));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1);
    CHECK(near(s.real("gear", "torque"), -100 * 0.6 / 11, 1e-13));
    CHECK(near(s.real("gear", "tangential_force"), -200 * 0.6 / 11, 1e-13));
    CHECK(near(s.real("gear", "radial_force"), 200 * 0.6 / 11 * std::tan(std::numbers::pi / 9), 1e-13));
    CHECK(s.real("gear", "axial_force") == 0);
    CHECK(Scene(pair + component("gear", "Constraint/Gear", gear + " pressure_angle='90 deg'")).error().find("pressure_angle") !=
          std::string::npos);
    CHECK(Scene(pair + component("gear", "Constraint/Gear", gear + " helix_angle='-90 deg'")).error().find("helix_angle") !=
          std::string::npos);
}

TEST_CASE("a gear between prescribed wheels that violate its ratio reports that once; one whose ratio they satisfy reports nothing")
{
    for (const double factor : {2., 3.})
    {
        Scene s(shaft("a", 1, 10, true) + shaft("b", 1, 20, true) +
                    component("gear", "Constraint/Gear", "driver='a' driven='b' velocity_factor='" + text(factor) + "'"),
                dt(60));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = s.keep_events = true;
        s.run(1);
        CHECK(s.count("constraint.contradiction") == (factor == 2 ? 0 : 1));
        CHECK(s.spin("b") == 20);
        CHECK(std::fabs(s.real("gear", "phase_error") - (20 - factor * 10)) < 1e-10);
    }
}

TEST_CASE("gears between bodies count their turns correctly at high speed and for a long time")
{
    // 1000 rad/s at 1/60: more than two turns a step.
    Scene s(solver_is("RungeKutta4") + wheel("a", 2, {0, 0, 0}, "angular_velocity='0 0 1000'") +
                wheel("b", 1, {1, 0, 0}, "angular_velocity='0 0 -2500'") +
                component("gear", "Constraint/Gear", "driver='a' driven='b' velocity_factor='-2.5'"),
            dt(60));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(100);
    CHECK(near(s.real("bearing_a", "angle"), 1e5, 1e-12));
    CHECK(near(s.real("bearing_b", "angle"), -2.5e5, 1e-12));
    CHECK(std::fabs(s.real("gear", "phase_error")) < 1e-9);
}

TEST_CASE("a gear that is added while wheels turn matches their speeds and books the energy that this takes")
{
    // F3 between bodies: J = 1 at 100 rad/s, J = 2 at rest, ratio -0.5.
    Scene s(solver_is("RungeKutta4") + wheel("a", 1, {0, 0, 0}, "angular_velocity='0 0 100'") + wheel("b", 2, {1, 0, 0}) +
                component("gear", "Constraint/Gear", "driver='a' driven='b' velocity_factor='-0.5'"),
            dt(60));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step();
    CHECK(near(s.vec("a", "angular_velocity").z, 200. / 3, 1e-13));
    CHECK(near(s.vec("b", "angular_velocity").z, -100. / 3, 1e-13));
}

TEST_CASE("a motor turns its wheel at the set speed; a servo approaches its target as exp(-gain t)")
{
    Scene s(solver_is("RungeKutta4") + wheel("a", 2, {0, 0, 0}) + component("m", "Constraint/Motor", "b='a' speed='3'") +
                wheel("b", 2, {2, 0, 0}) + component("servo", "Constraint/Motor", "b='b' mode='servo' speed='inf' target='7' gain='2'"),
            dt(100));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(3);
    CHECK(near(s.real("bearing_a", "angle"), 9, 1e-13));
    CHECK(near(s.real("bearing_b", "angle"), 7 * (1 - std::exp(-6.)), 1e-8));
}

TEST_CASE("springs along a line and about an axis oscillate at the frequencies of k/m and k/J")
{
    // Damped: x = exp(-c t / 2m) (cos + ..), against the closed form after 1 s.
    constexpr double k = 100, c = 2, m = 2, x0 = .1;
    const double decay = c / (2 * m), w = std::sqrt(k / m - decay * decay);
    const double expected = x0 * std::exp(-decay) * (std::cos(w) + decay / w * std::sin(w));
    Scene s(solver_is("RungeKutta4") + body("bob", m, {1, 1, 1}, {1 + x0, 0, 0}) +
                component("spring", "Constraint/SpringDamper", "b='bob' length='1' stiffness='100' damping='2'") +
                wheel("disc", m, {0, 5, 0}) + shaft("shaft", m) +
                component("torsion", "Constraint/TorsionSpring", "b='disc' stiffness='100' damping='2' rest='-0.1'") +
                component("torsion2", "Constraint/TorsionSpring", "b='shaft' stiffness='100' damping='2' rest='-0.1'"),
            dt(1000));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1);
    CHECK(near(s.vec("bob", "position").x - 1, expected, 1e-10));
    CHECK(near(s.real("bearing_disc", "angle") + .1, expected, 1e-10));
    CHECK(near(s.angle("shaft") + .1, expected, 1e-10));
    CHECK(near(s.simulation().totals().stored, .5 * k * expected * expected * 3, 1e-9));
}
