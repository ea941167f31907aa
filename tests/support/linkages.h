/// Linkages of the catalogue used by several tests: E2, E3, E4 and E8.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "support/joints.h"

namespace plab::test
{

/// A rod of 1 kg along an axis of the world: inertia m l^2/12 about the transverse axes, little about its own axis.
inline std::string rod(const std::string& id, const Vec3& from, const Vec3& to, const std::string& more = "")
{
    const Vec3 along = to - from;
    const double across = dot(along, along) / 12;
    const auto moment = [&](double part) { return part != 0 ? 1e-3 : across; };
    return body(id, 1, {moment(along.x), moment(along.y), moment(along.z)}, 0.5 * (from + to), more);
}
inline std::string hinge(const std::string& id, const std::string& a, const std::string& b, const Vec3& at,
                         const std::string& axis = "0 1 0")
{
    return joint(id, "Hinge", a, b, "anchor='" + text(at) + "' axis='" + axis + "'");
}
inline std::string number(int i) { return std::to_string(100 + i); }

/// E2: N four-bar linkages side by side, upright, whose tops move towards +x at 1 m/s. It passes its singular configuration
/// twice per turn.
inline std::string four_bars(int n, const std::string& solver = solver_is("RungeKutta4"))
{
    std::string parts = solver + gravity();
    for (int i = 0; i <= n; ++i)
    {
        const Vec3 base{double(i), 0, 0}, top{double(i), 0, 1};
        // Rotates about y with w = 1 rad/s: the top moves at 1 m/s towards +x.
        parts += rod("v" + number(i), base, top, "linear_velocity='0.5 0 0' angular_velocity='0 1 0'");
        parts += hinge("f" + number(i), "", "v" + number(i), base);
    }
    for (int i = 0; i < n; ++i)
    {
        const Vec3 left{double(i), 0, 1}, right{double(i + 1), 0, 1};
        parts += rod("h" + number(i), left, right, "linear_velocity='1 0 0'");
        parts += hinge("l" + number(i), "v" + number(i), "h" + number(i), left);
        parts += hinge("r" + number(i), "v" + number(i + 1), "h" + number(i), right);
    }
    return parts;
}
inline Vec3 top_of(const Scene& s) { return 2 * s.vec("v" + number(0), "position"); }

/// E4: crank .2, coupler .5, rocker .4, ground .5; a motor turns the crank at 1 rev/s.
struct FourBar
{
    static constexpr double crank = .2, coupler = .5, rocker = .4, ground = .5;

    /// The end of the rocker: the intersection, above the ground, of the coupler's circle about the crank's end with the
    /// rocker's circle about its base.
    static Vec3 rocker_end(double angle)
    {
        const double x = crank * std::cos(angle), z = crank * std::sin(angle), dx = ground - x, dz = -z, r2 = dx * dx + dz * dz,
                     r = std::sqrt(r2);
        const double along = (coupler * coupler - rocker * rocker + r2) / (2 * r), up = std::sqrt(coupler * coupler - along * along);
        return Vec3{x + along * dx / r - up * dz / r, 0, z + along * dz / r + up * dx / r};
    }
    static std::string scene(const std::string& solver)
    {
        const Vec3 knee{crank, 0, 0}, base{ground, 0, 0}, end = rocker_end(0);
        const auto link = [](const std::string& id, const Vec3& from, const Vec3& to) {
            return body(id, 1, {.01, .01, .01}, 0.5 * (from + to));
        };
        return solver + gravity() + link("crank", {0, 0, 0}, knee) + link("coupler", knee, end) + link("rocker", base, end) +
               hinge("j1", "", "crank", {0, 0, 0}, "0 -1 0") + hinge("j2", "crank", "coupler", knee) +
               hinge("j3", "coupler", "rocker", end) + hinge("j4", "", "rocker", base) +
               joint("m", "Motor", "", "crank", "axis='0 -1 0' speed='" + text(2 * std::numbers::pi) + "'");
    }
    /// m, position of the rocker's end; the rocker's centre is half way up to it.
    static double error(const Scene& s)
    {
        const double angle = 2 * std::numbers::pi * s.simulation().time();
        return length(2 * s.vec("rocker", "position") - Vec3{ground, 0, 0} - rocker_end(angle));
    }
};

/// E8: a body with arms of 0.9 m between pins 2 m apart.
inline std::string torn_rod(const std::string& solver)
{
    return solver + gravity() + body("rod", 1, {.1, .3, .3}, {0, 0, 0}) +
           joint("left", "Ball", "", "rod", "anchor_a='-1 0 0' anchor_b='-0.9 0 0'") +
           joint("right", "Ball", "", "rod", "anchor_a='1 0 0' anchor_b='0.9 0 0'");
}

/// E3: five rods and the ground, six hinges; released from rest.
inline std::string bricard()
{
    const Vec3 at[6] = {{0, 0, 0}, {1, 0, 0}, {1, -1, 0}, {1, -1, 1}, {0, -1, 1}, {0, 0, 1}};
    // Each hinge axis is perpendicular to both rods that it connects; the first and the last hinge are on the ground, which
    // counts as the sixth rod.
    const char* axis[6] = {"0 1 0", "0 0 1", "1 0 0", "0 1 0", "0 0 1", "1 0 0"};
    std::string parts = solver_is("RungeKutta4") + gravity("0 -9.81 0");
    for (int i = 0; i < 5; ++i)
    {
        const Vec3 along = at[i + 1] - at[i];
        const auto moment = [](double part) { return part != 0 ? .01 / 6 : (1 + .01) / 12; };
        parts += body("rod" + number(i), 1, {moment(along.x), moment(along.y), moment(along.z)}, 0.5 * (at[i] + at[i + 1]));
        parts += hinge("j" + number(i), i == 0 ? "" : "rod" + number(i - 1), "rod" + number(i), at[i], axis[i]);
    }
    return parts + hinge("j" + number(5), "", "rod" + number(4), at[5], axis[5]);
}

struct BricardRun
{
    double kinetic = 0, drift = 0, error = 0;  ///< J, J, m
    std::int64_t redundant = 0;
};
inline BricardRun run_bricard(int per_second, double seconds)
{
    Scene s(bricard(), dt(per_second));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const auto energies = [&]
    {
        const Bodies& bodies = s.simulation().world().host().bodies;
        std::array<double, 2> sum{};  // kinetic, potential
        for (std::uint32_t i = 0; i < bodies.size(); ++i)
            sum[0] += bodies.kinetic_energy(i), sum[1] += bodies.mass[i] * 9.81 * bodies.position[i].y;
        return sum;
    };
    const double start = energies()[1];
    BricardRun run;
    for (long i = std::lround(seconds * per_second); i > 0; --i)
    {
        s.step();
        const auto now = energies();
        run.kinetic = std::fmax(run.kinetic, now[0]);
        run.drift = std::fmax(run.drift, std::fabs(now[0] + now[1] - start));
        run.error = std::fmax(run.error, s.real("j" + number(5), "position_error"));
    }
    for (int i = 0; i < 6; ++i) run.redundant += std::get<std::int64_t>(s.get("j" + number(i), "redundant"));
    return run;
}

}  // namespace plab::test
