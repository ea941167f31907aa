/// Mass properties against closed forms, geometry as passed to the host, and every refusal of a mesh.
#include <doctest/doctest.h>

#include <numbers>

#include "meshes.h"
#include "objects/shapes/composed.h"
#include "objects/shapes/meshes.h"
#include "objects/shapes/primitives.h"
#include "objects/shapes/volume_integration.h"
#include "plab/plugin.h"
#include "plab/rotation.h"
#include "table.h"

using namespace plab;
using namespace plab::shapes;
using namespace plab::test;

extern "C" void plab_plugin_register(plab::Registrar& registrar);

namespace
{

MassProperties integrate(const MeshData& mesh)
{
    const auto solid = solid_mesh(mesh.vertices, mesh.triangles);
    REQUIRE(reason_of(solid ? Result<void>() : Result<void>(solid.error())) == "accepted");
    return *solid;
}

std::string refusal(const MeshData& mesh)
{
    const auto solid = solid_mesh(mesh.vertices, mesh.triangles);
    return solid ? "accepted" : solid.error().reason;
}

double relative(double value, double expected) { return std::fabs(value - expected) / std::fabs(expected); }

}  // namespace

TEST_CASE("a tetrahedron's integrals agree with the closed forms")
{
    const double a = 0.3, b = 0.7, c = 1.1, v = a * b * c / 6;
    const MassProperties solid = integrate(corner_tetrahedron(a, b, c));
    const Mat3 expected{{{v * 3 / 80 * (b * b + c * c), v * a * b / 80, v * a * c / 80},
                         {v * a * b / 80, v * 3 / 80 * (c * c + a * a), v * b * c / 80},
                         {v * a * c / 80, v * b * c / 80, v * 3 / 80 * (a * a + b * b)}}};
    CHECK(relative(solid.mass, v) < 1e-15);
    CHECK(length(solid.center - Vec3{a / 4, b / 4, c / 4}) < 1e-15);
    CHECK(largest_difference(solid.inertia, expected) < 1e-15 * v);
}

TEST_CASE("a box as a mesh has the mass properties of the box, at any position")
{
    const Vec3 half{0.1, 0.2, 0.3};
    const MassProperties box = solid_box(half);
    CHECK(box.mass == doctest::Approx(0.048).epsilon(1e-15));
    CHECK(box.inertia(0, 0) == doctest::Approx(0.048 * 0.13 / 3).epsilon(1e-15));
    for (const double offset : {0.0, 1.0, 1e6})
    {
        MeshData mesh = box_mesh(half);
        const Vec3 shift{offset, -2 * offset, 3 * offset};
        for (Vec3& v : mesh.vertices) v += shift;
        const MassProperties solid = integrate(mesh);
        // The corners themselves are rounded to half an ulp of the offset.
        const double ulp = offset * 2.3e-16 * 3 / 0.1;
        CHECK(relative(solid.mass, box.mass) < 1e-14 + 8 * ulp);
        CHECK(length(solid.center - shift) <= 1e-15 + 1e-15 * length(shift));
        CHECK(largest_difference(solid.inertia, box.inertia) < (1e-14 + 16 * ulp) * box.inertia(0, 0));
    }
}

TEST_CASE("an uneven distribution of a mesh's vertices does not matter")
{
    MeshData mesh = box_mesh({0.1, 0.2, 0.3});
    mesh.vertices.insert(mesh.vertices.end(), 20, Vec3{3, 2, 1});
    const MassProperties solid = integrate(mesh), box = solid_box({0.1, 0.2, 0.3});
    CHECK(relative(solid.mass, box.mass) < 1e-13);
    CHECK(length(solid.center) < 1e-13);
    CHECK(largest_difference(solid.inertia, box.inertia) < 1e-13 * box.inertia(0, 0));
}

TEST_CASE("icospheres converge to the sphere with the square of the edge")
{
    const MassProperties sphere = solid_sphere(1);
    CHECK(sphere.mass == doctest::Approx(4 * std::numbers::pi / 3).epsilon(1e-15));
    CHECK(sphere.inertia(1, 1) == doctest::Approx(0.4 * sphere.mass).epsilon(1e-15));
    double error = 0;
    for (int level = 2; level <= 5; ++level)
    {
        const MassProperties solid = integrate(icosphere(level));
        const double now = relative(solid.inertia(2, 2), sphere.inertia(2, 2));
        if (level > 2) CHECK(error / now == doctest::Approx(4).epsilon(0.03));
        error = now;
    }
    CHECK(error < 3e-3);
}

TEST_CASE("a pose moves the centre and turns the inertia")
{
    const double angle = 0.5, c = std::cos(angle), s = std::sin(angle);
    const MassProperties box = solid_box({1, 2, 3});
    const MassProperties moved = posed({box.mass, {1, 0, 0}, box.inertia}, {{0, 5, 0}, exp_rotation({0, 0, angle})});
    const double xx = box.inertia(0, 0), yy = box.inertia(1, 1);
    CHECK(moved.mass == box.mass);
    CHECK(length(moved.center - Vec3{c, 5 + s, 0}) < 1e-15);
    CHECK(moved.inertia(0, 0) == doctest::Approx(c * c * xx + s * s * yy).epsilon(1e-14));
    CHECK(moved.inertia(0, 1) == doctest::Approx(c * s * (xx - yy)).epsilon(1e-14));
    CHECK(moved.inertia(1, 0) == moved.inertia(0, 1));
    CHECK(posed(box, {}).inertia == box.inertia);
}

