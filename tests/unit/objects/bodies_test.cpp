/// Mass properties of bodies from every legal source, and the name of every refusal.
#include <doctest/doctest.h>

#include <numbers>

#include "objects/bodies/inertia.h"
#include "objects/bodies/material_pair.h"
#include "objects/bodies/states.h"
#include "plab/plugin.h"
#include "plab/rotation.h"
#include "table.h"

using namespace plab;
using namespace plab::bodies;
using namespace plab::test;

extern "C" void plab_plugin_register(plab::Registrar& registrar);

namespace
{

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// One rigid body, with a cube (edge 2, centre at x = 2), a ball-like solid (centre at y = 3) and a plane available as shapes.
struct RigidFixture : TableFixture<RigidBodyRows>
{
    Bodies bodies = make_bodies(1);
    Shapes shapes = make_shapes(3);
    Materials materials;

    RigidFixture()
    {
        shapes.solid[0] = {8, {2, 0, 0}, Mat3::diagonal(16.0 / 3, 16.0 / 3, 16.0 / 3)};
        shapes.solid[1] = {4, {0, 3, 0}, Mat3::diagonal(1, 2, 3)};
        shapes.unmeasurable[2] = "a plane is unbounded and has no volume";
    }
    RigidFixture& mass(double m) { return rows.mass[0] = m, *this; }
    RigidFixture& density(double d) { return rows.density[0] = d, *this; }
    RigidFixture& inertia(const Mat3& i) { return rows.inertia[0] = i, *this; }
    RigidFixture& center(const Vec3& c) { return rows.center_of_mass[0] = c, *this; }
    RigidFixture& with(std::initializer_list<std::uint32_t> parts)
    {
        rows.body.shape[0].clear();
        for (const std::uint32_t i : parts) rows.body.shape[0].push_back({Facet::Shape, i});
        return *this;
    }
    std::string prepare() { return reason_of(prepare_rigid_body(context(), 0, rows, bodies, shapes, materials)); }
};

Mat3 turned(const Mat3& inertia, const Vec3& u)
{
    const Mat3 R = rotation_matrix(exp_rotation(u));
    const Mat3 out = R * inertia * transposed(R);
    return (out + transposed(out)) * 0.5;
}

}  // namespace

TEST_CASE("mass and inertia as given; the centre is the origin unless given")
{
    RigidFixture body;
    body.rows.body.material[0] = "steel";
    body.bodies.position[0] = {7, 7, 7};
    REQUIRE(body.mass(2).inertia(Mat3::diagonal(1, 2, 2.5)).with({0}).prepare() == "accepted");
    CHECK(body.bodies.motion[0] == Motion::Dynamic);
    CHECK(body.bodies.mass[0] == 2);
    CHECK(body.bodies.inverse_mass[0] == 0.5);
    CHECK(body.bodies.inertia_B[0] == Mat3::diagonal(1, 2, 2.5));
    CHECK(body.bodies.inverse_inertia_B[0] == Mat3::diagonal(1, 0.5, 0.4));
    CHECK(body.bodies.center_B[0] == Vec3{});
    CHECK(body.bodies.material[0] == body.materials.intern("steel"));
    CHECK(body.bodies.shapes[0] == RefList{{Facet::Shape, 0}});
    CHECK(body.bodies.position[0] == Vec3{7, 7, 7});

    REQUIRE(body.center({0.1, 0, 0}).prepare() == "accepted");
    CHECK(body.bodies.center_B[0] == Vec3{0.1, 0, 0});
    // With a given inertia the shapes are not needed.
    CHECK(body.with({2}).prepare() == "accepted");
}

