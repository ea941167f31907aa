/// Pendulums, chains and tops of the catalogue that several tests run: A4, A9, E1, E5, E6. Each scene begins with the solver's
/// element.
#pragma once

#include <array>

#include "support/joints.h"

namespace plab::test
{

/// E1: a pendulum of 1 m, released horizontally. The same motion is produced by a point on a rod, and by bodies with (I + m
/// l^2)/(m l) = 1 m on a ball joint and on a hinge.
inline std::string pendulum(const std::string& solver, const std::string& joint)
{
    const std::string before = solver + gravity(), axis = joint == "Hinge" ? " axis='0 1 0'" : "";
    if (joint == "Distance") return before + body("bob", "1", "1 1 1", "1 0 0") + "<component id='j' type='Constraint/Distance' b='bob'/>";
    return before + body("bob", "3", "0.75 0.75 0.75", "0.5 0 0") + "<component id='j' type='Constraint/" + joint +
           "' b='bob' anchor='0 0 0'" + axis + "/>";
}
/// Position at t = 10, on the side of +x.
inline constexpr Vec3 kPendulumAt10{.275087462576116860, 0, -.961419205099125064};
inline double angle_error(const Vec3& along, const Vec3& expected) { return length(cross(along, expected)) / length(along); }

/// A9: two points of 1 kg on rods of 1 m, released horizontally.
inline std::string double_pendulum(const std::string& solver)
{
    return solver + gravity() + body("p", "1", "1 1 1", "1 0 0") + body("q", "1", "1 1 1", "2 0 0") + joint("j1", "Distance", "", "p", "") +
           joint("j2", "Distance", "p", "q", "");
}
/// Angles of the rods from the vertical, rad.
inline std::array<double, 2> double_pendulum_angles(const Scene& s)
{
    const Vec3 p = s.vec("p", "position"), q = s.vec("q", "position") - p;
    return {std::atan2(p.x, -p.z), std::atan2(q.x, -q.z)};
}
inline constexpr std::array<double, 2> kDoublePendulumAt1{-.62508769980630629954, -1.0345850856800123406},
    kDoublePendulumAt5{-.62718670506653073014, -1.3013155502098116779};

/// A4: Lagrange's top. Inertia about the pivot .0045, .0045, .0008; the centre of mass is .05 m along the axis, which is tilted
/// by .5 rad.
inline std::string top(const std::string& solver)
{
    constexpr double half = 0.25;
    const std::string tilt = text(std::cos(half)) + " " + text(std::sin(half)) + " 0 0";
    const Vec3 up{0, -std::sin(2 * half), std::cos(2 * half)};
    return solver + gravity() +
           body("top", 1, {.0045 - .0025, .0045 - .0025, .0008}, .05 * up,
                "orientation='" + tilt + "' angular_velocity='" + text(200 * up) + "'") +
           joint("j", "Ball", "", "top", "anchor='0 0 0'");
}
inline Vec3 top_axis(const Scene& s) { return rotate(s.quat("top", "orientation"), Vec3{0, 0, 1}); }
inline constexpr Vec3 kTopAtTenth{.17859775484183078, -.54105459446217256, .82180458004128409},
    kTopAt1{-.14403481426920192, .50007981101234838, .85391694847701110};

/// E5: points of 1 kg on rods of 0.1 m, with a ball of one tonne at the end. `type` and `more` describe the joints.
inline std::string chain_id(int i) { return "p" + std::to_string(1000 + i); }
inline std::string heavy_chain(const std::string& solver, int links, const std::string& type = "Distance", const std::string& more = "")
{
    std::string parts = solver + gravity();
    for (int i = 0; i <= links; ++i)
    {
        parts += body(chain_id(i), i == links ? 1000 : 1, {1, 1, 1}, {0, 0, -.1 * (i + 1)});
        parts += joint("j" + chain_id(i), type, i == 0 ? "" : chain_id(i - 1), chain_id(i), more);
    }
    return parts;
}

/// E6: ten points 0.1 m apart, started in the mode of w rad/s with 1e-5 m at the free end: frequencies shift with the square of
/// the amplitude.
inline constexpr int kModeLinks = 10;
inline constexpr double kModeAmplitude = 1e-5;
inline constexpr std::array<double, 3> kModes{3.67662065761785, 8.45928432589076, 13.3191005199572};  ///< zeros of Laguerre's polynomial
inline std::string mode_id(int from_the_end) { return "p" + std::to_string(20 - from_the_end); }
/// Lateral positions divided by the amplitude, from the free end up: g/a ((k+1)(x_k - x_{k+1}) - k (x_{k-1} - x_k)) = w^2 x_k.
inline std::array<double, kModeLinks + 1> mode_shape(double w)
{
    std::array<double, kModeLinks + 1> x{1};
    for (int k = 0; k < kModeLinks; ++k)
    {
        const auto at = [&](int i) -> double& { return x[static_cast<std::size_t>(i)]; };
        at(k + 1) = at(k) - (w * w * .1 / 9.81 * at(k) + (k == 0 ? 0 : k * (at(k - 1) - at(k)))) / (k + 1);
    }
    return x;
}
inline std::string mode_chain(const std::string& solver, double w)
{
    const auto x = mode_shape(w);
    std::string parts = solver + gravity();
    double above = 0, z = 0;
    for (int k = kModeLinks - 1; k >= 0; --k)
    {
        const double here = kModeAmplitude * x[static_cast<std::size_t>(k)], across = here - above;
        z -= std::sqrt(.01 - across * across);
        parts += body(mode_id(k), 1, {1, 1, 1}, {here, 0, z}) +
                 joint("j" + mode_id(k), "Distance", k == kModeLinks - 1 ? "" : mode_id(k + 1), mode_id(k), "");
        above = here;
    }
    return parts;
}

}  // namespace plab::test
