// Trees of joints that touch: two links of one tree, a link and its own base, two trees. Forces against statics, impacts against the
// conserved quantities; and what a joint's stop does, in the ledger.
#include <algorithm>

#include "support/gravity.h"
#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kRadius = 0.1;  // m, of the balls on the links

std::string ball_link(const std::string& id, const Vec3& at, const std::string& more = "")
{
    return body(id, 1, {.004, .004, .004}, at, "shape='ball' " + more);
}

/// Contacts of all bodies as an import writes them, but for those of neighbours.
std::string contacts(double restitution, const std::string& neighbours = "", const std::string& manager = "Automatic")
{
    return "<component id='ball' type='Shape/Sphere' radius='" + text(kRadius) + "'/>" + neighbours +
           "<component id='manager' type='Manager/" + manager +
           "'/><component id='response' type='Response/Automatic' manager='manager' restitution='" + text(restitution) +
           "'/><component id='contact' type='CDetection/ODE' between='*' resolution='Resolution/Speculative' response='response'/>";
}

std::string apart(const std::string& id, const std::string& a, const std::string& b)
{
    return "<component id='apart." + id + "' type='Collision/Exclude' a='" + a + "' b='" + b + "'/>";
}

std::string number(int i) { return std::to_string(10000 + i); }

/// n links of 0.3 m along -z, which turn about y; the first at `top`, held there by a hinge if `held`.
std::string chain(const std::string& name, int n, const Vec3& top, bool held, const std::string& motion = "")
{
    std::string out;
    for (int i = 0; i < n; ++i)
    {
        const std::string id = name + number(i), before = i == 0 ? "" : name + number(i - 1);
        out += ball_link(id, top + Vec3{0, 0, -0.3 * i - 0.15}, motion);
        if (i == 0 && !held) continue;
        out += joint("j" + id, "Hinge", before, id, "anchor='" + text(top + Vec3{0, 0, -0.3 * i}) + "' axis='0 1 0'");
        if (i > 0) out += apart(id, before, id);
    }
    return out;
}

double energy(const Scene& s)
{
    const simulation::Totals t = s.simulation().totals();
    return t.kinetic + t.stored;
}
double unexplained(const Scene& s)
{
    const simulation::Totals t = s.simulation().totals();
    return t.kinetic - s.simulation().kinetic_at_start() - t.work;
}
double work_of(const Scene& s, const std::string& id) { return s.simulation().stepper().work()[s.simulation().world().find(id)]; }

}  // namespace

TEST_CASE("pendulums side by side exchange their speeds in an elastic impact, on the world and on a base of their own tree")
{
    // On a base that slides freely: momentum and energy decide, and the pendulums are alike, so they exchange their speeds as well.
    for (const bool on_base : {false, true})
        for (const double e : {1.0, 0.5})
        {
            CAPTURE(on_base);
            CAPTURE(e);
            const std::string base = on_base ? "base" : "";
            const std::string base_parts =
                on_base ? body("base", 3, {.1, .1, .1}, {0, 0, 1}) + joint("rail", "Slider", "", "base", "axis='1 0 0' anchor='0 0 1'")
                        : "";
            // The centre of a ball is 1 m below its hinge; the first arrives from the left.
            Scene s(base_parts + ball_link("p", {-kRadius, 0, 0}, "linear_velocity='2 0 0' angular_velocity='0 -2 0'") +
                        ball_link("q", {kRadius, 0, 0}) +
                        joint("jp", "Hinge", base, "p", "anchor='" + text(Vec3{-kRadius, 0, 1}) + "' axis='0 1 0'") +
                        joint("jq", "Hinge", base, "q", "anchor='" + text(Vec3{kRadius, 0, 1}) + "' axis='0 1 0'") + contacts(e),
                    dt(1000));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            const double before = energy(s);
            s.step();
            CHECK(near(s.vec("p", "linear_velocity").x, 2 * (1 - e) / 2, 2e-3));
            CHECK(near(s.vec("q", "linear_velocity").x, 2 * (1 + e) / 2, 2e-3));
            if (on_base)
                CHECK(near(s.vec("p", "linear_velocity").x + s.vec("q", "linear_velocity").x + 3 * s.vec("base", "linear_velocity").x, 2,
                           1e-9));
            const double lost = before - energy(s);
            CHECK(near(lost, (1 - e * e) * 1.004, 4e-3));  // (1/2) (m/2) (1 - e^2) v^2, with J / L^2 for m
            CHECK(std::fabs(unexplained(s)) < 1e-9);
        }
}

