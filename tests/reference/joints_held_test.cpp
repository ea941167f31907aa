// Rows with bounded impulses (limits, motors with a largest effort), and joints among contacts: rows that managers satisfy.
#include <algorithm>
#include <numbers>

#include "support/gravity.h"
#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

std::string manager(const std::string& type = "Direct") { return "<component id='manager' type='Manager/" + type + "'/>"; }
std::string shape(const std::string& id, const std::string& type, const std::string& more)
{
    return "<component id='" + id + "' type='Shape/" + type + "' " + more + "/>";
}
/// A plane whose normal is z, turned and moved by `pose`.
std::string ground(const std::string& pose = "")
{
    return shape("plane", "Plane", "") + "<component id='ground' type='State/Static' shape='plane' " + pose + "/>";
}
std::string contacts(const std::string& between, const std::string& law, const std::string& against = "ground")
{
    return manager() + "<component id='response' type='Response/Rows' manager='manager' " + law + "/>" +
           "<component id='contact' type='CDetection/ODE' between='" + between + "' against='" + against +
           "' resolution='Resolution/LocalRoot' response='response'/>";
}
std::string held_shaft(const std::string& id, double inertia, const std::string& more = "")
{
    return "<component id='" + id + "' type='State/Shaft' inertia='" + text(inertia) + "' " + more + "/>";
}
std::string load(const std::string& on, double torque)
{
    return "<component id='load' type='Field/Load' between='" + on + "' shaft_torque='" + text(torque) + "'/>";
}

}  // namespace

TEST_CASE("a limit stops a fall along a slider, with and without rebound")
{
    // 0.5 m down to the bound; with e = 0.5 it rises to 1/8 m, and is at rest after sqrt(2 h/g) (1 + e)/(1 - e).
    const double fall = std::sqrt(1 / kG);
    for (const double e : {0., .5})
    {
        CAPTURE(e);
        Scene s(solver_is("RungeKutta4") + gravity() + body("bob", 2, {.1, .1, .1}, {0, 0, .5}) +
                    joint("rail", "Slider", "", "bob", "axis='0 0 1' anchor_a='0 0 0'") + manager() +
                    joint("stop", "Limit", "", "bob",
                          "along='slide' axis='0 0 1' anchor_a='0 0 0' anchor_b='0 0 0' lower='0' restitution='" + text(e) +
                              "' manager='manager'"),
                dt(1000));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(.9 * fall);
        CHECK(near(s.real("stop", "position"), .5 - .5 * kG * s.simulation().time() * s.simulation().time(), 1e-13));
        CHECK(length(s.vec("stop", "force")) == 0);
        double deepest = 0, highest = 0;
        while (s.simulation().time() < fall * 3.5)
        {
            s.step();
            deepest = std::fmin(deepest, s.real("stop", "position"));
            if (s.simulation().time() > fall * 1.05) highest = std::fmax(highest, s.real("stop", "position"));
        }
        MESSAGE("e ", e, ": deepest ", deepest, ", highest ", highest);
        CHECK(deepest > -5e-3);
        CHECK(std::fabs(highest - .5 * e * e) < 1e-2 * e + 1e-9);
        CHECK(std::fabs(s.real("stop", "position")) < 1e-6);
        CHECK(near(s.vec("stop", "force").z, 2 * kG, 1e-9));
        CHECK(s.real("rail", "position_error") < 1e-12);
    }
}