TEST_CASE("a posed mesh equals the mesh of posed vertices")
{
    const Pose X{{3, -1, 2}, exp_rotation({0.3, -1.2, 0.7})};
    const MeshData mesh = corner_tetrahedron(1, 2, 3);
    MeshData moved = mesh;
    for (Vec3& v : moved.vertices) v = X * v;
    const MassProperties a = posed(integrate(mesh), X), b = integrate(moved);
    CHECK(relative(a.mass, b.mass) < 1e-14);
    CHECK(length(a.center - b.center) < 1e-14);
    CHECK(largest_difference(a.inertia, b.inertia) < 1e-14);
}

TEST_CASE("a cavity counts as a hole")
{
    MeshData mesh = box_mesh({1, 1, 1});
    const MeshData hole = box_mesh({0.5, 0.5, 0.5});
    for (std::size_t i = 0; i < hole.triangles.size(); i += 3)
        for (const std::size_t k : {i, i + 2, i + 1}) mesh.triangles.push_back(hole.triangles[k] + 8);
    mesh.vertices.insert(mesh.vertices.end(), hole.vertices.begin(), hole.vertices.end());
    CHECK(integrate(mesh).mass == doctest::Approx(7).epsilon(1e-15));
}

TEST_CASE("vertices that are repeated for each face still give a closed mesh")
{
    const MeshData box = box_mesh({1, 1, 1});
    MeshData loose;
    for (const std::uint32_t v : box.triangles)
    {
        loose.triangles.push_back(static_cast<std::uint32_t>(loose.vertices.size()));
        loose.vertices.push_back(box.vertices[v]);
    }
    CHECK(integrate(loose).mass == doctest::Approx(8).epsilon(1e-15));
}

TEST_CASE("a mesh without a definite volume is refused, and the message names the edge")
{
    MeshData open = box_mesh({1, 1, 1});
    open.triangles.resize(open.triangles.size() - 3);
    CHECK(refusal(open) == "mesh is open at edge 1-5; every edge must have two triangles");

    MeshData doubled = box_mesh({1, 1, 1});
    doubled.triangles.insert(doubled.triangles.end(), {0, 2, 3});
    CHECK(refusal(doubled) == "mesh is not a manifold: edge 0-2 has 3 triangles; every edge must have two");

    MeshData turned = box_mesh({1, 1, 1});
    std::swap(turned.triangles[0], turned.triangles[1]);
    CHECK(refusal(turned) == "mesh is wound inconsistently: the two triangles at edge 0-2 run along it in the same direction");

    MeshData inverted = box_mesh({1, 1, 1});
    for (std::size_t i = 0; i < inverted.triangles.size(); i += 3) std::swap(inverted.triangles[i], inverted.triangles[i + 1]);
    CHECK(refusal(inverted) == "mesh is inside out; triangles must be counter-clockwise seen from outside");

    CHECK(refusal(box_mesh({1, 1, 0})) == "mesh has no volume; it must enclose a solid");
    CHECK(refusal(corner_tetrahedron(1, 2, 1e-17)) == "mesh has no volume; it must enclose a solid");
    CHECK(refusal({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 1}}) == "mesh has no volume; it must enclose a solid");
    CHECK(refusal(corner_tetrahedron(1, 2, 1e-9)) == "accepted");
}

TEST_CASE("a mesh whose numbers do not make triangles is refused before it is drawn")
{
    TableFixture<MeshRows> table;
    Shapes host = make_shapes(1);
    MassProperties solid;
    const MeshData box = box_mesh({1, 1, 1});
    table.rows.vertices[0] = box.reals();
    table.rows.triangles[0] = box.integers();

    const auto both_say = [&](const std::string& expected)
    {
        CHECK(reason_of(prepare_mesh(table.context(), 0, table.rows, host)) == expected);
        CHECK(reason_of(measure_mesh(0, table.rows, solid)) == expected);
    };
    both_say("accepted");
    table.rows.triangles[0][4] = 8;
    both_say("triangle 1 names vertex 8; vertices are numbered from 0 to 7");
    table.rows.triangles[0][4] = -1;
    both_say("triangle 1 names vertex -1; vertices are numbered from 0 to 7");
    table.rows.triangles[0].resize(4);
    both_say("triangles must be triples of vertex numbers, not 4 numbers");
    table.rows.triangles[0].clear();
    both_say("triangles must be triples of vertex numbers, not 0 numbers");
    table.rows.vertices[0][3] = std::nan("");
    both_say("vertex 1 must be finite");
    table.rows.vertices[0].pop_back();
    both_say("vertices must be triples x y z, not 23 numbers");
}