TEST_CASE("two rods that lean on one another press with m g tan(angle) / 2, and their hinges carry the rest")
{
    const double angle = 0.3, h = std::cos(angle), d = std::sin(angle), m = 2;
    const auto rod = [&](const std::string& id, double side)
    {
        const double x = side * (d + kRadius);
        return body(id, m, {.2, .2, .01}, {x - side * d / 2, 0, h / 2}, "shape='end." + id + "'") + "<component id='end." + id +
               "' type='Shape/Sphere' radius='" + text(kRadius) + "' position='" + text(Vec3{-side * d / 2, 0, h / 2}) + "'/>" +
               joint("j" + id, "Hinge", "", id, "anchor='" + text(Vec3{x, 0, 0}) + "' axis='0 1 0'");
    };
    Scene s(gravity() + rod("l", -1) + rod("r", 1) + contacts(0), dt(500));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(2);
    const double push = m * kG * std::tan(angle) / 2;
    CHECK(near(s.vec("jl", "force").x, push, 1e-9));
    CHECK(near(s.vec("jr", "force").x, -push, 1e-9));
    CHECK(near(s.vec("jl", "force").z, m * kG, 1e-9));
    CHECK(s.simulation().totals().kinetic < 1e-20);
}

TEST_CASE("the forearm of a robot that rests on the robot's own base carries half of its weight there")
{
    // The upper arm lies level on its stop; the forearm hangs from its end and its ball, at the other end, lies on the block that is the
    // base: the contact carries m g / 2, the stop the moment of the rest.
    const double m = 1;
    Scene s(gravity() +
                "<component id='block' type='Shape/Box' half_extents='0.2 0.2 0.1'/><component id='base' type='State/Static' "
                "shape='block' position='0.5 0 0.3'/>" +
                body("upper", 2, {.01, .2, .2}, {.5, 0, 1}) + body("fore", m, {.05, .05, .05}, {.75, 0, .75}, "shape='tip'") +
                "<component id='tip' type='Shape/Sphere' radius='" + text(kRadius) + "' position='" + text(Vec3{-.25, 0, -.25}) + "'/>" +
                joint("shoulder", "Hinge", "base", "upper", "anchor='0 0 1' axis='0 1 0'") +
                joint("elbow", "Hinge", "upper", "fore", "anchor='1 0 1' axis='0 1 0'") + contacts(0, apart("0", "base", "upper")) +
                joint("stop", "Limit", "base", "upper", "anchor='0 0 1' axis='0 1 0' upper='0' manager='manager'"),
            dt(500));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const double before = energy(s);
    s.run(2);
    CHECK(near(s.vec("elbow", "force").z, m * kG / 2, 1e-8));
    CHECK(near(s.vec("shoulder", "force").z, 2 * kG + m * kG / 2, 1e-8));
    CHECK(near(s.vec("stop", "torque").y, -(2 * kG * 0.5 + m * kG / 2), 1e-8));
    CHECK(energy(s) <= before + 1e-9);
}

TEST_CASE("two chains that meet with all their links exchange their speeds: 1, 200 and 1000 links")
{
    for (const int n : {1, 200, 1000})
    {
        CAPTURE(n);
        Scene s(
            chain("a", n, {-kRadius - 0.003, 0, 0}, false, "linear_velocity='1 0 0'") + chain("b", n, {kRadius, 0, 0}, false) + contacts(1),
            dt(500));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.step(4);
        double worst = 0;
        for (int i = 0; i < n; ++i)
            worst = std::max(
                {worst, length(s.vec("a" + number(i), "linear_velocity")), distance(s.vec("b" + number(i), "linear_velocity"), {1, 0, 0})});
        CHECK(worst < 1e-9);
        CHECK(near(s.simulation().totals().kinetic, 0.5 * n, 1e-12));
        CHECK(distance(s.simulation().totals().momentum, {double(n), 0, 0}) < 1e-9 * n);
    }
}

