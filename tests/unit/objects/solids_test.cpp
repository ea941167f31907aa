/// Capsule, convex hull and compound: mass properties against closed forms and integrals, geometry, refusals.
#include <doctest/doctest.h>

#include <ctime>
#include <numbers>

#include "meshes.h"
#include "objects/shapes/built_mesh.h"
#include "objects/shapes/composed.h"
#include "objects/shapes/meshes.h"
#include "objects/shapes/primitives.h"
#include "objects/shapes/volume_integration.h"
#include "plab/convex_hull.h"
#include "plab/random.h"
#include "table.h"

using namespace plab;
using namespace plab::shapes;
using namespace plab::test;

namespace
{

Geometry geometry_of(GeometryKind kind, const Vec3& size, const Pose& pose = {})
{
    Geometry g;
    g.kind = kind, g.size = size, g.pose = pose;
    return g;
}

MassProperties integrated(const BuiltMesh& mesh)
{
    const auto solid = solid_mesh(mesh.vertices, mesh.triangles);
    REQUIRE(solid.ok());
    return *solid;
}

/// int over the solid of revolution: simple sums over z of a circle's area and moments.
MassProperties capsule_by_slices(double r, double l, int n)
{
    MassProperties out;
    const double half = 0.5 * l + r, h = 2 * half / n;
    for (int i = 0; i < n; ++i)
    {
        const double z = -half + (i + 0.5) * h, beyond = std::fmax(std::fabs(z) - 0.5 * l, 0);
        const double rr = r * r - beyond * beyond, m = std::numbers::pi * rr * h;
        out.mass += m;
        out.inertia(2, 2) += 0.5 * m * rr;
        out.inertia(0, 0) += m * (0.25 * rr + z * z);
    }
    return out;
}

}  // namespace

TEST_CASE("a capsule has the mass properties of its slices; short ones those of a ball, long ones those of a rod")
{
    for (const auto& [r, l] : {std::pair{0.2, 0.5}, {0.01, 3.0}, {1.0, 0.1}})
    {
        const MassProperties exact = solid_capsule(r, l), slices = capsule_by_slices(r, l, 200000);
        CHECK(exact.mass == doctest::Approx(slices.mass).epsilon(1e-9));
        CHECK(exact.inertia(2, 2) == doctest::Approx(slices.inertia(2, 2)).epsilon(1e-9));
        CHECK(exact.inertia(0, 0) == doctest::Approx(slices.inertia(0, 0)).epsilon(1e-9));
    }
    CHECK(solid_capsule(0.3, 1e-9).inertia(0, 0) == doctest::Approx(solid_sphere(0.3).inertia(0, 0)).epsilon(1e-8));
    CHECK(solid_capsule(1e-6, 2).inertia(0, 0) == doctest::Approx(solid_cylinder(1e-6, 2).inertia(0, 0)).epsilon(1e-5));
}

TEST_CASE("a capsule provides its radius and half length, and rotates with its pose")
{
    TableFixture<CapsuleRows> table;
    table.rows.radius[0] = 0.2, table.rows.length[0] = 0.6;
    table.rows.shape.position[0] = {1, 0, 0};
    table.rows.shape.orientation[0] = {std::sqrt(0.5), 0, std::sqrt(0.5), 0};
    Shapes host = make_shapes(1);
    prepare_capsule(table.context(), 0, table.rows, host);
    CHECK(host.geometry[0].kind == GeometryKind::Capsule);
    CHECK(host.geometry[0].size == Vec3{0.2, 0, 0.3});
    MassProperties solid;
    measure_capsule(0, table.rows, solid);
    CHECK(solid.center.x == 1);
    CHECK(solid.inertia(0, 0) == doctest::Approx(solid_capsule(0.2, 0.6).inertia(2, 2)).epsilon(1e-14));
}