TEST_CASE("a limit rebounds with its restitution, combined with joints, with Direct and with SoftStep")
{
    // Falls 0.5 m: arrives at v = sqrt(g). A pendulum released horizontally reaches 0.6 rad with w^2 = 2 m g l sin(0.6) / J.
    struct Row
    {
        std::string type;
        double error;  ///< m, of the joints: those of SoftStep are compliant
    };
    for (const Row& row : {Row{"Direct", 1e-6}, Row{"SoftStep", 3e-3}})
        for (const double e : {0., .5, 1.})
        {
            CAPTURE(row.type);
            CAPTURE(e);
            const std::string bounce = "' restitution='" + text(e) + "' manager='manager'";
            Scene s(
                solver_is("RungeKutta4") + gravity() + manager(row.type) + body("bob", 2, {.1, .1, .1}, {0, 0, .5}) +
                    joint("rail", "Slider", "", "bob", "axis='0 0 1' anchor_a='0 0 0'") +
                    joint("stop", "Limit", "", "bob", "along='slide' axis='0 0 1' anchor_a='0 0 0' anchor_b='0 0 0' lower='0" + bounce) +
                    body("weight", 1, {.1, .1, .1}, {9, 5, 0}) + joint("pivot", "Hinge", "", "weight", "anchor='8 5 0' axis='0 1 0'") +
                    joint("end", "Limit", "", "weight", "anchor='8 5 0' axis='0 1 0' upper='0.6" + bounce),
                dt(1000));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.warnings_expected = true;
            const double arrives = std::sqrt(kG), turns = std::sqrt(2 * kG * std::sin(.6) / 1.1);
            double fastest = 0, most_turn = 0;
            while (s.simulation().time() < .6)
            {
                s.step();
                fastest = std::fmax(fastest, s.vec("bob", "linear_velocity").z);
                most_turn = std::fmax(most_turn, -s.vec("weight", "angular_velocity").y);
            }
            MESSAGE(row.type, " e ", e, ": ", fastest / arrives - e, ", ", most_turn / turns - e);
            CHECK(std::fabs(fastest / arrives - e) < 5e-3);
            CHECK(std::fabs(most_turn / turns - e) < 5e-3);
            CHECK(s.real("rail", "position_error") < row.error);
            CHECK(s.real("pivot", "position_error") < row.error);
        }
}

TEST_CASE("a beam that lies on a stone and hangs in a hinge: the hinge carries half of its weight, with every manager")
{
    for (const char* type : {"Direct", "SequentialImpulse", "SoftStep"})
    {
        CAPTURE(type);
        Scene s(gravity() + manager(type) + shape("stone", "Box", "half_extents='0.1 0.5 0.5'") +
                    "<component id='below' type='State/Static' shape='stone' position='1 0 -0.55'/>" +
                    shape("beam", "Box", "half_extents='1 0.1 0.05'") +
                    "<component id='rod' type='State/RigidBody' mass='4' shape='beam'/>" +
                    joint("pivot", "Hinge", "", "rod", "anchor='-1 0 0' axis='0 1 0'") +
                    "<component id='response' type='Response/Rows' manager='manager'/>"
                    "<component id='contact' type='CDetection/ODE' between='rod below' resolution='Resolution/None' response='response'/>",
                dt(240));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = true;
        s.run(2);
        // The stone carries the beam between x = 0.9 and its end at 1: the rest is the hinge's.
        const double force = s.vec("pivot", "force").z / (4 * kG);
        CHECK(force > 0.47);
        CHECK(force < 0.51);
    }
}

TEST_CASE("a manager that does not converge warns, with readable numbers")
{
    Scene s(gravity() + shape("cube", "Box", "half_extents='0.5 0.5 0.5'") + ground() +
            "<component id='manager' type='Manager/SequentialImpulse' tolerance='1e-13' max_iterations='2'/>"
            "<component id='response' type='Response/Rows' manager='manager' friction='0.5'/>"
            "<component id='contact' type='CDetection/ODE' between='low high' against='ground' response='response'/>"
            "<component id='low' type='State/RigidBody' mass='1' shape='cube' position='0 0 0.5'/>" +
            "<component id='high' type='State/RigidBody' mass='1000' shape='cube' position='0.1 0 1.5'/>");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = s.keep_events = true;
    s.step(20);
    const auto reported = std::find_if(s.events.begin(), s.events.end(), [](const Event& e) { return e.kind == "manager.not_converged"; });
    REQUIRE(reported != s.events.end());
    CHECK(reported->severity == Severity::Warning);
    CHECK_MESSAGE(reported->message.find("the tolerance is 1e-13") != std::string::npos, reported->message);
    CHECK_MESSAGE(reported->message.find("0.000") == std::string::npos, reported->message);
}