TEST_CASE(
    "a heap of jointed bodies has more contact points than rows of joints, and is left to sweeps: Newton's method would take ten times as "
    "long")
{
    std::string parts = "<component id='floor' type='Shape/Plane'/><component id='ground' type='State/Static' shape='floor'/>";
    for (int c = 0; c < 24; ++c)
        for (int k = 0; k < 4; ++k)
        {
            const std::string id = "b" + number(10 * c + k), before = k == 0 ? "" : "b" + number(10 * c + k - 1);
            const Vec3 at{0.21 * k + 0.1 * (c % 3), 0.15 * (c / 3 % 3), 0.06 + 0.11 * (c / 9)};
            parts += body(id, 1, {.002, .004, .004}, at, "shape='brick'");
            if (k > 0)
                parts += joint("j" + id, "Ball", before, id, "anchor='" + text(at - Vec3{0.105, 0, 0}) + "'") + apart(id, before, id);
        }
    Scene s(gravity() + "<component id='brick' type='Shape/Box' half_extents='0.1 0.05 0.05'/>" + parts + contacts(0), dt(240));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = true;
    s.run(0.25);
    for (int i = 0; i < 60; ++i)
    {
        s.step();
        // A chain that lies apart from the heap is an island of its own, and small.
        CHECK(std::get<std::int64_t>(s.get("manager", "soft_islands")) >= 1);
        CHECK(std::get<std::int64_t>(s.get("manager", "direct_islands")) <= 2);
    }
}

TEST_CASE("chains that hang side by side and touch keep their length, and gain no energy: 10 and 200 links")
{
    for (const int n : {10, 200})
    {
        CAPTURE(n);
        Scene s(gravity() + chain("a", n, {-kRadius + 5e-5, 0, 0}, true) + chain("b", n, {kRadius - 5e-5, 0, 0}, true) + contacts(0),
                dt(500));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = true;
        const double before = energy(s);
        s.run(0.1);
        CHECK(std::get<std::string>(s.get("manager", "resolved")) == "Direct");
        // The contacts overlap by 1e-4 m at first, and are pushed apart.
        CHECK(distance(s.vec("a" + number(n - 1), "position"), {-kRadius, 0, -0.3 * (n - 1) - 0.15}) < 2e-3);
        CHECK(s.real("ja" + number(n / 2), "position_error") < 1e-5);
        CHECK(energy(s) < before + 1e-3 * n);
    }
}

TEST_CASE(
    "one end of a tree hits the other: a ring of links that closes keeps momentum and angular momentum, and no energy comes from nothing")
{
    // Six links in a row, free in space; its ends fold towards one another and meet.
    for (const double e : {0.0, 0.5, 1.0})
    {
        CAPTURE(e);
        std::string parts;
        for (int i = 0; i < 6; ++i)
        {
            const std::string id = "a" + number(i), before = "a" + number(i - 1);
            const double spin = 2.4 * (i - 2.5);
            parts +=
                ball_link(id, {0.3 * i, 0, 0},
                          "angular_velocity='0 " + text(spin) + " 0' linear_velocity='0 0 " + text(-0.36 * (i - 2.5) * (i - 2.5)) + "'");
            if (i > 0)
                parts += joint("j" + id, "Hinge", before, id, "anchor='" + text(Vec3{0.3 * i - 0.15, 0, 0}) + "' axis='0 1 0'") +
                         apart(id, before, id);
        }
        Scene s(parts + contacts(e), dt(1000));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = s.keep_events = true;
        s.step();
        const simulation::Totals first = s.simulation().totals();
        double most = first.kinetic;
        for (int i = 0; i < 1500; ++i) s.step(), most = std::max(most, s.simulation().totals().kinetic);
        const simulation::Totals last = s.simulation().totals();
        MESSAGE("e ", e, ": kinetic energy ", first.kinetic, " -> ", last.kinetic, ", at most ", most, "; contacts ",
                s.count("contact.begin"));
        CHECK(s.count("contact.begin") > 0);
        CHECK(distance(last.momentum, first.momentum) < 1e-9);
        CHECK(most < first.kinetic * (1 + 5e-3));
        CHECK(std::fabs(unexplained(s)) < 1e-9);
    }
}