TEST_CASE("density and shapes: sums about the common centre")
{
    RigidFixture body;
    REQUIRE(body.density(10).with({0, 1}).prepare() == "accepted");
    // m = 80 + 40; c = (160, 120, 0)/120; reduced mass 80*40/120 between centres (-2, 3, 0) apart.
    const double reduced = 80.0 * 40 / 120;
    CHECK(body.bodies.mass[0] == doctest::Approx(120).epsilon(1e-15));
    CHECK(length(body.bodies.center_B[0] - Vec3{4.0 / 3, 1, 0}) < 1e-15);
    const Mat3 expected{{{160.0 / 3 + 10 + reduced * 9, reduced * 6, 0},
                         {reduced * 6, 160.0 / 3 + 20 + reduced * 4, 0},
                         {0, 0, 160.0 / 3 + 30 + reduced * 13}}};
    CHECK(largest_difference(body.bodies.inertia_B[0], expected) < 1e-13 * expected(2, 2));
    const Mat3 one = body.bodies.inertia_B[0] * body.bodies.inverse_inertia_B[0];
    CHECK(largest_difference(one, Mat3::identity()) < 1e-15);
}

TEST_CASE("two halves of a cube have the mass properties of the cube")
{
    const Mat3 half = Mat3::diagonal(0.5 / 12 * 2, 0.5 / 12 * 1.25, 0.5 / 12 * 1.25);  // 0.5 x 1 x 1
    const MassProperties both = combined({0.5, {0.25, 0, 0}, half}, {0.5, {0.75, 0, 0}, half});
    CHECK(both.mass == 1);
    CHECK(both.center == Vec3{0.5, 0, 0});
    CHECK(largest_difference(both.inertia, Mat3::diagonal(1.0 / 6, 1.0 / 6, 1.0 / 6)) < 1e-16);
}

TEST_CASE("mass and shapes: the shapes' inertia, scaled; a given centre takes precedence")
{
    RigidFixture body;
    REQUIRE(body.mass(4).with({0}).prepare() == "accepted");
    CHECK(body.bodies.mass[0] == 4);
    CHECK(body.bodies.center_B[0] == Vec3{2, 0, 0});
    CHECK(body.bodies.inertia_B[0](0, 0) == doctest::Approx(8.0 / 3).epsilon(1e-15));
    REQUIRE(body.center({}).prepare() == "accepted");
    CHECK(body.bodies.center_B[0] == Vec3{});
}

TEST_CASE("invalid masses are refused by name")
{
    const auto refusal = [](double m) { return RigidFixture().mass(m).with({0}).prepare(); };
    CHECK(refusal(0) == "mass must be positive: give mass (kg), or density (kg/m^3) and shapes");
    CHECK(refusal(-1) == "mass must be positive, not -1");
    CHECK(refusal(kNan) == "mass must be positive, not nan");
    CHECK(refusal(kInfinity) == "mass must lie between 1e-100 and 1e+100, not inf");
    CHECK(refusal(1e-310) == "mass must lie between 1e-100 and 1e+100, not 1e-310");
    CHECK(RigidFixture().density(-2).with({0}).prepare() == "density must be positive, not -2");
}

TEST_CASE("contradictory or insufficient sources are refused by name")
{
    CHECK(RigidFixture().mass(1).density(1).with({0}).prepare() == "mass and density are both given; one of them must be left out");
    CHECK(RigidFixture().density(1).prepare() == "density needs shapes to fill; give a shape, or mass and inertia");
    CHECK(RigidFixture().density(1).inertia(Mat3::identity()).with({0}).prepare() ==
          "inertia is given with density; give mass with inertia, or leave the inertia to the shapes");
    CHECK(RigidFixture().mass(1).prepare() == "mass needs an inertia, or shapes to compute it from");
    CHECK(RigidFixture().mass(1).with({0, 2}).prepare() ==
          "mass properties cannot be computed from its shapes: a plane is unbounded and has no volume; give mass and "
          "inertia");
    CHECK(RigidFixture().mass(1).inertia(Mat3::identity()).center({kInfinity, 0, 0}).prepare() == "center_of_mass must be finite");
}