TEST_CASE("the hull of a box's corners and of points inside is the box, in mass and in triangles")
{
    TableFixture<ConvexHullRows> table;
    for (const Vec3& v : box_mesh({0.1, 0.2, 0.3}).vertices)
        for (const double share : {1.0, 0.3})
            for (const double x : {v.x * share, v.y * share, v.z * share}) table.rows.points[0].push_back(x);
    Shapes host = make_shapes(1);
    REQUIRE(reason_of(prepare_convex_hull(table.context(), 0, table.rows, host)) == "accepted");
    CHECK(host.geometry[0].kind == GeometryKind::Mesh);
    CHECK(host.geometry[0].hull_collides);
    CHECK(host.geometry[0].vertices.size() == 8);
    CHECK(host.geometry[0].triangles.size() == 36);
    MassProperties solid;
    REQUIRE(reason_of(measure_convex_hull(0, table.rows, host, solid)) == "accepted");
    const MassProperties box = solid_box({0.1, 0.2, 0.3});
    CHECK(solid.mass == doctest::Approx(box.mass).epsilon(1e-14));
    CHECK(largest_difference(solid.inertia, box.inertia) < 1e-15 * box.mass);
}

TEST_CASE("the hull of a mesh has its points in the mesh's own pose")
{
    TableFixture<ConvexHullRows> table;
    Shapes host = make_shapes(2);
    host.geometry[1].kind = GeometryKind::Mesh;
    host.geometry[1].vertices = box_mesh({0.1, 0.2, 0.3}).vertices;
    host.geometry[1].pose.p = {5, 0, 0};
    table.rows.of[0] = {Facet::Shape, 1};
    MassProperties solid;
    REQUIRE(reason_of(measure_convex_hull(0, table.rows, host, solid)) == "accepted");
    CHECK(solid.mass == doctest::Approx(0.048).epsilon(1e-13));
    CHECK(solid.center.x == doctest::Approx(5).epsilon(1e-15));
}

TEST_CASE("points without a hull are refused with the reason")
{
    TableFixture<ConvexHullRows> table;
    Shapes host = make_shapes(2);
    const auto refused = [&](Reals points)
    {
        table.rows.points[0] = std::move(points);
        return reason_of(prepare_convex_hull(table.context(), 0, table.rows, host));
    };
    CHECK(refused({}) == "it needs `points`, or a mesh in the role `of`");
    CHECK(refused({1, 2}) == "points must be triples x y z, not 2 numbers");
    CHECK(refused({0, 0, 0, 1, 0, 0, 0, 1, 0}) == "a hull needs at least 4 vertices, not 3");
    CHECK(refused({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}) == "the vertices lie in a plane: their hull has no volume");
    table.rows.of[0] = {Facet::Shape, 1};
    host.geometry[1].kind = GeometryKind::Sphere;
    CHECK(refused({}) == "`of` must name a shape that is made of vertices, such as a Shape/Mesh");
}

TEST_CASE("hulls of grids and of nearly coplanar points are closed and contain every point")
{
    std::uint64_t seed = 3;
    for (const double noise : {0.0, 1e-16, 1e-13, 1e-11, 1e-6})
    {
        std::vector<Vec3> points;
        for (int i = 0; i < 5 * 5 * 5; ++i)
        {
            const double x = i % 5, y = (i / 5) % 5, z = i / 25;
            points.push_back({x + noise * next_uniform(seed), y + noise * next_uniform(seed), z + noise * next_uniform(seed)});
        }
        const auto hull = make_convex_hull(points);
        CAPTURE(noise);
        REQUIRE(hull.ok());
        double above = 0;
        for (const Vec3& p : points)
            for (std::size_t f = 0; f < hull->faces.size(); ++f) above = std::fmax(above, dot(hull->normals[f], p) - hull->offsets[f]);
        CHECK(above < 1e-9);
        CHECK(hull->vertices.size() + hull->faces.size() == 2 + 3 * hull->faces.size() / 2);  // Euler
    }
}