TEST_CASE("an open mesh is drawn but not measured")
{
    TableFixture<MeshRows> table;
    Shapes host = make_shapes(1);
    MassProperties solid;
    table.rows.vertices[0] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    table.rows.triangles[0] = {0, 1, 2};
    table.rows.hull_collides[0] = false;
    CHECK(reason_of(prepare_mesh(table.context(), 0, table.rows, host)) == "accepted");
    CHECK(host.geometry[0].kind == GeometryKind::Mesh);
    CHECK(host.geometry[0].vertices[2] == Vec3{0, 1, 0});
    CHECK(host.geometry[0].triangles == std::vector<std::uint32_t>{0, 1, 2});
    CHECK_FALSE(host.geometry[0].hull_collides);
    CHECK(reason_of(measure_mesh(0, table.rows, solid)) == "mesh is open at edge 0-1; every edge must have two triangles");
}

TEST_CASE("primitives provide their geometry and their mass properties in the body's frame")
{
    Shapes host = make_shapes(1);
    MassProperties solid;
    const Pose X{{1, 2, 3}, exp_rotation({0, 0.4, 0})};

    TableFixture<SphereRows> sphere;
    CHECK(sphere.schema.find_field("radius")->required);
    sphere.rows.radius[0] = 2;
    sphere.rows.shape.position[0] = X.p;
    prepare_sphere(sphere.context(), 0, sphere.rows, host);
    CHECK(host.geometry[0].kind == GeometryKind::Sphere);
    CHECK(host.geometry[0].size.x == 2);
    CHECK(host.geometry[0].pose.p == X.p);
    measure_sphere(0, sphere.rows, solid);
    CHECK(solid.mass == doctest::Approx(32 * std::numbers::pi / 3).epsilon(1e-15));
    CHECK(solid.center == X.p);

    TableFixture<BoxRows> box;
    box.rows.half_extents[0] = {1, 2, 3};
    box.rows.shape.orientation[0] = X.q;
    prepare_box(box.context(), 0, box.rows, host);
    CHECK(host.geometry[0].kind == GeometryKind::Box);
    CHECK(host.geometry[0].size == Vec3{1, 2, 3});
    CHECK(host.geometry[0].pose.q == X.q);
    measure_box(0, box.rows, solid);
    CHECK(solid.inertia == posed(solid_box({1, 2, 3}), {{}, X.q}).inertia);

    TableFixture<PlaneRows> plane;
    plane.rows.shape.position[0] = X.p;
    prepare_plane(plane.context(), 0, plane.rows, host);
    CHECK(host.geometry[0].kind == GeometryKind::Plane);
    CHECK(host.geometry[0].pose.p == X.p);
    CHECK(reason_of(measure_plane(0, plane.rows, solid)) == "a plane is unbounded and has no volume");
}

TEST_CASE("a placed shape is the shape referred to, moved as a whole")
{
    Shapes host = make_shapes(2);
    TableFixture<BoxRows> box;
    box.rows.half_extents[0] = {1, 2, 3};
    box.rows.shape.position[0] = {1, 0, 0};
    TableFixture<PlacedRows> placed;
    placed.indices[0] = 1;
    placed.rows.of[0] = {Facet::Shape, 0};
    placed.rows.shape.position[0] = {0, 0, 4};
    placed.rows.shape.orientation[0] = exp_rotation({0, 0, std::numbers::pi / 2});

    CHECK(reason_of(prepare_placed(placed.context(), 0, placed.rows, host)) ==
          "the placed shape has no geometry; it must not refer back to this one");
    prepare_box(box.context(), 0, box.rows, host);
    measure_box(0, box.rows, host.solid[0]);
    CHECK(reason_of(prepare_placed(placed.context(), 0, placed.rows, host)) == "accepted");
    CHECK(host.geometry[1].kind == GeometryKind::Box);
    CHECK(length(host.geometry[1].pose.p - Vec3{0, 1, 4}) < 1e-15);
    CHECK(reason_of(measure_placed(0, placed.rows, host, host.solid[1])) == "accepted");
    CHECK(length(host.solid[1].center - Vec3{0, 1, 4}) < 1e-15);
    CHECK(host.solid[1].inertia(0, 0) == doctest::Approx(host.solid[0].inertia(1, 1)).epsilon(1e-14));

    host.unmeasurable[0] = "mesh is open at edge 3-7";
    CHECK(reason_of(measure_placed(0, placed.rows, host, host.solid[1])) == "mesh is open at edge 3-7");
}

TEST_CASE("the plugin declares fourteen shapes with the commands of the paper")
{
    Registrar registrar;
    plab_plugin_register(registrar);
    CHECK(registrar.types().size() == 14);
    for (const TypeInfo& type : registrar.types())
    {
        CAPTURE(type.name);
        CHECK(type.facet == Facet::Shape);
        CHECK(type.family == "Shape");
        REQUIRE(type.commands.size() == 3);
        CHECK(type.commands[1].name == "Shape/VolumeIntegration");
        CHECK(type.commands[1].phase == Phase::Measure);
        CHECK(type.commands[2].name == "Shape/Draw");
        CHECK_FALSE(static_cast<bool>(type.commands[2].run));
    }
}