TEST_CASE("physically impossible inertias are refused by name")
{
    const auto refusal = [](const Mat3& i) { return RigidFixture().mass(1).inertia(i).prepare(); };
    CHECK(refusal(Mat3::diagonal(1, 0, 1)) == "inertia must be positive; its principal moments are 0, 1, 1 kg m^2");
    CHECK(refusal(Mat3::diagonal(1, 1, -1)) == "inertia must be positive; its principal moments are -1, 1, 1 kg m^2");
    CHECK(refusal(Mat3::diagonal(1, 2, 3.5)) ==
          "inertia violates the triangle inequality: the two smaller moments must add up to the largest or more; its "
          "principal moments are 1, 2, 3.5 kg m^2");
    CHECK(refusal(turned(Mat3::diagonal(1, 2, 3.5), {1, 2, 3})).find("triangle inequality") != std::string::npos);
    CHECK(refusal(Mat3::diagonal(1, 1, 1e-310)).find("inertia is too small or too large to be inverted") == 0);
    CHECK(refusal(Mat3::diagonal(1, kNan, 1)) == "inertia must be finite");
    CHECK(refusal({{{1, 0.1, 0}, {0.2, 1, 0}, {0, 0, 1}}}) == "inertia must be symmetric");
    CHECK(refusal(turned(Mat3::diagonal(1, 1, 1e-20), {1, 2, 3})) != "accepted");
}

TEST_CASE("degenerate but possible inertias are accepted")
{
    const auto verdict = [](const Mat3& i) { return RigidFixture().mass(1).inertia(i).prepare(); };
    CHECK(verdict(Mat3::diagonal(1, 1, 2)) == "accepted");                     // a disc
    CHECK(verdict(turned(Mat3::diagonal(1, 1, 2), {1, 2, 3})) == "accepted");  // and rotated
    CHECK(verdict(Mat3::diagonal(1, 1, 1e-12)) == "accepted");                 // a rod
    CHECK(verdict(turned(Mat3::diagonal(1, 1, 1e-12), {1, 2, 3})) == "accepted");
    CHECK(verdict(Mat3::diagonal(1, 1, 1 + 1e-14)) == "accepted");  // nearly equal moments
    RigidFixture rod;
    REQUIRE(rod.mass(1).inertia(Mat3::diagonal(1, 1, 1e-12)).prepare() == "accepted");
    CHECK(rod.bodies.inverse_inertia_B[0] == Mat3::diagonal(1, 1, 1 / 1e-12));
}

TEST_CASE("principal moments of turned matrices")
{
    const auto moments = principal_moments(turned(Mat3::diagonal(3, 1, 2), {0.4, -1.1, 2}));
    CHECK(moments[0] == doctest::Approx(1).epsilon(1e-15));
    CHECK(moments[1] == doctest::Approx(2).epsilon(1e-15));
    CHECK(moments[2] == doctest::Approx(3).epsilon(1e-15));
    const auto equal = principal_moments({{{2, 1, 1}, {1, 2, 1}, {1, 1, 2}}});
    CHECK(equal[0] == doctest::Approx(1).epsilon(1e-15));
    CHECK(equal[1] == doctest::Approx(1).epsilon(1e-15));
    CHECK(equal[2] == doctest::Approx(4).epsilon(1e-15));
}

TEST_CASE("static and kinematic bodies have no inverse mass")
{
    Bodies bodies = make_bodies(1);
    Materials materials;
    bodies.inverse_mass[0] = 5;
    TableFixture<StaticRows> fixed;
    fixed.rows.body.shape[0] = {{Facet::Shape, 4}};
    prepare_static(fixed.context(), 0, fixed.rows, bodies, materials);
    CHECK(bodies.motion[0] == Motion::Static);
    CHECK(bodies.inverse_mass[0] == 0);
    CHECK(bodies.inverse_inertia_B[0] == Mat3{});
    CHECK(bodies.shapes[0] == RefList{{Facet::Shape, 4}});
    CHECK(fixed.schema.find_field("linear_velocity") == nullptr);

    TableFixture<KinematicRows> moved;
    prepare_kinematic(moved.context(), 0, moved.rows, bodies, materials);
    CHECK(bodies.motion[0] == Motion::Kinematic);
    CHECK(bodies.inverse_mass[0] == 0);
    CHECK(moved.schema.find_field("linear_velocity")->hosted);
    CHECK(moved.schema.find_role("solver")->family == "Solver/");
}

