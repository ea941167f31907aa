// Mechanisms that stand on the ground, roll on it or slide over it: joints and contacts held together, with order 2. References: one or two
// equations of motion from the Lagrangian, by Runge-Kutta in small steps.
#include <array>
#include <cmath>
#include <numbers>

#include "order.h"
#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kWeight = 9.81;  // m/s^2

std::string ground_and_contacts(const std::string& between, double friction, const std::string& more)
{
    return "<component id='ground' type='State/Static' shape='Shape/Plane'/><component id='contact' type='CDetection/ODE' between='" +
           between + "' against='ground' response.friction='" + text(friction) + "' " + more + "/>" + gravity();
}
// Nothing named is the first; the last needs more sweeps than it makes by default.
const std::string kManaged[] = {"", "resolution='Resolution/None' response='Response/Rows' response.manager='Manager/Direct'",
                                "response='Response/Rows' response.manager='Manager/SequentialImpulse' "
                                "response.manager.max_iterations='1000' response.manager.tolerance='1e-9'"};

std::string turned_about_y(double angle) { return "orientation='axis 0 1 0 " + text(angle) + "' "; }

/// Two rods of 1 m that lean on one another, at an angle q from the ground; the joint is at the top.
struct StepLadder
{
    static constexpr double l = 1, r = 0.02, kMass = 1, kCross = kMass * l * l / 12, kStart = 1;
    double along = 1e-3;  ///< kg m^2, about the axis of a rod
    double spin = 0;      ///< rad/s, about the vertical

    std::string rod(const std::string& id, double side) const
    {
        const double x = side * l / 2 * std::cos(kStart);
        return body(id, kMass, {kCross, kCross, along}, {x, 0, r + l / 2 * std::sin(kStart)},
                    turned_about_y(-side * (std::numbers::pi / 2 - kStart)) + "linear_velocity='" + text(Vec3{0, spin * x, 0}) +
                        "' angular_velocity='" + text(Vec3{0, 0, spin}) + "' shape='Shape/Capsule' shape.length='1' shape.radius='" +
                        text(r) + "'");
    }
    std::string scene(const std::string& joint_type, const std::string& how) const
    {
        return rod("body", 1) + rod("other", -1) +
               joint("top", joint_type, "body", "other",
                     "anchor='" + text(Vec3{0, 0, r + l * std::sin(kStart)}) + "'" + (joint_type == "Hinge" ? " axis='0 1 0'" : "")) +
               "<component id='apart' type='Collision/Exclude' a='body' b='other'/>" + ground_and_contacts("body other", 0, how);
    }
    /// Of the middle of the rod: J q'' = -cos q (J sin q phi'^2 - A w phi' + m g l / 2), with the momentum about the vertical
    /// J cos^2 q phi' + A w sin q, which is constant, as the spin w about the axis of the rod is. J is about a foot, A about the axis.
    Vec3 at(double time) const
    {
        constexpr double J = kCross + kMass * l * l / 4;
        const double w = spin * std::sin(kStart), momentum = J * std::pow(std::cos(kStart), 2) * spin + along * w * std::sin(kStart);
        const auto turns = [&](double q) { return (momentum - along * w * std::sin(q)) / (J * std::pow(std::cos(q), 2)); };
        const auto y = integrate_all(std::array{kStart, 0.0, 0.0}, time,
                                     [&](const std::array<double, 3>& s)
                                     {
                                         const double q = s[0], turn = turns(q);
                                         const double torque = J * std::sin(q) * turn * turn - along * w * turn + kMass * kWeight * l / 2;
                                         return std::array{s[1], -std::cos(q) * torque / J, turn};
                                     });
        const double away = l / 2 * std::cos(y[0]);
        return {away * std::cos(y[2]), away * std::sin(y[2]), r + l / 2 * std::sin(y[0])};
    }
};

}  // namespace

