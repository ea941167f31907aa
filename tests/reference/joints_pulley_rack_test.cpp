// Ropes over wheels, racks with their pinions and coupled joints, against closed forms.
//
//   Pulley   Atwood's machine: b falls with a = g (m_b - n m_a) / (m_b + n^2 m_a) by a tackle of n parts, T = m_a (g + n a)
//            swinging Atwood's machine (N. Tufillaro, T. Abbott, D. Griffiths, Am. J. Phys. 52, 1984), r and theta of the end that swings:
//            (M + m) r'' = m r theta'^2 - M g + m g cos theta,  r theta'' = -2 r' theta' - g sin theta
//   Coupler  two fingers of a gripper: a = F / (m_1 + f^2 m_2)
//   Rack     a = (F + T / r) / (m + I / r^2) for a force F on the rack and a torque T on the pinion
//
// | joint  | error, with the default solver at 1/240 s unless it is said                  |
// |--------|------------------------------------------------------------------------------|
// | Pulley | Atwood's machine 1e-12 m; also jerked taut; swinging, 2 s: 2e-11 m with RungeKutta4 at 1/2000 s  |
// | Rack   | 1e-11 m after 39 turns; on carriers that move freely, momentum to 1e-12        |
// | Coupler | fingers 1e-12 m; a joint that follows its parent's joint, momentum to 1e-12    |
#include <cmath>

#include "plab/rotation.h"
#include "support/gravity.h"
#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

const std::string kWheels = " wheel_a='-0.5 0 3' wheel_b='0.5 0 3'";

std::string rope(const std::string& more) { return "<component id='rope' type='Constraint/Pulley' a='a' b='b'" + kWheels + more + "/>"; }

std::string weights(double m_a, double m_b)
{
    return "<component id='g' type='Field/Gravity' between='*'/>" + body("a", m_a, {0.02, 0.03, 0.04}, {-0.5, 0, 1}) +
           body("b", m_b, {0.02, 0.03, 0.04}, {0.5, 0, 1});
}

simulation::Totals totals_of(const Scene& s) { return s.simulation().totals(); }

/// J, with the weight of a and b.
double energy_of(const Scene& s, double m_a, double m_b)
{
    return totals_of(s).kinetic + kG * (m_a * s.vec("a", "position").z + m_b * s.vec("b", "position").z);
}

/// r, r', theta, theta' of the swinging machine after `time`, by RungeKutta4 with very short steps.
std::array<double, 4> swing(std::array<double, 4> y, double heavy, double light, double time)
{
    const auto rate = [&](const std::array<double, 4>& s) -> std::array<double, 4>
    {
        const double pull = (light * s[0] * s[3] * s[3] - heavy * kG + light * kG * std::cos(s[2])) / (heavy + light);
        return {s[1], pull, s[3], (-2 * s[1] * s[3] - kG * std::sin(s[2])) / s[0]};
    };
    const auto moved = [](const std::array<double, 4>& s, const std::array<double, 4>& k, double h) {
        return std::array<double, 4>{s[0] + h * k[0], s[1] + h * k[1], s[2] + h * k[2], s[3] + h * k[3]};
    };
    const int steps = 100'000;
    const double h = time / steps;
    for (int i = 0; i < steps; ++i)
    {
        const auto k1 = rate(y), k2 = rate(moved(y, k1, h / 2)), k3 = rate(moved(y, k2, h / 2)), k4 = rate(moved(y, k3, h));
        for (std::size_t j = 0; j < 4; ++j) y[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
    }
    return y;
}

}  // namespace

TEST_CASE("Atwood's machine, and a tackle of two and of three parts")
{
    constexpr double kTime = 0.8;
    for (const double parts : {1.0, 2.0, 3.0})
    {
        CAPTURE(parts);
        Scene s(weights(1, 2.5) + rope(" ratio='" + text(parts) + "'"));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(kTime);
        // Of b, downwards.
        const double a = kG * (2.5 - parts) / (2.5 + parts * parts), down = 0.5 * a * kTime * kTime;
        CHECK(near(s.vec("b", "position").z, 1 - down, 1e-12));
        CHECK(near(s.vec("a", "position").z, 1 + parts * down, 1e-12));
        CHECK(near(s.real("rope", "tension"), kG + parts * a, 1e-11));
        CHECK(near(s.real("rope", "length_a"), 2 - parts * down, 1e-12));
        CHECK(std::fabs(s.real("rope", "position_error")) < 1e-13);
    }
}

