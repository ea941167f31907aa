/// Linkages of the catalogue that several tests run: E2 and E3.
#pragma once

#include <array>
#include <cmath>

#include "support/joints.h"

namespace plab::test
{

/// A rod of 1 kg along an axis of the world: m l^2/12 across, little about itself.
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

/// E2: N four-bars side by side, upright, moving to +x at 1 m/s on top. Passes its singular configuration twice a turn.
inline std::string four_bars(int n)
{
    std::string parts = solver_is("RungeKutta4") + gravity();
    for (int i = 0; i <= n; ++i)
    {
        const Vec3 foot{double(i), 0, 0}, top{double(i), 0, 1};
        // Turns about y with w = 1 rad/s: the top moves at 1 m/s to +x.
        parts += rod("v" + number(i), foot, top, "linear_velocity='0.5 0 0' angular_velocity='0 1 0'");
        parts += hinge("f" + number(i), "", "v" + number(i), foot);
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

/// E3: five rods and the ground, six hinges; let go.
inline std::string bricard()
{
    const Vec3 at[6] = {{0, 0, 0}, {1, 0, 0}, {1, -1, 0}, {1, -1, 1}, {0, -1, 1}, {0, 0, 1}};
    // Each hinge is square to both rods that meet in it; the first and the last are on the ground, whose rod is the sixth.
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