TEST_CASE("a shaft's axle has its z along the axis, by the shortest rotation")
{
    CHECK(rotation_from_z({0, 0, 1}) == Quat{});
    CHECK(rotation_from_z({0, 0, -1}) == Quat{0, 1, 0, 0});
    for (const Vec3& d :
         {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{1, 2, 3}, Vec3{1, 2, -3}, Vec3{1e-9, 0, -1}, Vec3{0, 1e-9, 1}, Vec3{-1, 1, -1e-12}})
    {
        const Vec3 axis = normalized(d);
        const Quat q = rotation_from_z(axis);
        CAPTURE(axis.z);
        CHECK(length(rotate(q, {0, 0, 1}) - axis) < 1e-15);
        CHECK(norm(q) == doctest::Approx(1).epsilon(1e-15));
        CHECK(q.z == 0);  // no twist: the rotation is about an axis perpendicular to z
        CHECK(q.w >= 0);
    }
}

TEST_CASE("shafts: an inertia is needed unless the speed is prescribed")
{
    TableFixture<ShaftRows> table;
    Shafts shafts = make_shafts(1);
    const auto prepare = [&](double inertia, bool prescribed)
    {
        table.rows.inertia[0] = inertia, table.rows.prescribed[0] = prescribed;
        return reason_of(prepare_shaft(table.context(), 0, table.rows, shafts));
    };
    table.rows.position[0] = {1, 2, 3};
    table.rows.axis[0] = {0, 1, 0};
    CHECK(prepare(4, false) == "accepted");
    CHECK(shafts.motion[0] == Motion::Dynamic);
    CHECK(shafts.inverse_inertia[0] == 0.25);
    CHECK(shafts.axle[0].p == Vec3{1, 2, 3});
    CHECK(length(shafts.axis_W(0) - Vec3{0, 1, 0}) < 1e-15);
    CHECK(prepare(0, false) == "inertia must be positive, not 0");
    CHECK(prepare(-3, false) == "inertia must be positive, not -3");
    CHECK(prepare(-3, true) == "inertia must be positive, not -3");
    CHECK(prepare(kNan, true) == "inertia must be positive, not nan");
    CHECK(prepare(1e-320, false).find("inertia must lie between") == 0);
    CHECK(prepare(4, true) == "accepted");
    CHECK(shafts.motion[0] == Motion::Kinematic);
    CHECK(shafts.inverse_inertia[0] == 0);
    CHECK(prepare(0, true) == "accepted");
}

TEST_CASE("a material pair is given once, in either order")
{
    TableFixture<MaterialPairRows> pairs(2);
    Materials materials;
    pairs.rows.a[0] = "rubber", pairs.rows.b[0] = "ice", pairs.rows.friction[0] = 0.2, pairs.rows.restitution[0] = 0.5;
    pairs.rows.a[1] = "ice", pairs.rows.b[1] = "rubber";
    CHECK(reason_of(connect_material_pair(0, pairs.rows, materials)) == "accepted");
    const SurfaceLaw* law = materials.find_pair(materials.intern("ice"), materials.intern("rubber"));
    REQUIRE(law != nullptr);
    CHECK(law->friction == 0.2);
    CHECK(law->restitution == 0.5);
    CHECK(reason_of(connect_material_pair(1, pairs.rows, materials)) ==
          "materials 'ice' and 'rubber' have a law already; a pair must be given once, in either order");
}

TEST_CASE("the plugin declares its states with the commands of the paper")
{
    Registrar registrar;
    plab_plugin_register(registrar);
    REQUIRE(registrar.types().size() == 7);
    const char* names[] = {"State/Static", "State/Kinematic", "State/RigidBody", "State/Shaft"};
    for (std::size_t i = 0; i < 4; ++i)
    {
        const TypeInfo& type = registrar.types()[i];
        CHECK(type.name == names[i]);
        CHECK(type.facet == (i < 3 ? Facet::Body : Facet::Shaft));
        CHECK(type.family == (i < 3 ? "State/Body" : "State/Shaft"));
        CHECK(type.commands[0].name == "State/Prepare");
        CHECK(type.commands[1].name == "State/Restore");
        CHECK(type.commands[1].phase == Phase::Restore);
    }
    CHECK(registrar.types()[5].commands[0].phase == Phase::Connect);
}