TEST_CASE("a rope that is longer or shorter than it was placed is drawn to its length")
{
    Scene s(weights(1, 1) + rope(" length='3.9'"));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(0.5);
    CHECK(near(s.real("rope", "length_a") + s.real("rope", "length_b"), 3.9, 1e-12));
    CHECK(near(s.vec("a", "position").z, s.vec("b", "position").z, 1e-12));  // equal masses share it
    REQUIRE(s.ask(simulation::SetOperation{"rope", "length", Value(4.2)}).done);
    s.run(1);
    CHECK(near(s.real("rope", "length_a") + s.real("rope", "length_b"), 4.2, 1e-12));
}

TEST_CASE("a rope that can go slack pulls only, and is jerked taut")
{
    // With 0.3 m too much, both fall freely until g t^2 = 0.3 m. The jerk ends the sum of their speeds; then it is Atwood's machine.
    constexpr double kSlack = 0.3, m_a = 1, m_b = 2, kEnd = 0.5;
    const double taut = std::sqrt(kSlack / kG), v = kG * taut, jerk = 2 * v / (1 / m_a + 1 / m_b), a = kG * (m_b - m_a) / (m_a + m_b),
                 then = kEnd - taut;
    const double due = 1 - 0.5 * kG * taut * taut - (v - jerk / m_b) * then - 0.5 * a * then * then;
    for (const int rate : {60, 240, 960})
    {
        Scene s(weights(m_a, m_b) + rope(" length='4.3' slack='true' manager='Manager/Automatic'"), dt(rate));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(0.9 * taut);
        CHECK(s.real("rope", "tension") == 0);
        CHECK(s.real("rope", "position_error") == 0);
        CHECK(near(s.vec("a", "position").z, s.vec("b", "position").z, 1e-12));
        s.run(kEnd);
        const double error = std::fabs(s.vec("b", "position").z - due);
        MESSAGE("1/", rate, " s: ", error, " m");
        CHECK(near(s.real("rope", "tension"), m_a * (kG + a), 1e-6));
        CHECK(std::fabs(s.real("rope", "position_error")) < 1e-6);
        CHECK(error < 1e-12);
    }
    // Thrown up, a comes back into the rope, which has pushed nothing until then.
    Scene s(weights(m_b, m_b) + rope(" slack='true' manager='Manager/Automatic'"));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(0.1);
    CHECK(near(s.vec("a", "position").z, 1, 1e-9));
    REQUIRE(s.ask(simulation::SetOperation{"a", "linear_velocity", Value(Vec3{0, 0, 2})}).done);
    double least = 0;
    for (int i = 0; i < 90; ++i)
    {
        s.step();
        least = std::min(least, s.real("rope", "tension"));
        CHECK(s.real("rope", "length_a") + s.real("rope", "length_b") < 4 + 1e-6);
    }
    CHECK(least == 0);
}

TEST_CASE("a winch draws two bodies that spin together at its speed, and passes on no momentum")
{
    constexpr double kSpeed = 0.4;
    Scene s(body("a", 1, {0.02, 0.03, 0.04}, {0, 0, 0}, "linear_velocity='0.3 0.2 0' angular_velocity='1 2 0.5'") +
                body("b", 2.5, {0.02, 0.05, 0.04}, {2, 0.1, 0.4}, "angular_velocity='0 -1 1'") +
                "<component id='winch' type='Constraint/Motor' a='a' b='b' along='distance' anchor_a='0.1 0 0' anchor_b='-0.1 0.1 0' "
                "speed='-0.4'/>",
            "solver='Solver/RungeKutta4' " + dt(480));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const auto apart = [&]
    {
        const auto point = [&](const std::string& id, const Vec3& at)
        { return s.vec(id, "position") + rotate(s.quat(id, "orientation"), at); };
        return distance(point("a", {0.1, 0, 0}), point("b", {-0.1, 0.1, 0}));
    };
    const double start = apart();
    const Vec3 momentum = s.vec("a", "linear_velocity") + 2.5 * s.vec("b", "linear_velocity");
    s.run(3);
    CHECK(near(apart(), start - kSpeed * 3, 1e-8));
    CHECK(near(s.real("winch", "position"), apart(), 1e-14));
    CHECK(near(s.real("winch", "rate"), -kSpeed, 1e-12));
    CHECK(distance(s.vec("a", "linear_velocity") + 2.5 * s.vec("b", "linear_velocity"), momentum) < 1e-12);
}

