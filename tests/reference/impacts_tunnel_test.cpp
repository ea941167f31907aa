// No body tunnels through another: fast, spinning bodies of several shapes against a wall of 1 mm, with steps that are far too
// long.
//
// The reference does not use pLab's geometry. The points of a body (with half-width r around them) rotate at constant angular
// velocity, as its inertia is that of a ball; the first time at which the furthest of them reaches the wall is bracketed by
// sampling and found by bisection in long double. Shots whose closest approach is within 1e-7 m of the wall are excluded, as
// rounding decides them.
//
// | resolution                                   | bound                                                                                |
// |----------------------------------------------|--------------------------------------------------------------------------------------|
// | LocalRoot                                    | 0 missed, 0 invented, time 1e-11 s head-on, 1e-8 s where a corner rotates into it    |
// | ConservativeAdvancement                      | the same, except where it reports resolution.grazing (it stops after max_iterations) |
// | Bisection, LocalBisection, None, Speculative | what begins and ends within a step is not seen: no bound                             |
#include <algorithm>
#include <array>
#include <numbers>

#include "impacts.h"
#include "plab/random.h"

using namespace plab;
using namespace plab::test;

namespace
{
constexpr double kStep = 1.0 / 30, kThick = 5e-4;

struct Solid
{
    const char* name;
    const char* shape;         ///< the component's type and parameters
    std::vector<Vec3> points;  ///< m, in B
    double radius = 0;         ///< m, around them
};

std::vector<Vec3> corners(double x, double y, double z)
{
    std::vector<Vec3> out;
    for (int i = 0; i < 8; ++i) out.push_back({i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z});
    return out;
}
std::vector<Solid> solids()
{
    return {{"box", "Shape/Box\" half_extents=\"0.2 0.05 0.1", corners(0.2, 0.05, 0.1), 0},
            {"capsule", "Shape/Capsule\" radius=\"0.03\" length=\"0.4", {{0, 0, 0.2}, {0, 0, -0.2}}, 0.03},
            {"hull",
             "Shape/ConvexHull\" points=\"0.3 0 0  -0.1 0.1 0  -0.1 -0.1 0.05  0 0 -0.2  0 0.05 0.15",
             {{0.3, 0, 0}, {-0.1, 0.1, 0}, {-0.1, -0.1, 0.05}, {0, 0, -0.2}, {0, 0.05, 0.15}},
             0}};
}

struct Shot
{
    Vec3 p, v, w;
    Quat q;
};

/// Rodrigues' formula, in long double.
std::array<long double, 3> turned(const Vec3& r, const Vec3& w, long double t)
{
    const long double rate = std::sqrt(static_cast<long double>(dot(w, w)));
    if (rate == 0) return {r.x, r.y, r.z};
    const long double k[3] = {w.x / rate, w.y / rate, w.z / rate}, x[3] = {r.x, r.y, r.z};
    const long double c = std::cos(rate * t), s = std::sin(rate * t), d = k[0] * x[0] + k[1] * x[1] + k[2] * x[2];
    const long double across[3] = {k[1] * x[2] - k[2] * x[1], k[2] * x[0] - k[0] * x[2], k[0] * x[1] - k[1] * x[0]};
    std::array<long double, 3> out;
    for (std::size_t i = 0; i < 3; ++i) out[i] = x[i] * c + across[i] * s + k[i] * d * (1 - c);
    return out;
}
/// m: distance from the wall of the body's furthest point along x, at t.
long double gap(const Solid& solid, const Shot& shot, long double t)
{
    long double furthest = -1e9L;
    for (const Vec3& point : solid.points) furthest = std::max(furthest, turned(rotate(shot.q, point), shot.w, t)[0]);
    return -static_cast<long double>(kThick) - (shot.p.x + shot.v.x * t + furthest + solid.radius);
}

struct Truth
{
    bool hits = false, unsure = false;
    double time = 0;
};
/// Samples more densely than anything rotates; minima are refined by ternary search.
Truth truth(const Solid& solid, const Shot& shot)
{
    const int n = 64 + static_cast<int>(60 * length(shot.w) * kStep);
    const auto time = [&](int i) { return static_cast<long double>(kStep) * i / n; };
    Truth out;
    long double before = gap(solid, shot, 0), now = gap(solid, shot, time(1));
    for (int i = 1; i <= n; ++i)
    {
        const long double after = i < n ? gap(solid, shot, time(i + 1)) : now + 1;
        long double at = time(i), least = now;
        if (now > 0 && now <= before && now <= after)
        {
            long double lo = time(i - 1), hi = std::min(time(i + 1), static_cast<long double>(kStep));
            for (int k = 0; k < 80; ++k)
            {
                const long double a = lo + (hi - lo) / 3, b = hi - (hi - lo) / 3;
                (gap(solid, shot, a) < gap(solid, shot, b) ? hi : lo) = gap(solid, shot, a) < gap(solid, shot, b) ? b : a;
            }
            at = lo, least = gap(solid, shot, lo);
        }
        out.unsure = out.unsure || std::fabs(least) < 1e-7L;
        if (least <= 0)
        {
            long double lo = time(i - 1), hi = at;
            for (int k = 0; k < 80; ++k) (gap(solid, shot, 0.5L * (lo + hi)) > 0 ? lo : hi) = 0.5L * (lo + hi);
            out.hits = true, out.time = static_cast<double>(lo);
            return out;
        }
        before = now, now = after;
    }
    return out;
}

std::string scene(const Solid& solid, const std::string& resolution, bool responds)
{
    const std::string wall = box("wall", {kThick, 100, 100}, "position=\"0 0 0\"", "Static");
    const std::string body =
        "<component id=\"body.shape\" type=\"" + std::string(solid.shape) +
        "\"/><component id=\"body\" type=\"State/RigidBody\" shape=\"body.shape\" mass=\"1\" center_of_mass=\"0 0 0\" "
        "inertia=\"0.01 0.01 0.01\" position=\"-5 0 0\" solver=\"exact\"/><component id=\"exact\" type=\"Solver/Exact\"/>";
    return wall + body + (responds ? contact("body wall", resolution, "1") : sensor("body wall", resolution));
}

struct Count
{
    int hits = 0, missed = 0, made_up = 0, gave_up = 0, shots = 0;
    double late = 0;  ///< s
};

Count fire(const Solid& solid, const std::string& resolution, int shots, bool passes, std::uint64_t seed)
{
    const auto uniform = [&](double low, double high) { return low + (high - low) * next_uniform(seed); };
    const auto vector = [&](double size)
    {
        const double x = uniform(-size, size), y = uniform(-size, size), z = uniform(-size, size);
        return Vec3{x, y, z};
    };
    Scene s(scene(solid, resolution, false), "dt=\"1/30\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = resolution == "ConservativeAdvancement", s.keep_events = true;
    Count out;
    while (out.shots < shots)
    {
        Shot shot;
        shot.w = vector(passes ? 300 : 100), shot.q = normalized(Quat{uniform(0.1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)});
        // Through the wall; or along it, where only a rotating corner may touch.
        if (passes)
            shot.p = {uniform(-2, -0.5), uniform(-5, 5), uniform(-5, 5)},
            shot.v = {uniform(70, 1000), uniform(-300, 300), uniform(-300, 300)};
        else
            shot.p = {uniform(-0.35, -0.2), uniform(-5, 5), uniform(-5, 5)}, shot.v = {uniform(-1, 1), uniform(-20, 20), uniform(-20, 20)};
        const Truth t = truth(solid, shot);
        if (t.unsure || gap(solid, shot, 0) < 1e-6L) continue;
        ++out.shots;
        const double began = s.simulation().time();
        s.ask_all({simulation::SetOperation{"body", "position", shot.p}, simulation::SetOperation{"body", "orientation", shot.q},
                   simulation::SetOperation{"body", "linear_velocity", shot.v},
                   simulation::SetOperation{"body", "angular_velocity", shot.w}});
        s.events.clear();
        s.step();
        const auto begins = events_of(s, "contact.begin");
        const bool unsure = s.count("resolution.grazing") > 0;
        out.gave_up += unsure, out.hits += t.hits;
        out.missed += t.hits && begins.empty() && !unsure, out.made_up += !t.hits && !begins.empty() && !unsure;
        if (t.hits && !begins.empty() && !unsure) out.late = std::max(out.late, std::fabs(begins[0].time - began - t.time));
        // The pair ends before the next shot.
        s.ask_all({simulation::SetOperation{"body", "position", Vec3{-50, 0, 0}},
                   simulation::SetOperation{"body", "linear_velocity", Vec3{}},
                   simulation::SetOperation{"body", "angular_velocity", Vec3{}}});
        s.step();
    }
    return out;
}
}  // namespace

TEST_CASE("random shots of spinning boxes, capsules and hulls at a thin wall: no hit missed, none invented, each at its time")
{
    for (const Solid& solid : solids())
        for (const char* resolution : {"LocalRoot", "ConservativeAdvancement"})
            for (const bool passes : {true, false})
            {
                CAPTURE(std::string(solid.name));
                CAPTURE(std::string(resolution));
                CAPTURE(passes);
                const bool root = resolution == std::string("LocalRoot");
                const Count c = fire(solid, resolution, root ? 300 : 60, passes, passes ? 17 : 23);
                CHECK(c.missed == 0);
                CHECK(c.made_up == 0);
                CHECK((passes ? c.hits == c.shots : (c.hits > c.shots / 50 && c.hits < c.shots)));
                CHECK(c.late < (passes ? 1e-11 : 1e-8));
                if (root) CHECK(c.gave_up == 0);
                CHECK(c.gave_up <= c.shots / 2);
                MESSAGE(std::string(solid.name), " ", std::string(resolution), std::string(passes ? " through: " : " along: "), c.hits,
                        " hits of ", c.shots, ", gave up ", c.gave_up, ", late ", c.late);
            }
}

TEST_CASE("with a response no body passes through")
{
    std::uint64_t seed = 5;
    const auto uniform = [&](double low, double high) { return low + (high - low) * next_uniform(seed); };
    for (const Solid& solid : solids())
    {
        CAPTURE(std::string(solid.name));
        Scene s(scene(solid, "LocalRoot", true), "dt=\"1/30\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        for (int shot = 0; shot < 100; ++shot)
        {
            s.ask_all(
                {simulation::SetOperation{"body", "position", Vec3{uniform(-2, -0.5), 0, 0}},
                 simulation::SetOperation{"body", "linear_velocity", Vec3{uniform(70, 1000), uniform(-300, 300), uniform(-300, 300)}},
                 simulation::SetOperation{"body", "angular_velocity", Vec3{uniform(-300, 300), uniform(-300, 300), uniform(-300, 300)}}});
            const auto& host = s.simulation().world().host();
            const std::uint32_t b = s.simulation().world().component(s.simulation().world().find("body")).host_index;
            const double before = host.bodies.kinetic_energy(b);
            s.step();
            CHECK(s.vec("body", "position").x < 0);
            CHECK(std::fabs(host.bodies.kinetic_energy(b) / before - 1) < 1e-12);
        }
    }
}
