// Surfaces to collide with: bowls and bores against closed forms, triangles against planes and against the convex hull of the
// same triangles.
#include <doctest/doctest.h>

#include <numbers>

#include "bodies.h"
#include "plab/surface.h"

using namespace plab;
using namespace plab::detection;
using namespace plab::test;

namespace
{
Geometry round_surface(Surface kind, double radius, double reach)
{
    Geometry g;
    g.kind = GeometryKind::Mesh;
    set_surface(g, kind, radius, reach);
    return g;
}
/// n x n squares of `spacing` around the origin.
Geometry grid(std::uint32_t n, double spacing, double height = 0)
{
    Geometry g;
    g.kind = GeometryKind::Mesh;
    for (std::uint32_t k = 0; k <= n; ++k)
        for (std::uint32_t i = 0; i <= n; ++i)
        {
            const double x = (i - 0.5 * n) * spacing, y = (k - 0.5 * n) * spacing;
            g.vertices.push_back({x, y, height * std::sin(3 * x) * std::cos(2 * y)});
        }
    for (std::uint32_t k = 0; k < n; ++k)
        for (std::uint32_t i = 0; i < n; ++i)
        {
            const std::uint32_t low = k * (n + 1) + i, high = low + n + 1;
            g.triangles.insert(g.triangles.end(), {low, low + 1, high + 1, low, high + 1, high});
        }
    set_surface(g, Surface::Triangles);
    return g;
}
/// Points on a ball of radius 1: the more points, the finer their hull.
std::vector<Vec3> points_of_ball(int n, std::uint64_t& random)
{
    std::vector<Vec3> out;
    for (int i = 0; i < n; ++i) out.push_back(normalized(random_vector(random, 1)));
    return out;
}
std::vector<Collider> solids()
{
    std::uint64_t random = 5;
    std::vector<Vec3> points = points_of_ball(20, random);
    for (Vec3& p : points) p = {0.3 * p.x, 0.2 * p.y, 0.25 * p.z};
    std::vector<Collider> out;
    out.emplace_back(solid(GeometryKind::Sphere, {0.2, 0, 0})), out.emplace_back(solid(GeometryKind::Box, {0.3, 0.2, 0.1}));
    out.emplace_back(solid(GeometryKind::Capsule, {0.15, 0, 0.2})), out.emplace_back(solid(GeometryKind::Cylinder, {0.15, 0, 0.2}));
    out.emplace_back(mesh_of(points));
    return out;
}
/// All points of a solid, more or less.
std::vector<Vec3> samples(const Collider& c, const Pose& X)
{
    std::vector<Vec3> out;
    const Vec3& s = c.size();
    const int n = 200;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k <= n / 2; ++k)
        {
            const double a = 2 * std::numbers::pi * i / n, b = std::numbers::pi * k / (n / 2);
            const Vec3 d{std::cos(a) * std::sin(b), std::sin(a) * std::sin(b), std::cos(b)};
            switch (c.kind())
            {
                case ColliderKind::Sphere:
                    out.push_back(X * (s.x * d));
                    break;
                case ColliderKind::Capsule:
                    out.push_back(X * (s.x * d + Vec3{0, 0, d.z < 0 ? -s.z : s.z}));
                    break;
                case ColliderKind::Cylinder:
                    out.push_back(X * Vec3{s.x * std::cos(a), s.x * std::sin(a), k % 2 ? s.z : -s.z});
                    break;
                default:
                    break;
            }
        }
    if (c.kind() == ColliderKind::Box)
        for (const Vec3& p : box_corners(s)) out.push_back(X * p);
    for (const Vec3& p : c.hull().vertices) out.push_back(X * p);
    return out;
}
}  // namespace