TEST_CASE("a rope with slack is refused without a manager")
{
    Scene s(weights(1, 1) + rope(" slack='true'"));
    CHECK_FALSE(s.loaded());
    CHECK(s.error().find("a rope with slack needs a manager") != std::string::npos);
}

TEST_CASE("swinging Atwood's machine is of the order of its solver, and keeps its energy")
{
    const double heavy = 3, light = 1, start = 1.2;
    const auto due = swing({1, 0, start, 0}, heavy, light, 2);
    double last = 0;
    for (const int rate : {500, 1000, 2000})
    {
        // The light end is a body whose rope ends at its centre of mass.
        Scene s("<component id='g' type='Field/Gravity' between='*'/>" +
                    body("a", light, {0.01, 0.01, 0.01}, Vec3{-0.5 + std::sin(start), 0, 3 - std::cos(start)}) +
                    body("b", heavy, {0.02, 0.03, 0.04}, {0.5, 0, 1}) + rope(""),
                "solver='Solver/RungeKutta4' " + dt(rate));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        const double before = energy_of(s, light, heavy);
        s.run(2);
        const Vec3 at = s.vec("a", "position"), exact{-0.5 + due[0] * std::sin(due[2]), 0, 3 - due[0] * std::cos(due[2])};
        const double error = distance(at, exact);
        MESSAGE("1/", rate, " s: ", error, " m");
        if (rate == 2000)
        {
            CHECK(error < 4e-11);
            CHECK(last / error > 12);  // 2^4
        }
        CHECK(std::fabs(energy_of(s, light, heavy) - before) < 1e-6);
        CHECK(s.real("rope", "position_error") < 1e-12);
        last = error;
    }
}

TEST_CASE("a rope over the wheels of a crab that moves freely passes on no momentum")
{
    Scene s(body("a", 1, {0.02, 0.03, 0.04}, {-0.5, 0.1, 1}, "linear_velocity='0.3 0.2 0'") +
                body("b", 2, {0.02, 0.03, 0.04}, {0.6, 0, 1.4}) +
                body("crab", 5, {1, 2, 1.5}, {0, 0, 3}, "angular_velocity='0.1 0.3 0.2'") + rope(" carrier='crab' anchor_a='0.1 0 0.1'"),
            "solver='Solver/RungeKutta4' " + dt(1000));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step();  // the rope takes what it does not allow
    const auto before = totals_of(s);
    s.run(2);
    CHECK(distance(totals_of(s).momentum, before.momentum) < 1e-12);
    CHECK(distance(totals_of(s).angular_momentum, before.angular_momentum) < 1e-11);
    CHECK(near(totals_of(s).kinetic, before.kinetic, 1e-9));
    CHECK(s.real("rope", "position_error") < 1e-12);
}

namespace
{

std::string teeth(const std::string& more)
{
    return "<component id='teeth' type='Constraint/Rack' pinion='wheel' rack='bar' " + more + "/>";
}

std::string rack(const std::string& pinion, const std::string& more)
{
    return "<component id='bar' type='State/RigidBody' mass='2' inertia='0.1 0.1 0.1' position='0 0.1 0'/>" +
           joint("guide", "Slider", "", "bar", "axis='1 0 0'") + pinion + teeth(more) +
           "<component id='push' type='Field/Load' between='bar' force='3 0 0'/>";
}

}  // namespace