TEST_CASE("a step ladder slides apart with order 2")
{
    const StepLadder ladder;
    for (const std::string& how : kManaged)
    {
        CAPTURE(how);
        check_order(
            "step ladder", ladder.scene("Hinge", how), 1.0 / 480, 0.3, [&](double time) { return ladder.at(time); }, 6e-6);
    }
}

TEST_CASE("a step ladder that turns about the vertical slides apart with order 2, slender as its rods may be")
{
    // A rod of 1 m and 2e-4 kg m^2 is 40 mm thick, one of 2e-5 kg m^2 13 mm: its angular velocity is the state, not its momentum.
    for (const double along : {1e-3, 2e-4, 2e-5})
    {
        StepLadder ladder;
        ladder.along = along, ladder.spin = 3;
        CAPTURE(along);
        check_order(
            "step ladder that turns", ladder.scene("Ball", kManaged[1]), 1.0 / 960, 0.3, [&](double time) { return ladder.at(time); },
            1e-5);
    }
}

TEST_CASE("a crank drives a rod over the floor with order 2")
{
    constexpr double l1 = 0.4, l2 = 0.9, r = 0.03, kMass = 1, kAxle = r + 0.85, kStart = 1.2;
    // Angles from below; the rod's foot is on the floor.
    const auto rod_angle = [](double q) { return -std::acos((kAxle - r - l1 * std::cos(q)) / l2); };
    const auto crank_at = [](double q) { return Vec3{l1 / 2 * std::sin(q), 0, kAxle - l1 / 2 * std::cos(q)}; };
    const auto rod_at = [&](double q)
    {
        const double b = rod_angle(q);
        return Vec3{l1 * std::sin(q) + l2 / 2 * std::sin(b), 0, kAxle - l1 * std::cos(q) - l2 / 2 * std::cos(b)};
    };
    // M(q) q'' = -M' q'^2 / 2 - V', with derivatives by differences.
    constexpr double kDifference = 1e-4;
    const auto slope = [](const auto& f, double q) { return (f(q + kDifference) - f(q - kDifference)) / (2 * kDifference); };
    const auto inertia = [&](double q)
    {
        const double turns = slope(rod_angle, q);
        return kMass *
               (l1 * l1 / 12 + l2 * l2 / 12 * turns * turns + length_squared(slope(crank_at, q)) + length_squared(slope(rod_at, q)));
    };
    const auto height = [&](double q) { return kMass * kWeight * (crank_at(q).z + rod_at(q).z); };
    const Path path = [&](double time)
    {
        return rod_at(integrate(kStart, 0, time,
                                [&](double q, double w) { return (-0.5 * slope(inertia, q) * w * w - slope(height, q)) / inertia(q); })[0]);
    };
    const auto bar = [&](const std::string& id, double length, double angle, const Vec3& at, const std::string& shape)
    {
        const double across = kMass * length * length / 12;
        return body(id, kMass, {across, across, 1e-3}, at, turned_about_y(std::numbers::pi - angle) + shape);
    };
    const Vec3 pin{l1 * std::sin(kStart), 0, kAxle - l1 * std::cos(kStart)};
    const std::string linkage =
        bar("crank", l1, kStart, crank_at(kStart), "") +
        bar("body", l2, rod_angle(kStart), rod_at(kStart), "shape='Shape/Capsule' shape.radius='0.03' shape.length='0.9'") +
        joint("axle", "Hinge", "", "crank", "anchor='" + text(Vec3{0, 0, kAxle}) + "' axis='0 1 0'") +
        joint("pin", "Hinge", "crank", "body", "anchor='" + text(pin) + "' axis='0 1 0'");
    for (const std::string& how : kManaged)
    {
        CAPTURE(how);
        check_order("crank", linkage + ground_and_contacts("body", 0, how), 1.0 / 480, 0.4, path, 4e-6);
    }
}