namespace
{

/// A bar (2 kg, centre 0.5 m from the hinge) that turns about y at 3 rad/s and meets its stop at 0.70123 rad. `second`: another one hangs
/// on it, with stops at -0.5 and 0.3 rad; `damping`, N m s, of its joint.
std::string bar_at_stop(double e, bool second, double damping = 0)
{
    std::string out = body("bar", 2, {.1, .1, .1}, {.5, 0, 0}, "angular_velocity='0 3 0' linear_velocity='0 0 -1.5'") +
                      joint("j", "Hinge", "", "bar", "anchor='0 0 0' axis='0 1 0'") + "<component id='manager' type='Manager/Direct'/>" +
                      joint("stop", "Limit", "", "bar",
                            "anchor='0 0 0' axis='0 1 0' lower='-1' upper='0.70123' manager='manager' restitution='" + text(e) + "'");
    if (!second) return out;
    out += body("low", 1, {.03, .03, .03}, {1.3, 0, 0}, "angular_velocity='0 3 0' linear_velocity='0 0 -3.9'") +
           joint("j2", "Hinge", "bar", "low", "anchor='1 0 0' axis='0 1 0'") +
           joint("stop2", "Limit", "bar", "low",
                 "anchor='1 0 0' axis='0 1 0' lower='-0.5' upper='0.3' manager='manager' restitution='" + text(e) + "'");
    if (damping > 0) out += joint("d", "TorsionSpring", "bar", "low", "anchor='1 0 0' axis='0 1 0' damping='" + text(damping) + "'");
    return out;
}

}  // namespace

TEST_CASE("a stop takes (1 - e^2) of the energy with which a joint meets it, and the ledger says so")
{
    const double kinetic = 0.5 * (0.1 + 2 * 0.25) * 9;
    for (const double e : {0.0, 0.5, 1.0})
        for (const int steps : {250, 1000, 4000})
        {
            CAPTURE(e);
            CAPTURE(steps);
            Scene s(bar_at_stop(e, false), dt(steps));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.run(0.3);                       // it arrives at 0.2337 s
            const double most = 0.3 / steps;  // J: of first order in the step, from the step in which the stop is near
            CHECK(std::fabs(s.simulation().totals().kinetic - kinetic * e * e) < most);
            CHECK(s.simulation().totals().kinetic < kinetic * e * e + 1e-12);
            CHECK(std::fabs(work_of(s, "stop") + kinetic * (1 - e * e)) < most);
            CHECK(std::fabs(work_of(s, "manager")) < most);
            CHECK(std::fabs(unexplained(s)) < 1e-9);
            // Where it is after the rebound, to the first order in the step.
            const double hits = 0.70123 / 3;
            CHECK(std::fabs(s.real("stop", "position") - (0.70123 - 3 * e * (0.3 - hits))) < 3.0 * (1 + e) / steps);
        }
}

TEST_CASE("stops in a tree give no energy from nothing: an elastic one returns what it got")
{
    const double start = 0.5 * 0.6 * 9 + 0.5 * 3.9 * 3.9 + 0.5 * 0.03 * 9;
    std::vector<double> gains;
    for (const int steps : {250, 1000, 4000})
    {
        Scene s(bar_at_stop(1, true), dt(steps));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        double most = 0;
        for (int i = 0; i < steps; ++i) s.step(), most = std::max(most, s.simulation().totals().kinetic);
        MESSAGE(steps, " steps/s: from ", start, " J to ", s.simulation().totals().kinetic, ", at most ", most);
        gains.push_back(most - start);
        CHECK(std::fabs(unexplained(s)) < 1e-5);  // of the solver between the stops
    }
    for (const double gain : gains) CHECK(gain < 1e-6 * start);
}

TEST_CASE("the ledger closes where a damped joint meets its stop: the damper is booked with the force that it had")
{
    for (const double e : {0.0, 0.5})
    {
        Scene s(gravity() + bar_at_stop(e, true, 0.5), dt(500));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(1);
        CHECK(work_of(s, "d") < -0.1);
        CHECK(std::fabs(unexplained(s)) < 1e-5);  // of the solver between the stops
    }
}

TEST_CASE("the ledger closes where a joint with a rotor meets its stop: the energy of the rotor counts")
{
    for (const double e : {0.0, 0.5})
    {
        Scene s(bar_at_stop(e, false) + "<component id='rotor' type='State/Shaft' inertia='0.4' angular_velocity='3'/>" +
                    "<component id='gear' type='Constraint/Gear' driver='bar' driven='rotor' velocity_factor='1' driver_axis='0 1 0'/>",
                dt(500));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        CHECK(near(s.simulation().totals().kinetic, 0.5 * 1 * 9, 1e-12));  // bar 0.6, rotor 0.4 kg m^2
        s.run(0.3);
        CHECK(near(s.simulation().totals().kinetic, 0.5 * 9 * e * e, 5e-3));
        CHECK(near(work_of(s, "stop"), -0.5 * 9 * (1 - e * e), 5e-3));
        CHECK(std::fabs(unexplained(s)) < 1e-6);
    }
}