TEST_CASE("the gap to the inside of a bowl and a bore is the distance left for the outermost point")
{
    const Collider bowl(round_surface(Surface::Bowl, 1, 1)), bore(round_surface(Surface::Bore, 1, 50));
    std::uint64_t random = 3;
    for (const Collider& c : solids())
        for (int i = 0; i < 100; ++i)
        {
            CAPTURE(static_cast<int>(c.kind()));
            CAPTURE(i);
            const Pose X{random_vector(random, 0.5), random_rotation(random)};
            double in_bowl = HUGE_VAL, in_bore = HUGE_VAL;
            for (const Vec3& p : samples(c, X))
            {
                in_bowl = std::min(in_bowl, 1 - length(p));
                in_bore = std::min(in_bore, 1 - std::hypot(p.x, p.y));
            }
            // Samples are not quite the outermost points of round solids.
            const bool round = c.kind() != ColliderKind::Box && c.kind() != ColliderKind::Hull;
            const double most = round ? 2e-4 : 1e-15;
            const Separation s = separation(c, X, bowl, {}), t = separation(c, X, bore, {});
            CHECK(s.gap <= in_bowl + 1e-15);
            CHECK(s.gap >= in_bowl - most);
            CHECK(t.gap <= in_bore + 1e-15);
            CHECK(t.gap >= in_bore - most);
            for (const Separation& q : {s, t}) CHECK(length(q.point_a + q.gap * q.normal - q.point_b) < 1e-14);
        }
}

TEST_CASE("a ball touches the rim of a bowl, from inside and from above")
{
    const Collider bowl(round_surface(Surface::Bowl, 1, 0)), ball(solid(GeometryKind::Sphere, {0.1, 0, 0}));
    CHECK(separation(ball, {{0.8, 0, 0.3}, {}}, bowl, {}).gap == near(std::hypot(0.2, 0.3) - 0.1, 1e-14));
    CHECK(separation(ball, {{0, 1.3, 0.4}, {}}, bowl, {}).gap == near(0.4, 1e-14));
    CHECK(separation(ball, {{0.5, 0, 0}, {}}, bowl, {}).gap == near(0.4, 1e-14));
    // Completely behind the wall: it did not come from inside.
    CHECK(separation(ball, {{0, 0, -1.5}, {}}, bowl, {}).gap == HUGE_VAL);
}

TEST_CASE("a box lies in a bore on two edges, along their radii")
{
    const double half = 0.25, down = std::sqrt(1 - half * half) - 0.1;
    const Collider bore(round_surface(Surface::Bore, 1, 2)), box(solid(GeometryKind::Box, {half, 0.1, 0.6}));
    ContactPoints contact_points(1e-9);
    collide(box, {{0, -down, 0}, {}}, bore, {}, contact_points);
    REQUIRE(contact_points.all().size() == 4);
    for (const ContactPoint& t : contact_points.all())
    {
        CHECK(std::fabs(t.depth) < 1e-15);
        CHECK(t.normal.x == near(t.point.x > 0 ? half : -half, 1e-14));
        CHECK(t.normal.y == near(-std::sqrt(1 - half * half), 1e-14));
        CHECK(t.normal.z == 0);
    }
    // Half out of the end: edges carry it where they leave the bore.
    contact_points.clear();
    collide(box, {{0, -down, 2}, {}}, bore, {}, contact_points);
    REQUIRE(contact_points.all().size() == 4);
    for (const ContactPoint& t : contact_points.all())
    {
        CHECK(t.point.z == near(t.point.z > 1.7 ? 2 : 1.4, 1e-14));
        CHECK(t.normal.x == near(t.point.x > 0 ? half : -half, 1e-12));
    }
}

TEST_CASE("a flat grid is a plane, over faces, edges and corners")
{
    const Collider flat(grid(20, 0.125)), plane(solid(GeometryKind::Plane, {}));
    std::uint64_t random = 9;
    for (const Collider& c : solids())
        for (int i = 0; i < 200; ++i)
        {
            CAPTURE(static_cast<int>(c.kind()));
            // Every fourth one exactly over an edge or a corner.
            Pose X{random_vector(random, 0.4), i % 3 == 0 ? Quat{} : random_rotation(random)};
            if (i % 4 == 0) X.p.x = 0.125 * std::round(8 * X.p.x), X.p.y = i % 8 == 0 ? 0.125 * std::round(8 * X.p.y) : X.p.y;
            X.p.z = 0.3 + 0.1 * X.p.z;
            const double gap = separation(c, X, plane, {}).gap;
            X.p.z -= gap;  // now it touches
            for (const double height : {1e-9, -1e-9, 0.01})
            {
                X.p.z += height;
                CHECK(std::fabs(separation(c, X, flat, {}).gap - separation(c, X, plane, {}).gap) < 2e-15);
                ContactPoints on_plane(1e-6), on_flat(1e-6);
                collide(c, X, plane, {}, on_plane), collide(c, X, flat, {}, on_flat);
                double deepest_plane = -1, deepest_flat = -1;
                for (const ContactPoint& t : on_plane.all()) deepest_plane = std::max(deepest_plane, t.depth);
                for (const ContactPoint& t : on_flat.all())
                {
                    deepest_flat = std::max(deepest_flat, t.depth);
                    CHECK(std::fabs(t.normal.z) == 1);
                }
                CHECK(std::fabs(deepest_plane - deepest_flat) < 2e-15);
                if (c.kind() == ColliderKind::Sphere) CHECK(on_flat.all().size() == on_plane.all().size());
                X.p.z -= height;
            }
        }
}