TEST_CASE("a pendulum on the axle of a wheel that rolls falls with order 2")
{
    constexpr double R = 0.1, M = 1, m = 2, l = 0.5, kWheel = 4e-3, kAbout = 0.05, kStart = 0.3, kEnd = 0.5;
    const Path path = [](double time)
    {
        // x: of the axle; q: of the pendulum, from above.
        const auto y = integrate_all(std::array{0.0, 0.0, kStart, 0.0}, time,
                                     [](const std::array<double, 4>& s)
                                     {
                                         const double q = s[2], w = s[3];
                                         const double A = M + m + kWheel / (R * R), B = m * l * std::cos(q), C = kAbout + m * l * l;
                                         const double a = m * l * w * w * std::sin(q), b = m * kWeight * l * std::sin(q), D = A * C - B * B;
                                         return std::array{s[1], (C * a - B * b) / D, w, (A * b - B * a) / D};
                                     });
        return Vec3{y[0] + l * std::sin(y[2]), 0, R + l * std::cos(y[2])};
    };
    for (const std::string& wheel :
         {std::string("shape='Shape/Sphere' shape.radius='0.1'"),
          std::string("orientation='axis 1 0 0 90 deg' shape='Shape/Cylinder' shape.radius='0.1' shape.height='0.1'")})
        for (const std::string& how : kManaged)
        {
            // On the points of a line, sweeps find their way to the joints too slowly.
            if (how == kManaged[2] && wheel.find("Cylinder") != std::string::npos) continue;
            CAPTURE(wheel);
            CAPTURE(how);
            const std::string cart = body("wheel", M, {kWheel, kWheel, kWheel}, {0, 0, R}, wheel) +
                                     body("body", m, {kAbout, kAbout, kAbout}, {l * std::sin(kStart), 0, R + l * std::cos(kStart)}) +
                                     joint("axle", "Hinge", "wheel", "body", "anchor='" + text(Vec3{0, 0, R}) + "' axis='0 1 0'");
            check_order("pendulum on a wheel", cart + ground_and_contacts("wheel", 5, how), 1.0 / 480, kEnd, path, 3e-5);
        }
}

TEST_CASE("a capsule that rolls round the ball joint at its end, as a cone does, spins fast about its own axis and keeps its speed")
{
    // Its angular velocity is along the line from the joint to the contact, both of which are at rest: 41 rad/s, of which 5 rad/s turn the
    // axis. With the inertia of the start it gained a tenth of its energy in a second at 1/240 s, or lost one at 1/480 s.
    constexpr double R = 0.03, l = 0.25, kJoint = 0.05, kTip = 1.2;  // m; m/s of the centre of the end that rolls
    const double drop = kJoint - R, x = std::sqrt(l * l - drop * drop), turning = kTip / x;
    const Vec3 middle{0.5 * x, 0, kJoint - 0.5 * drop}, to_contact = Vec3{x, 0, -kJoint} / std::hypot(x, kJoint);
    const Vec3 spin = to_contact * (kTip / (to_contact.z * x + to_contact.x * drop));
    const Path path = [&](double time) { return Vec3{middle.x * std::cos(turning * time), middle.x * std::sin(turning * time), middle.z}; };
    const std::string capsule =
        body("body", 1, {7e-3, 7e-3, 4.3e-4}, middle,
             turned_about_y(std::acos(-drop / l)) + "shape='Shape/Capsule' shape.radius='0.03' shape.length='0.25' linear_velocity='" +
                 text(cross(spin, middle - Vec3{0, 0, kJoint})) + "' angular_velocity='" + text(spin) + "'") +
        joint("joint", "Ball", "", "body", "anchor='" + text(Vec3{0, 0, kJoint}) + "'");
    for (const std::string& how : kManaged)
    {
        CAPTURE(how);
        check_order("a capsule that rolls round its end", capsule + ground_and_contacts("body", 1, how), 1.0 / 960, 1, path, 2e-5);
    }
}