TEST_CASE("a rack and its pinion accelerate together, whether the pinion is a body or a shaft, over many turns")
{
    const double radius = 0.1, inertia = 0.03, a = 3 / (2 + inertia / (radius * radius));
    const std::string as_body = body("wheel", 1, {0.02, 0.02, inertia}, {0, 0, 0}) + joint("bearing", "Hinge", "", "wheel", "axis='0 0 1'"),
                      as_shaft = "<component id='wheel' type='State/Shaft' inertia='" + text(inertia) + "'/>";
    for (const std::string& pinion : {as_body, as_shaft})
    {
        Scene s(rack(pinion, "radius='0.1' rack_axis='-1 0 0' pinion_axis='0 0 1'"));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(9);
        CHECK(near(s.vec("bar", "position").x, 0.5 * a * 81, 1e-11));
        CHECK(near(s.real("teeth", "rack_position"), -0.5 * a * 81, 1e-11));
        CHECK(near(s.real("teeth", "pinion_position"), -0.5 * a * 81 / radius, 1e-9));
        CHECK(near(s.real("teeth", "rack_effort"), 3 - 2 * a, 1e-11));
        CHECK(near(s.real("teeth", "pinion_effort"), -radius * (3 - 2 * a), 1e-12));
        CHECK(std::fabs(s.real("teeth", "position_error")) < 1e-12);
    }
}

TEST_CASE("a pinion of another radius engages where the rack is")
{
    Scene s(rack("<component id='wheel' type='State/Shaft' inertia='0.03'/>", "radius='0.1' rack_axis='1 0 0'"));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1);
    const double x = s.vec("bar", "position").x, angle = s.real("wheel", "angle");
    REQUIRE(s.ask(simulation::SetOperation{"teeth", "radius", Value(0.2)}).done);
    CHECK(near(s.vec("bar", "position").x, x, 1e-15));
    s.run(2);
    CHECK(near(s.vec("bar", "position").x - x, 0.2 * (s.real("wheel", "angle") - angle), 1e-12));
}

TEST_CASE("a rack on a carrier that moves freely passes on no momentum and keeps the energy")
{
    Scene s(body("frame", 5, {1, 2, 1.5}, {0, 0, 0}, "angular_velocity='0.1 0.3 0.2'") +
                body("bar", 2, {0.1, 0.1, 0.1}, {0, 0.1, 0}, "linear_velocity='0.4 0 0'") +
                joint("guide", "Slider", "frame", "bar", "axis='1 0 0'") + body("wheel", 1, {0.02, 0.02, 0.03}, {0, 0, 0}) +
                joint("bearing", "Hinge", "frame", "wheel", "axis='0 0 1'") +
                teeth("carrier='frame' radius='0.1' rack_axis='-1 0 0' pinion_axis='0 0 1'"),
            "solver='Solver/RungeKutta4' " + dt(1000));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step();  // likewise
    const auto before = totals_of(s);
    s.run(3);
    CHECK(distance(totals_of(s).momentum, before.momentum) < 1e-12);
    CHECK(distance(totals_of(s).angular_momentum, before.angular_momentum) < 1e-11);
    CHECK(near(totals_of(s).kinetic, before.kinetic, 1e-9));
    CHECK(std::fabs(s.real("teeth", "position_error")) < 1e-12);
    CHECK(std::fabs(s.real("teeth", "rack_position") - 0.1 * s.real("teeth", "pinion_position")) < 1e-11);
}

TEST_CASE("the fingers of a gripper close together, at any ratio, and share the force")
{
    for (const double factor : {1.0, -1.0, 0.5})
    {
        CAPTURE(factor);
        Scene s(body("left", 0.4, {0.01, 0.01, 0.01}, {0, 0.1, 0}) + body("right", 0.6, {0.01, 0.01, 0.01}, {0, -0.1, 0}) +
                joint("slide_left", "Slider", "", "left", "axis='0 1 0'") + joint("slide_right", "Slider", "", "right", "axis='0 -1 0'") +
                "<component id='together' type='Constraint/Coupler' driver='left' driven='right' driver_along='slide' "
                "driven_along='slide' driver_axis='0 1 0' driven_axis='0 -1 0' factor='" +
                text(factor) + "'/><component id='push' type='Field/Load' between='left' force='0 -2 0'/>");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(1);
        const double a = -2 / (0.4 + factor * factor * 0.6);
        CHECK(near(s.vec("left", "position").y, 0.1 + 0.5 * a, 1e-12));
        CHECK(near(s.vec("right", "position").y, -0.1 - 0.5 * factor * a, 1e-12));
        CHECK(near(s.real("together", "driven_effort"), 0.6 * factor * a, 1e-12));
        CHECK(near(s.real("together", "driver_effort"), -0.6 * factor * factor * a, 1e-12));
    }
}

