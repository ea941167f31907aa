// Signed distance of every pair of solids, checked without another implementation: points of the solids bound a gap from above, planes
// perpendicular to the normal from below; a depth is stationary, and it is smallest among many directions.
#include <doctest/doctest.h>

#include <array>

#include "bodies.h"
#include "detection/point_columns.h"
#include "detection/separation.h"

using namespace plab;
using namespace plab::detection;
using namespace plab::test;

namespace
{
using Real = long double;
struct Wide
{
    Real x, y, z;
};
Wide wide(const Vec3& v) { return {v.x, v.y, v.z}; }
Wide operator+(const Wide& a, const Wide& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Wide operator-(const Wide& a, const Wide& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Wide operator*(const Wide& a, Real s) { return {a.x * s, a.y * s, a.z * s}; }
Real dot(const Wide& a, const Wide& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Real length(const Wide& a) { return sqrtl(dot(a, a)); }
Wide cross(const Wide& a, const Wide& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Wide rotate(const Quat& q, const Wide& v)
{
    const Wide u{q.x, q.y, q.z}, t = cross(u, v) * 2;
    return v + t * q.w + cross(u, t);
}

/// max n . p over the solid.
Real reach(const Collider& c, const Pose& X, const Wide& n)
{
    const Wide d = rotate(conjugate(X.q), n);
    const Vec3& s = c.size();
    const Real base = dot(n, wide(X.p));
    Real most = -HUGE_VALL;
    switch (c.kind())
    {
        case ColliderKind::Sphere:
            return base + s.x * length(d);
        case ColliderKind::Capsule:
            return base + s.x * length(d) + s.z * fabsl(d.z);
        case ColliderKind::Box:
            return base + s.x * fabsl(d.x) + s.y * fabsl(d.y) + s.z * fabsl(d.z);
        case ColliderKind::Cylinder:
            return base + s.x * sqrtl(d.x * d.x + d.y * d.y) + s.z * fabsl(d.z);
        default:
            for (const Vec3& v : c.hull().vertices) most = std::max(most, dot(d, wide(v)));
            return base + most;
    }
}

/// How far p is outside of the solid; 0 or less inside.
Real outside(const Collider& c, const Pose& X, const Vec3& p)
{
    const Wide l = rotate(conjugate(X.q), wide(p) - wide(X.p));
    const Vec3& s = c.size();
    const auto beyond = [](Real a, Real b) { return std::max(fabsl(a) - b, Real(0)); };
    Real most = -HUGE_VALL;
    switch (c.kind())
    {
        case ColliderKind::Sphere:
            return length(l) - s.x;
        case ColliderKind::Capsule:
            return length({l.x, l.y, beyond(l.z, s.z)}) - s.x;
        case ColliderKind::Box:
            return length({beyond(l.x, s.x), beyond(l.y, s.y), beyond(l.z, s.z)});
        case ColliderKind::Cylinder:
            return std::max(sqrtl(l.x * l.x + l.y * l.y) - s.x, fabsl(l.z) - s.z);
        default:
            for (std::size_t f = 0; f < c.hull().faces.size(); ++f)
                most = std::max(most, dot(wide(c.hull().normals[f]), l) - c.hull().offsets[f]);
            return most;
    }
}

constexpr std::array<const char*, 5> kNames{"sphere", "capsule", "box", "cylinder", "hull"};

Collider random_solid(std::size_t kind, std::uint64_t& seed, double scale)
{
    constexpr std::array kKinds{GeometryKind::Sphere, GeometryKind::Capsule, GeometryKind::Box, GeometryKind::Cylinder, GeometryKind::Mesh};
    const auto size = [&] { return scale * std::pow(10, uniform(seed, -1, 0)); };
    Geometry g;
    g.kind = kKinds[kind];
    g.size.x = size(), g.size.y = size(), g.size.z = size();
    if (g.kind != GeometryKind::Mesh) return Collider(g);
    std::vector<Vec3> points;
    for (int i = 0; i < 24; ++i) points.push_back(normalized(random_vector(seed, 1)) * g.size.x);
    return Collider(mesh_of(std::move(points)));
}

struct Worst
{
    double gap = 0, depth = 0, above_least = 0;
};

/// Bound on the relative error of the gap: for a gap by both bounds, for a depth by the planes.
void judge(const Collider& a, const Pose& X, const Collider& b, const Pose& Y, double scale, std::uint64_t& seed, Worst& worst)
{
    const Separation s = separation(a, X, b, Y), mirrored = separation(b, Y, a, X);
    REQUIRE(std::isfinite(s.gap));
    CHECK(std::fabs(plab::length(s.normal) - 1) < 1e-15);
    CHECK(mirrored.gap == s.gap);
    CHECK(mirrored.normal == -s.normal);
    CHECK(mirrored.point_a == s.point_b);
    const auto depth_along = [&](const Wide& d) { return reach(a, X, d) + reach(b, Y, d * -1); };
    Wide n = wide(s.normal);
    n = n * (1 / length(n));
    const Real depth = depth_along(n), miss = fabsl(s.gap + depth);
    if (s.gap > 0)
    {
        const Real distance = length(wide(s.point_b) - wide(s.point_a));
        const Real stray = std::max(outside(a, X, s.point_a), outside(b, Y, s.point_b));
        worst.gap = std::max(worst.gap, static_cast<double>(std::max({miss, distance + depth, stray})) / scale);
        return;
    }
    worst.depth = std::max(worst.depth, static_cast<double>(miss) / scale);
    Real least = depth;
    for (int i = 0; i < 100; ++i) least = std::min(least, depth_along(wide(normalized(random_vector(seed, 1)))));
    worst.above_least = std::max(worst.above_least, static_cast<double>((depth - least) / std::max(depth, Real(1e-9) * scale)));
}
}  // namespace

TEST_CASE("every pair, apart and overlapping, of any size: gap and depth to rounding")
{
    for (const double scale : {1.0, 1e-6, 1e6})
        for (std::size_t i = 0; i < kNames.size(); ++i)
            for (std::size_t j = i; j < kNames.size(); ++j)
            {
                CAPTURE(std::string(kNames[i]));
                CAPTURE(std::string(kNames[j]));
                std::uint64_t seed = 100 * i + j + 1;
                Worst worst;
                for (int k = 0; k < 60; ++k)
                {
                    const Collider a = random_solid(i, seed, scale), b = random_solid(j, seed, scale);
                    const Pose X{random_vector(seed, 0.5 * scale), random_rotation(seed)};
                    const Pose Y{random_vector(seed, (k % 2 ? 1.0 : 2.5) * scale), random_rotation(seed)};
                    judge(a, X, b, Y, scale, seed, worst);
                }
                CHECK(worst.gap < 1e-13);
                CHECK(worst.depth < 2e-14);
                CHECK(worst.above_least < 0.02);
            }
}

TEST_CASE("nearly touching, by a millionth of the size on either side: the gap passes zero without a jump")
{
    for (std::size_t i = 0; i < kNames.size(); ++i)
        for (std::size_t j = i; j < kNames.size(); ++j)
        {
            CAPTURE(std::string(kNames[i]));
            CAPTURE(std::string(kNames[j]));
            std::uint64_t seed = 1000 + 100 * i + j;
            double jump = 0;
            for (int k = 0; k < 20; ++k)
            {
                const Collider a = random_solid(i, seed, 1), b = random_solid(j, seed, 1);
                const Pose X{random_vector(seed, 0.5), random_rotation(seed)};
                Pose Y{normalized(random_vector(seed, 1)) * 4, random_rotation(seed)};
                const Separation far = separation(a, X, b, Y);
                const Vec3 start = Y.p;
                for (const double gap : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 0.0, -1e-15, -1e-12, -1e-9, -1e-6})
                {
                    Y.p = start - far.normal * (far.gap - gap);
                    // The depth of an overlap may be less: another direction may separate the bodies sooner.
                    const double found = separation(a, X, b, Y).gap;
                    jump = std::max(jump, gap >= 0 ? std::fabs(found - gap) : std::max(gap - found, found));
                }
            }
            CHECK(jump < 1e-11);  // most pairs: 1e-15
        }
}

TEST_CASE("a pair that is further apart than asked for has a lower bound of its gap; any other has the gap itself")
{
    std::uint64_t seed = 5;
    int beyond = 0, within = 0;
    for (std::size_t i = 1; i < kNames.size(); ++i)
        for (std::size_t j = i; j < kNames.size(); ++j)
            for (int k = 0; k < 100; ++k)
            {
                const Collider a = random_solid(i, seed, 1), b = random_solid(j, seed, 1);
                const Solid A(a, {random_vector(seed, 0.5), random_rotation(seed)}),
                    B(b, {random_vector(seed, 1.5), random_rotation(seed)});
                const Separation exact = separation_of(A, B);
                const double limit = uniform(seed, 0, 0.5);
                const Separation s = separation_of(A, B, limit);
                CAPTURE(std::string(kNames[i]));
                CAPTURE(std::string(kNames[j]));
                if (exact.gap > limit)
                {
                    ++beyond;
                    CHECK(s.gap > limit);
                    CHECK(s.gap <= exact.gap + 1e-14);
                    continue;
                }
                ++within;
                CHECK(s.gap == exact.gap);
                CHECK(s.normal == exact.normal);
            }
    CHECK(beyond > 200);
    CHECK(within > 200);
}

TEST_CASE("the furthest of many points is the first one of those that are furthest")
{
    std::uint64_t seed = 3;
    for (std::size_t count = 1; count < 70; ++count)
        for (int k = 0; k < 20; ++k)
        {
            std::vector<Vec3> points;
            // Few different numbers, so that several points are furthest.
            for (std::size_t i = 0; i < count; ++i)
            {
                const Vec3 v = random_vector(seed, 3);
                points.push_back({std::round(v.x), std::round(v.y), std::round(v.z)});
            }
            const Vec3 v = random_vector(seed, 2), d{std::round(v.x), std::round(v.y), std::round(v.z)};
            std::size_t want = 0;
            for (std::size_t i = 1; i < count; ++i)
                if (dot(d, points[i]) > dot(d, points[want])) want = i;
            const PointColumns::Furthest found = PointColumns(points).furthest(d);
            CHECK(found.index == want);
            CHECK(found.along == dot(d, points[want]));
        }
}

TEST_CASE("against a plane the gap is that of the lowest point")
{
    Geometry flat;
    flat.kind = GeometryKind::Plane;
    const Collider plane(flat);
    std::uint64_t seed = 7;
    for (std::size_t i = 0; i < kNames.size(); ++i)
        for (int k = 0; k < 100; ++k)
        {
            const Collider a = random_solid(i, seed, 1);
            const Pose X{random_vector(seed, 1), random_rotation(seed)}, P{random_vector(seed, 1), random_rotation(seed)};
            const Wide up = rotate(P.q, Wide{0, 0, 1});
            const Real want = -reach(a, X, up * -1) - dot(up, wide(P.p));
            const Separation s = separation(a, X, plane, P), back = separation(plane, P, a, X);
            CHECK(fabsl(s.gap - want) < 2e-15);
            CHECK(back.gap == s.gap);
            CHECK(back.normal == -s.normal);
            CHECK(outside(a, X, s.point_a) < 4e-15);
        }
}

TEST_CASE("degenerate pairs: the same position, the same solid, needles and plates; the depth is finite, and moving by it separates them")
{
    std::uint64_t seed = 11;
    Geometry needle, plate;
    needle.kind = GeometryKind::Box, needle.size = {1e-6, 1e-6, 1};
    plate.kind = GeometryKind::Cylinder, plate.size = {1, 0, 1e-6};
    std::vector<Collider> solids;
    for (std::size_t i = 0; i < kNames.size(); ++i) solids.push_back(random_solid(i, seed, 1));
    solids.emplace_back(needle), solids.emplace_back(plate);
    solids.push_back(Collider(mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1e-6, 0}, {0, 0, 1e-6}})));
    const Quat turns[] = {{}, {std::sqrt(0.5), 0, std::sqrt(0.5), 0}, random_rotation(seed)};
    for (std::size_t i = 0; i < solids.size(); ++i)
        for (std::size_t j = 0; j < solids.size(); ++j)
            for (const Quat& q : turns)
            {
                CAPTURE(i);
                CAPTURE(j);
                const Pose X{{0.1, 0.2, 0.3}, {}};
                Pose Y{{0.1, 0.2, 0.3}, q};
                const Separation s = separation(solids[i], X, solids[j], Y);
                REQUIRE(std::isfinite(s.gap));
                REQUIRE(std::fabs(length(s.normal) - 1) < 1e-12);
                Y.p += s.normal * (1e-9 - s.gap);
                CHECK(separation(solids[i], X, solids[j], Y).gap > -1e-12);
            }
}