TEST_CASE("the triangles of a convex solid collide like that solid, from outside")
{
    std::uint64_t random = 12;
    for (const int corners : {4, 8, 30, 300})
    {
        const Collider hull(mesh_of(points_of_ball(corners, random)));
        Geometry mesh;
        mesh.kind = GeometryKind::Mesh, mesh.vertices = hull.hull().vertices;
        for (const auto& face : hull.hull().faces) mesh.triangles.insert(mesh.triangles.end(), face.begin(), face.end());
        set_surface(mesh, Surface::Triangles);
        const Collider surface(mesh);
        REQUIRE(surface.complaint().empty());
        for (const Collider& c : solids())
            for (int i = 0; i < 60; ++i)
            {
                CAPTURE(static_cast<int>(c.kind()));
                CAPTURE(corners);
                CAPTURE(i);
                const Vec3 out = normalized(random_vector(random, 1));
                Pose X{out * uniform(random, 0.9, 2), random_rotation(random)};
                // To a gap of 0.1, 1e-4 or 1e-8.
                for (const double gap : {0.1, 1e-4, 1e-8})
                {
                    for (int k = 0; k < 4; ++k)
                    {
                        const Separation s = separation(c, X, hull, {});
                        X.p -= (gap - s.gap) * s.normal;
                    }
                    const Separation want = separation(c, X, hull, {}), got = separation(c, X, surface, {});
                    CHECK(std::fabs(got.gap - want.gap) < (gap > 1e-6 ? 1e-12 : 2e-11));
                    CHECK(length(got.normal - want.normal) < (gap > 1e-6 ? 1e-6 : 0.05));
                    ContactPoints contact_points(2 * gap);
                    collide(c, X, surface, {}, contact_points);
                    double deepest = -1;
                    for (const ContactPoint& t : contact_points.all()) deepest = std::max(deepest, t.depth);
                    CHECK(std::fabs(deepest + want.gap) < 2e-11);
                }
            }
    }
}

TEST_CASE("a ball between two slopes touches both; over a ridge it touches one point only")
{
    Geometry g;
    g.kind = GeometryKind::Mesh;
    g.vertices = {{-1, -1, 1}, {0, -1, 0}, {1, -1, 1}, {-1, 1, 1}, {0, 1, 0}, {1, 1, 1}};
    g.triangles = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
    set_surface(g, Surface::Triangles);
    const Collider valley(g), ball(solid(GeometryKind::Sphere, {0.1, 0, 0}));
    ContactPoints contact_points;
    collide(ball, {{0, 0.3, 0.1 * std::sqrt(2.0) - 1e-6}, {}}, valley, {}, contact_points);
    REQUIRE(contact_points.all().size() == 2);
    for (const ContactPoint& t : contact_points.all()) CHECK(t.depth == near(1e-6 / std::sqrt(2.0), 1e-8));
    CHECK(contact_points.all()[0].normal.x == near(-contact_points.all()[1].normal.x, 1e-15));
    for (Vec3& v : g.vertices) v.z = -v.z;
    const Collider ridge(g);
    contact_points.clear();
    collide(ball, {{0, 0.3, 0.1 - 1e-6}, {}}, ridge, {}, contact_points);
    REQUIRE(contact_points.all().size() == 1);
    CHECK(contact_points.all()[0].normal.z == near(-1, 1e-15));
}

TEST_CASE("surfaces without a front do not collide, and this is reported")
{
    Geometry flat = grid(1, 1);
    for (Vec3& v : flat.vertices) v = {v.x, 0, 0};
    CHECK(Collider(flat).complaint() == "a surface needs at least one triangle that has an area");
    Geometry twice = grid(1, 1);
    twice.triangles.insert(twice.triangles.end(), {0, 1, 3});
    CHECK(Collider(twice).complaint() == "an edge of more than two triangles, or of two that face in opposite directions, has no front");
}