TEST_CASE("a pendulum comes to rest on the limit of its hinge, which carries its moment")
{
    Scene s(solver_is("RungeKutta4") + gravity() + body("bob", 1, {.1, .1, .1}, {1, 0, 0}) +
                joint("pivot", "Hinge", "", "bob", "anchor='0 0 0' axis='0 1 0'") + manager() +
                joint("stop", "Limit", "", "bob", "anchor='0 0 0' axis='0 1 0' upper='0.6' restitution='0.3' manager='manager'"),
            dt(1000));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(6);
    CHECK(std::fabs(s.real("stop", "position") - .6) < 1e-6);
    CHECK(std::fabs(s.real("stop", "rate")) < 1e-9);
    CHECK(near(s.vec("stop", "torque").y, -kG * std::cos(.6), 1e-5));
    CHECK(s.real("pivot", "position_error") < 1e-9);
    CHECK(s.simulation().totals().kinetic < 1e-15);
}

TEST_CASE("a rope is a limit of distance: it is slack up to its length, then it carries the weight")
{
    Scene s(solver_is("RungeKutta4") + gravity() + body("bob", 3, {.1, .1, .1}, {0, 0, -.5}) + manager() +
                joint("rope", "Limit", "", "bob", "along='distance' anchor_a='0 0 0' anchor_b='0 0 0' upper='1' manager='manager'"),
            dt(1000));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(.3);
    CHECK(near(s.vec("bob", "position").z, -.5 - .5 * kG * .09, 1e-13));
    s.run(2);
    CHECK(std::fabs(s.vec("bob", "position").z + 1) < 1e-6);
    CHECK(near(s.vec("rope", "force").z, 3 * kG, 1e-9));
}

TEST_CASE("a motor with a largest effort exerts that until it has reached its speed, and yields to a larger load")
{
    // 4 N m on 2 kg m^2: 2 rad/s^2, up to 3 rad/s.
    Scene s(solver_is("RungeKutta4") + held_shaft("rotor", 2) + manager() +
                "<component id='motor' type='Constraint/Motor' b='rotor' speed='3' max_effort='4' manager='manager'/>",
            dt(100));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1);
    CHECK(near(s.spin("rotor"), 2, 1e-12));
    CHECK(near(s.angle("rotor"), 1, 1e-12));
    CHECK(near(s.vec("motor", "torque").x, 4, 1e-12));
    s.run(3);
    CHECK(near(s.spin("rotor"), 3, 1e-12));
    CHECK(std::fabs(s.vec("motor", "torque").x) < 1e-12);

    Scene weak(solver_is("RungeKutta4") + held_shaft("rotor", 2) + load("rotor", -10) + manager() +
                   "<component id='motor' type='Constraint/Motor' b='rotor' speed='3' max_effort='4' manager='manager'/>",
               dt(100));
    REQUIRE_MESSAGE(weak.loaded(), weak.error());
    weak.run(1);
    CHECK(near(weak.spin("rotor"), -3, 1e-12));
}

TEST_CASE("a body that rests on the only limit of its slider, at 0, does not move")
{
    for (const char* bounce : {"0", "0.5"})
    {
        Scene s(solver_is("RungeKutta4") + gravity() + body("bob", 1, {.004, .004, .004}, {0, 0, 0}) + manager() +
                    joint("rail", "Slider", "", "bob", "axis='0 0 1'") +
                    joint("stop", "Limit", "", "bob",
                          "along='slide' axis='0 0 1' lower='0' manager='manager' restitution='" + std::string(bounce) + "'"),
                dt(120));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        double lowest = 0, highest = 0;
        for (int i = 0; i < 120; ++i)
        {
            s.step();
            lowest = std::fmin(lowest, s.vec("bob", "position").z), highest = std::fmax(highest, s.vec("bob", "position").z);
        }
        CHECK(lowest > -1e-9);
        CHECK(highest < 1e-9);
    }
}