TEST_CASE("the last joint of a finger follows the one before it, and nothing comes from nothing")
{
    Scene s(body("hand", 2, {0.02, 0.03, 0.04}, {0, 0, 0}, "angular_velocity='0.3 0.2 -0.5'") +
                body("first", 0.3, {1e-3, 2e-3, 2e-3}, {0.1, 0, 0}, "angular_velocity='0 0 4'") +
                body("second", 0.2, {1e-3, 1e-3, 1e-3}, {0.2, 0, 0}) +
                joint("knuckle", "Hinge", "hand", "first", "anchor='0.05 0 0' axis='0 0 1'") +
                joint("tip", "Hinge", "first", "second", "anchor='0.15 0 0' axis='0 0 1'") +
                "<component id='follows' type='Constraint/Coupler' driver='first' driven='second' carrier='hand' in_chain='true' "
                "factor='0.7'/>",
            "solver='Solver/RungeKutta4' " + dt(2000));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step();  // the speeds become those that the joints allow
    const auto before = totals_of(s);
    s.run(3);
    CHECK(std::fabs(s.real("knuckle", "angle")) > 1);
    CHECK(near(s.real("tip", "angle"), 0.7 * s.real("knuckle", "angle"), 1e-11));
    CHECK(distance(totals_of(s).momentum, before.momentum) < 1e-12);
    CHECK(distance(totals_of(s).angular_momentum, before.angular_momentum) < 1e-12);
    CHECK(near(totals_of(s).kinetic, before.kinetic, 1e-8));
}

TEST_CASE("a coupler that is told to couple other motions engages where its bodies are")
{
    Scene s(body("arm", 1, {0.02, 0.02, 0.03}, {0, 0, 0}, "angular_velocity='0 0 2'") + body("hand", 1, {0.02, 0.02, 0.03}, {0.5, 0, 0}) +
            joint("shoulder", "Hinge", "", "arm", "axis='0 0 1'") +
            joint("wrist", "Hinge", "arm", "hand", "anchor='0.3 0 0' axis='0 0 1'") +
            "<component id='follows' type='Constraint/Coupler' driver='arm' driven='hand' in_chain='true' factor='0.5'/>");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1);
    CHECK(near(s.real("wrist", "angle"), 0.5 * s.real("shoulder", "angle"), 1e-11));
    const Vec3 at = s.vec("hand", "position");
    const double bent = s.real("wrist", "angle");
    // From now on the hand's turn in the world is half of the arm's, so the wrist bends back by half of what the shoulder turns.
    REQUIRE(s.ask(simulation::SetOperation{"follows", "in_chain", Value(false)}).done);
    CHECK(distance(s.vec("hand", "position"), at) < 1e-12);
    const double turned = s.real("shoulder", "angle");
    s.run(2.5);
    CHECK(std::fabs(s.real("shoulder", "angle") - turned) > 0.1);
    CHECK(near(s.real("wrist", "angle") - bent, -0.5 * (s.real("shoulder", "angle") - turned), 1e-10));
}

TEST_CASE("a body does not slide along a shaft, and a shaft does not slide")
{
    const std::string both = body("b", 1, {1, 1, 1}, {0, 0, 0}) + "<component id='s' type='State/Shaft' inertia='1'/>";
    const auto refused = [&](const std::string& more)
    { return Scene(both + "<component id='j' type='Constraint/Coupler' " + more + "/>").error(); };
    CHECK(refused("driver='s' driven='b' in_chain='true' driven_along='slide'").find("cannot slide along a shaft") != std::string::npos);
    CHECK(refused("driver='s' driven='b' driver_along='slide'").find("a shaft cannot slide") != std::string::npos);
    CHECK(refused("driver='s' driven='b' in_chain='true'").find("a body against a body") != std::string::npos);
}