TEST_CASE("hulls of points rounded to some digits are convex, whichever tolerance they need")
{
    // A cube with 8 x 8 points on each face, rotated, and rounded as in a file.
    std::uint64_t seed = 7;
    for (const double digit : {1e-9, 1e-10, 1e-11, 1e-12})
        for (int turn = 0; turn < 4; ++turn)
        {
            CAPTURE(digit);
            CAPTURE(turn);
            const Quat q = normalized(Quat{next_uniform(seed), next_uniform(seed), next_uniform(seed), next_uniform(seed)});
            std::vector<Vec3> points;
            for (int i = 0; i < 6 * 64; ++i)
            {
                const double u = (i % 8) / 7.0 - 0.5, v = (i / 8 % 8) / 7.0 - 0.5, w = i / 64 % 2 - 0.5;
                const Vec3 p = i / 128 == 0 ? Vec3{u, v, w} : i / 128 == 1 ? Vec3{u, w, v} : Vec3{w, u, v};
                Vec3 turned = rotate(q, p);
                for (int k = 0; k < 3; ++k) turned[k] = std::round(turned[k] / digit) * digit;
                points.push_back(turned);
            }
            const auto hull = make_convex_hull(points);
            REQUIRE(hull.ok());
            double above = 0;
            for (const Vec3& p : points)
                for (std::size_t f = 0; f < hull->faces.size(); ++f) above = std::fmax(above, dot(hull->normals[f], p) - hull->offsets[f]);
            CHECK(above < 1e-6);
        }
}

TEST_CASE("the hull of two flat rims of many points: every point is a corner, and it is found quickly")
{
    // A gear of 500 teeth has 1000 points on its outline; between teeth the outline consists of straight lines. Volume: that of the
    // prism over the polygon.
    const auto rims = [](int n, int between)
    {
        std::vector<Vec3> out;
        const double step = 2 * std::numbers::pi / n;
        for (int i = 0; i < n; ++i)
            for (int k = 0; k <= between; ++k)
            {
                const Vec3 from{std::cos(step * i), std::sin(step * i), 0}, to{std::cos(step * (i + 1)), std::sin(step * (i + 1)), 0};
                const Vec3 p = from + (to - from) * (static_cast<double>(k) / (between + 1));
                for (const double z : {-0.1, 0.1}) out.push_back({p.x, p.y, z});
            }
        return out;
    };
    for (const auto& [n, between] : {std::pair{100, 0}, {1000, 0}, {4000, 0}, {150, 3}})
    {
        CAPTURE(n);
        const std::clock_t begin = std::clock();
        const auto hull = make_convex_hull(rims(n, between));
        CHECK(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC <
              3);  // 0.05 s at the most; when the rim was triangulated again for each point, 2000 took 53 s
        REQUIRE(hull.ok());
        const auto corners = static_cast<std::size_t>(2 * n);
        CHECK(hull->vertices.size() >= corners);
        CHECK(hull->vertices.size() <= corners * static_cast<std::size_t>(1 + between));
        CHECK(hull->vertices.size() + hull->faces.size() == 2 + 3 * hull->faces.size() / 2);  // Euler
        double above = 0, volume = 0;
        for (std::size_t f = 0; f < hull->faces.size(); ++f)
        {
            for (const Vec3& p : hull->vertices) above = std::fmax(above, dot(hull->normals[f], p) - hull->offsets[f]);
            const auto& [a, b, c] = hull->faces[f];
            volume += dot(hull->vertices[a], cross(hull->vertices[b], hull->vertices[c])) / 6;
        }
        CHECK(above < 2e-9);
        CHECK(volume == doctest::Approx(0.1 * n * std::sin(2 * std::numbers::pi / n)).epsilon(1e-9));
    }
}

