/// Scenes of C23 (a rocking block) and C24 (a rimless wheel); rocking_test.cpp gives the theory.
#pragma once

#include <numbers>

#include "exact/motions.h"
#include "impacts.h"

namespace plab::test
{

inline constexpr double kAlpha = 0.2, kQuarter = .48608973195735393546;
/// Of its speed at an impact: J/m = 1/3 m^2 by a half-diagonal of 1 m.
inline const double kKept = exact::kept_by_rocking(1.0 / 3, std::sin(kAlpha), std::cos(kAlpha));

/// A block on two plates, so that each edge touches a body of its own and its impact can be located. The block is rotated about
/// the edge at the origin by `tilt` from its upright position and rotates towards it with `spin`. The plates extend `under` (m)
/// below the block. If that is large, the block also touches their ends, and the impact is not Housner's.
inline std::string block(double tilt, double spin, double under, const Algorithm& algorithm)
{
    const Vec3 arm{-std::sin(kAlpha - tilt), 0, std::cos(kAlpha - tilt)};
    const std::string attitude = " orientation=\"" + text(std::cos(tilt / 2)) + " 0 " + text(std::sin(tilt / 2)) + " 0\"";
    const std::string turning = " angular_velocity=\"0 " + text(-spin) + " 0\"";
    const double left = -2 * std::sin(kAlpha) + under - 1;
    return box("left", {1, 2, 0.5}, "position=\"" + text(Vec3{left, 0, -0.5}) + "\"", "Static") +
           box("right", {1, 2, 0.5}, "position=\"" + text(Vec3{1 - under, 0, -0.5}) + "\"", "Static") +
           box("block", {std::sin(kAlpha), 0.5, std::cos(kAlpha)}, at(arm, cross({0, -spin, 0}, arm)) + attitude + turning) +
           contact("block", algorithm, plastic(algorithm), 2,
                   "against=\"left right\" " + stiffness(algorithm, 1e5, 1e7, "response.steps_per_contact=\"20\""));
}

/// s: the reported time at which the block first hits the other plate.
inline double first_impact(const Algorithm& algorithm, double h)
{
    Scene s(block(0.1, 0, 0.1, algorithm) + gravity("block"), "dt=\"" + text(h) + "\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = s.keep_events = true;
    while (s.simulation().time() < 0.6) s.step();
    for (const Event& e : s.events)
        if (e.kind == "contact.begin" && e.time > 0.3) return e.time;
    return 0;
}

inline constexpr Vec3 kDownhill{0.783963147838, 0, -9.778624738829};  // 9.81 (sin .08, 0, -cos .08)

inline std::string wheel(const Algorithm& algorithm)
{
    const double alpha = std::numbers::pi / 8, spin = 1.2;
    std::string points;
    for (int i = 0; i < 8; ++i)
        for (const double y : {-0.3, 0.3}) points += text(Vec3{std::sin(alpha + 2 * alpha * i), y, std::cos(alpha + 2 * alpha * i)}) + " ";
    return std::string(kGround) + "<component id=\"wheel.shape\" type=\"Shape/ConvexHull\" points=\"" + points +
           "\"/><component id=\"wheel\" type=\"State/RigidBody\" shape=\"wheel.shape\" center_of_mass=\"0 0 0\" inertia=\"" +
           text(Vec3{1, 1e-3, 1}) + "\" angular_velocity=\"0 " + text(spin) + " 0\" " +
           at({0, 0, std::cos(alpha)}, {spin * std::cos(alpha), 0, spin * std::sin(alpha)}) + "/>" + gravity("wheel", kDownhill) +
           contact("wheel ground", algorithm, plastic(algorithm), 3, stiffness(algorithm, 1e5, 1e7, "response.steps_per_contact=\"20\""));
}

/// Angular velocity after each step of a rimless wheel.
inline std::vector<double> walk(const Algorithm& algorithm, double h, double until)
{
    Scene s(wheel(algorithm), "dt=\"" + text(h) + "\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = true;
    std::vector<double> out;
    // A step of the walk is recognised by a drop of the angular velocity; the impact may take two time steps.
    double before = 1.2, least = 1.2;
    bool falling = false;
    while (s.simulation().time() < until)
    {
        s.step();
        const double now = s.vec("wheel", "angular_velocity").y;
        if (now < before - 0.02)
            falling = true, least = now;
        else if (falling)
            falling = false, out.push_back(least);
        before = now;
    }
    return out;
}

}  // namespace plab::test