TEST_CASE("weak motors without a manager are refused, and the message says what would be accepted; limits get one")
{
    const Scene weak(held_shaft("rotor", 2) + "<component id='motor' type='Constraint/Motor' b='rotor' max_effort='4'/>");
    CHECK(weak.error().find("a finite max_effort needs a manager: manager='Manager/Automatic'") != std::string::npos);
    Scene loose(
        "<component id='rotor' type='State/Shaft' inertia='2' angular_velocity='3'/>"
        "<component id='low' type='Constraint/Limit' b='rotor' lower='-1'/>"
        "<component id='stop' type='Constraint/Limit' b='rotor' upper='1'/>");
    REQUIRE_MESSAGE(loose.loaded(), loose.error());
    loose.run(1);
    CHECK(loose.real("rotor", "angle") == doctest::Approx(1).epsilon(1e-9));
    CHECK(std::fabs(loose.real("rotor", "angular_velocity")) < 1e-9);
    const Scene wrong(held_shaft("rotor", 2) + "<component id='stop' type='Constraint/Limit' b='rotor' upper='4' manager='rotor'/>");
    CHECK(wrong.error().find("role manager needs a component of type Manager/") != std::string::npos);
}

TEST_CASE("a pendulum hits a wall: it rebounds with e times its speed, and its joint holds")
{
    // Released 0.5 rad from the vertical; it hits the wall at the vertical and returns to where 1 - cos is e^2 of its initial
    // value.
    constexpr double e = .6;
    for (const std::string type : {"Ball", "Hinge"})
    {
        CAPTURE(type);
        Scene s(solver_is("RungeKutta4") + gravity() + shape("ball", "Sphere", "radius='0.1'") +
                    ground("position='0.1 0 0' orientation='0.70710678118654752 0 -0.70710678118654752 0'") +
                    body("bob", 1, {.004, .004, .004}, {-std::sin(.5), 0, -std::cos(.5)}, "shape='ball'") +
                    joint("pivot", type, "", "bob", "anchor='0 0 0'" + std::string(type == "Hinge" ? " axis='0 1 0'" : "")) +
                    contacts("bob", "restitution='0.6' friction='0'"),
                dt(1000));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        double lowest_x = 0, drift = 0;
        const double period = 2 * std::numbers::pi * std::sqrt(1.004 / kG);
        while (s.simulation().time() < .74 * period)
        {
            s.step();
            drift = std::fmax(drift, s.real("pivot", "position_error"));
            if (s.simulation().time() > .27 * period) lowest_x = std::fmin(lowest_x, s.vec("bob", "position").x);
        }
        const double back = std::acos(1 - e * e * (1 - std::cos(.5)));
        MESSAGE(type, " back to ", lowest_x, " of ", -std::sin(back), ", drift ", drift);
        CHECK(std::fabs(lowest_x + std::sin(back)) < 2e-3);
        CHECK(drift < 1e-6);
    }
}

TEST_CASE("a chain comes to rest on the floor, which carries its weight")
{
    std::string parts = solver_is("RungeKutta4") + gravity() + shape("link", "Capsule", "radius='0.05' length='0.3'") + ground(), ids;
    for (int i = 0; i < 8; ++i)
    {
        const std::string id = "l" + std::to_string(10 + i);
        parts += body(id, 1, {.001, .0085, .0085}, {.4 * i, 0, .3 + .05 * i},
                      "shape='link' orientation='0.70710678118654752 0 0.70710678118654752 0'");
        if (i > 0)
            parts +=
                joint("j" + id, "Ball", "l" + std::to_string(9 + i), id, "anchor='" + text(Vec3{.4 * i - .2, 0, .275 + .05 * i}) + "'");
        ids += id + " ";
    }
    Scene s(parts + contacts(ids, "friction='0.5'"), dt(240));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(4);
    double apart = 0, height = 0;
    for (int i = 0; i < 8; ++i)
    {
        const std::string id = "l" + std::to_string(10 + i);
        height = std::fmax(height, std::fabs(s.vec(id, "position").z - .05));
        if (i > 0) apart = std::fmax(apart, s.real("j" + id, "position_error"));
    }
    MESSAGE("apart ", apart, ", off the floor ", height, ", kinetic ", s.simulation().totals().kinetic);
    CHECK(apart < 1e-6);
    CHECK(height < .03);
    CHECK(s.simulation().totals().kinetic < 1e-6);
}