TEST_CASE("a compound is the sum of its parts about their common centre")
{
    Shapes host = make_shapes(3);
    const Pose left{{-1, 0.2, 0}, {}}, right{{2, 0, 0}, {std::sqrt(0.5), std::sqrt(0.5), 0, 0}};
    host.geometry[1] = geometry_of(GeometryKind::Box, {0.5, 0.2, 0.1}, left);
    host.geometry[2] = geometry_of(GeometryKind::Box, {0.1, 0.2, 0.3}, right);
    host.solid[1] = posed(solid_box({0.5, 0.2, 0.1}), left), host.solid[2] = posed(solid_box({0.1, 0.2, 0.3}), right);
    TableFixture<CompoundRows> table;
    table.rows.parts[0] = {{Facet::Shape, 1}, {Facet::Shape, 2}};
    table.rows.shape.position[0] = {0, 0, 7};
    REQUIRE(reason_of(prepare_compound(table.context(), 0, table.rows, host)) == "accepted");
    const Geometry& g = host.geometry[0];
    CHECK(g.kind == GeometryKind::Compound);
    CHECK(g.parts == std::vector<std::uint32_t>{1, 2});
    MassProperties solid;
    REQUIRE(reason_of(measure_compound(0, table.rows, host, solid)) == "accepted");
    // It is drawn as two closed meshes, which have the same integrals.
    const MassProperties drawn = posed(integrated({g.vertices, g.triangles}), g.pose);
    CHECK(solid.mass == doctest::Approx(drawn.mass).epsilon(1e-14));
    CHECK(length(solid.center - drawn.center) < 1e-14);
    CHECK(largest_difference(solid.inertia, drawn.inertia) < 1e-14);
}

TEST_CASE("two halves of a box have the mass properties of the box; overlapping parts count twice")
{
    const MassProperties half = solid_box({0.5, 1, 1});
    const MassProperties parts[] = {posed(half, {{-0.5 + 1e6, 0, 0}, {}}), posed(half, {{0.5 + 1e6, 0, 0}, {}})};
    const MassProperties whole = joined(parts), box = solid_box({1, 1, 1});
    CHECK(whole.mass == box.mass);
    CHECK(whole.center.x == 1e6);
    CHECK(largest_difference(whole.inertia, box.inertia) < 1e-14);
    const MassProperties twice[] = {half, half};
    CHECK(joined(twice).mass == 2 * half.mass);
}

TEST_CASE("shapes that cannot be parts are refused")
{
    Shapes host = make_shapes(2);
    TableFixture<CompoundRows> table;
    table.rows.parts[0] = {{Facet::Shape, 1}};
    const auto refusal = [&](GeometryKind kind)
    {
        host.geometry[1].kind = kind;
        return reason_of(prepare_compound(table.context(), 0, table.rows, host));
    };
    CHECK(refusal(GeometryKind::Plane) == "a plane is unbounded and cannot be a part; give it to the body as a shape of its own");
    CHECK(refusal(GeometryKind::Compound) == "a compound cannot be a part of another; name its parts instead");
    CHECK(refusal(GeometryKind::None) == "a part has no geometry; it must not refer back to this compound");
    MassProperties solid;
    host.unmeasurable[1] = "mesh is open at edge 0-1";
    CHECK(reason_of(measure_compound(0, table.rows, host, solid)) == "mesh is open at edge 0-1");
}

TEST_CASE("the meshes of round shapes are closed and slightly inside the true ones")
{
    const MassProperties ball = integrated(picture_of(geometry_of(GeometryKind::Sphere, {0.3, 0, 0})));
    CHECK(ball.mass == doctest::Approx(solid_sphere(0.3).mass).epsilon(0.01));
    CHECK(ball.mass < solid_sphere(0.3).mass);
    const MassProperties pill = integrated(picture_of(geometry_of(GeometryKind::Capsule, {0.3, 0, 0.5})));
    CHECK(pill.mass == doctest::Approx(solid_capsule(0.3, 1).mass).epsilon(0.01));
    CHECK(integrated(picture_of(geometry_of(GeometryKind::Box, {1, 2, 3}))).mass == doctest::Approx(48).epsilon(1e-14));
}