TEST_CASE("a motor drives a pusher that pushes a box along the floor against friction")
{
    // The motor's force is the friction of the box: mu m g.
    Scene s(
        solver_is("RungeKutta4") + gravity() + shape("cube", "Box", "half_extents='0.1 0.1 0.1'") + ground() +
            body("box", 2, {.02, .02, .02}, {.25, 0, .1}, "shape='cube'") +
            body("pusher", 1, {.01, .01, .01}, {0, 0, .15}, "shape='cube'") + joint("rail", "Slider", "", "pusher", "axis='1 0 0'") +
            joint("motor", "Motor", "", "pusher", "along='slide' axis='1 0 0' speed='0.5'") + manager() +
            "<component id='response' type='Response/Rows' manager='manager' friction='0.4'/>" +
            "<component id='smooth' type='Response/Rows' manager='manager' friction='0'/>" +
            "<component id='floor' type='CDetection/ODE' between='box' against='ground' resolution='Resolution/None' "
            "response='response'/>" +
            "<component id='push' type='CDetection/ODE' between='box' against='pusher' resolution='Resolution/None' response='smooth'/>",
        dt(240));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(2);
    // At the instant at which it hits the box, a motor exerts no impulse: it compensates for that in the next step.
    CHECK(near(s.vec("pusher", "position").x, 1, 2e-3));
    CHECK(near(s.vec("pusher", "linear_velocity").x, .5, 1e-12));
    CHECK(std::fabs(s.vec("box", "linear_velocity").x - .5) < 1e-9);
    CHECK(std::fabs(s.vec("box", "position").x - s.vec("pusher", "position").x - .2) < 1e-3);
    CHECK(near(s.vec("motor", "force").x, .4 * 2 * kG, 1e-6));
    CHECK(s.real("rail", "position_error") < 1e-9);
}

// A step with an impact is advanced in pieces, and each of them needs the motor. Before, its manager held only whole steps.
TEST_CASE("a motor with a largest effort exerts it also in steps with impacts")
{
    for (const char* resolution : {"LocalRoot", "ConservativeAdvancement", "LocalBisection", "Bisection"})
    {
        CAPTURE(std::string(resolution));
        Scene s(solver_is("RungeKutta4") + gravity() + shape("round", "Sphere", "radius='0.2'") +
                    body("rotor", 1, {.02, .02, .02}, {0, 0, 0}, "shape='round'") +
                    body("ball", .1, {.002, .002, .002}, {0, 0, 1}, "shape='round'") + joint("rail", "Slider", "", "ball", "axis='0 0 1'") +
                    joint("pin", "Hinge", "", "rotor", "axis='0 0 1'") + manager() +
                    joint("motor", "Motor", "", "rotor", "axis='0 0 1' speed='1000' max_effort='0.1' manager='manager'") +
                    "<component id='c' type='CDetection/ODE' between='*' response='Response/Impulse' response.restitution='0.9' "
                    "resolution='Resolution/" +
                    resolution + "'/>",
                dt(100));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        s.run(2);
        CHECK(s.count("contact.impact") > 2);
        CHECK(near(s.vec("rotor", "angular_velocity").z, .1 * 2 / .02, 1e-12));
        const simulation::Totals totals = s.simulation().totals();
        CHECK(std::fabs(totals.kinetic - totals.work) < 1e-12);
    }
}
