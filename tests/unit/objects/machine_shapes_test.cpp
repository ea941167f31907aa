/// Cylinder, gear and rotor: mass properties against closed forms, closed meshes, and how wheels fit one another.
#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>

#include "objects/shapes/machine_parts.h"
#include "objects/shapes/primitives.h"
#include "objects/shapes/volume_integration.h"
#include "plab/rotation.h"
#include "table.h"

using namespace plab;
using namespace plab::shapes;
using namespace plab::test;

namespace
{

constexpr double kPi = std::numbers::pi;

/// What the host holds after Prepare and Measure of row 0.
struct Made
{
    Geometry geometry;
    MassProperties solid;
};

Made made(const TableFixture<GearRows>& gears)
{
    Shapes host = make_shapes(1);
    Made out;
    REQUIRE(reason_of(prepare_gear(gears.context(), 0, gears.rows, host)) == "accepted");
    REQUIRE(reason_of(measure_gear(0, gears.rows, out.solid)) == "accepted");
    out.geometry = host.geometry[0];
    return out;
}

Made made(const TableFixture<RotorRows>& rotors)
{
    Shapes host = make_shapes(1);
    Made out;
    REQUIRE(reason_of(prepare_rotor(rotors.context(), 0, rotors.rows, host)) == "accepted");
    REQUIRE(reason_of(measure_rotor(0, rotors.rows, out.solid)) == "accepted");
    out.geometry = host.geometry[0];
    return out;
}

TableFixture<GearRows> gear_table(double pitch_radius, std::int64_t teeth, double width, double bore)
{
    TableFixture<GearRows> out;
    out.rows.pitch_radius[0] = pitch_radius, out.rows.teeth[0] = teeth;
    out.rows.width[0] = width, out.rows.bore[0] = bore;
    return out;
}

TableFixture<RotorRows> rotor_table()
{
    TableFixture<RotorRows> out;
    out.rows.hub_radius[0] = 0.05, out.rows.radius[0] = 0.3, out.rows.blades[0] = 5;
    out.rows.pitch_angle[0] = 0.35, out.rows.width[0] = 0.1;
    return out;
}

/// Distance from the axle to the outline of a gear in the direction `angle`, half way up.
double reach_of(const Geometry& gear, double angle)
{
    const Vec3 direction{std::cos(angle), std::sin(angle), 0}, across{-direction.y, direction.x, 0};
    double out = 0;
    for (std::size_t i = 0; i < gear.triangles.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const Vec3 a = gear.vertices[gear.triangles[i + k]], b = gear.vertices[gear.triangles[i + (k + 1) % 3]];
            const double s = dot(a, across), t = dot(b, across);
            if (a.z != b.z || (s > 0) == (t > 0)) continue;
            const Vec3 crossing = a + (b - a) * (s / (s - t));
            out = std::max(out, dot(crossing, direction));
        }
    return out;
}

/// Distance from a point (z = 0) to a gear's outline, seen along z.
double distance_to_outline(const Geometry& gear, const Vec3& p)
{
    const auto flat = [](const Vec3& v) { return Vec3{v.x, v.y, 0}; };
    double out = 1e9;
    for (std::size_t i = 0; i < gear.triangles.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k)
        {
            const Vec3 va = gear.vertices[gear.triangles[i + k]], vb = gear.vertices[gear.triangles[i + (k + 1) % 3]];
            const Vec3 a = flat(va), b = flat(vb);
            // Edges of the rim: both ends at one height, neither in the middle.
            if (va.z != vb.z || length(a) < 0.05 || length(b) < 0.05) continue;
            const double along = std::clamp(dot(p - a, b - a) / length_squared(b - a), 0.0, 1.0);
            out = std::fmin(out, length(p - a - (b - a) * along));
        }
    return out;
}

}  // namespace

TEST_CASE("a cylinder has the mass properties of the closed form, in its pose")
{
    TableFixture<CylinderRows> table;
    table.rows.radius[0] = 0.2, table.rows.height[0] = 0.7;
    MassProperties solid;
    measure_cylinder(0, table.rows, solid);
    const double mass = kPi * 0.04 * 0.7;
    CHECK(solid.mass == doctest::Approx(mass).epsilon(1e-15));
    CHECK(solid.inertia(2, 2) == doctest::Approx(mass * 0.02).epsilon(1e-15));
    CHECK(solid.inertia(0, 0) == doctest::Approx(mass * (3 * 0.04 + 0.49) / 12).epsilon(1e-15));
    CHECK(solid.inertia(1, 1) == solid.inertia(0, 0));

    table.rows.shape.position[0] = {1, 2, 3};
    table.rows.shape.orientation[0] = exp_rotation({0, kPi / 2, 0});  // z along x
    measure_cylinder(0, table.rows, solid);
    CHECK(solid.center == Vec3{1, 2, 3});
    CHECK(solid.inertia(0, 0) == doctest::Approx(mass * 0.02).epsilon(1e-14));
}

TEST_CASE("a cylinder is passed to the host as a cylinder; one that is only drawn, as a closed mesh inside it")
{
    TableFixture<CylinderRows> table;
    table.rows.radius[0] = 0.2, table.rows.height[0] = 0.7;
    table.rows.shape.position[0] = {0.5, 0, 0};
    Shapes host = make_shapes(1);
    prepare_cylinder(table.context(), 0, table.rows, host);
    const Geometry& g = host.geometry[0];
    CHECK(g.kind == GeometryKind::Cylinder);
    CHECK(g.size.x == 0.2);
    CHECK(g.size.z == 0.35);
    table.rows.hull_collides[0] = false;
    prepare_cylinder(table.context(), 0, table.rows, host);
    CHECK(g.kind == GeometryKind::Mesh);
    CHECK_FALSE(g.hull_collides);
    CHECK(g.pose.p.x == 0.5);
    const auto prism = solid_mesh(g.vertices, g.triangles);
    REQUIRE(prism.ok());
    // A prism of n sides has n/(2 pi) sin(2 pi/n) of the circle's area.
    const double share = 64 / (2 * kPi) * std::sin(2 * kPi / 64);
    CHECK(prism->mass == doctest::Approx(solid_cylinder(0.2, 0.7).mass * share).epsilon(1e-13));
    CHECK(length(prism->center) < 1e-14);
}

TEST_CASE("a gear is a closed mesh between the cylinders of its roots and tips")
{
    for (const std::int64_t teeth : {6, 7, 16, 32, 200})
        for (const double bore : {0.0, 0.05})
        {
            CAPTURE(teeth);
            CAPTURE(bore);
            const Made gear = made(gear_table(0.2, teeth, 0.08, bore));
            CHECK(check_closed(gear.geometry.vertices, gear.geometry.triangles).ok());
            CHECK_FALSE(gear.geometry.hull_collides);
            const double m = 0.4 / static_cast<double>(teeth);
            const double hole = solid_cylinder(0.05, 0.08).mass * (bore > 0 ? 1 : 0);
            CHECK(gear.solid.mass > solid_cylinder(0.2 - 1.25 * m, 0.08).mass - hole);
            CHECK(gear.solid.mass < solid_cylinder(0.2 + m, 0.08).mass - 0.9 * hole);
            // About as much above the pitch circle as below it: near the wheel without teeth.
            if (teeth >= 16 && bore == 0) CHECK(gear.solid.mass == doctest::Approx(solid_cylinder(0.2, 0.08).mass).epsilon(0.08));
            CHECK(length(gear.solid.center) < 1e-15);
            CHECK(gear.solid.inertia(0, 0) == doctest::Approx(gear.solid.inertia(1, 1)).epsilon(1e-12));
        }
}

TEST_CASE("a tooth points along x, from root to tip, with gaps on both sides")
{
    const Made gear = made(gear_table(0.1, 16, 0.08, 0.02));
    const double m = 0.2 / 16, pitch = 2 * kPi / 16;
    for (int i = 0; i < 16; ++i)
    {
        CHECK(reach_of(gear.geometry, i * pitch) == doctest::Approx(0.1 + m).epsilon(0.01));
        CHECK(reach_of(gear.geometry, (i + 0.5) * pitch) == doctest::Approx(0.1 - 1.25 * m).epsilon(0.01));
    }
}

TEST_CASE("two wheels of one module mesh and hardly overlap")
{
    const Made small = made(gear_table(0.1, 16, 0.08, 0)), large = made(gear_table(0.2, 32, 0.08, 0));
    // Axles 0.3 apart along x. The small one points a tooth at the large one, which is turned by half a tooth.
    double deepest = 0, least_room = 1;
    for (double turn = 0; turn < 2 * kPi / 16; turn += 2 * kPi / 16 / 40)
        for (const Vec3& v : large.geometry.vertices)
        {
            const Vec3 in_large = rotate(exp_rotation({0, 0, kPi / 32 - 0.5 * turn}), {v.x, v.y, 0});
            const Vec3 p = rotate(exp_rotation({0, 0, -turn}), in_large + Vec3{0.3, 0, 0});
            if (length(p) > 0.13) continue;
            const double away = distance_to_outline(small.geometry, p);
            if (length(p) < reach_of(small.geometry, std::atan2(p.y, p.x))) deepest = std::fmax(deepest, away);
            least_room = std::fmin(least_room, away);
        }
    // Straight flanks are no involutes, but their overlap is not visible: less than 3 % of a tooth's height (28 mm).
    CHECK(deepest < 8e-4);
    CHECK(least_room < 1e-3);
}

TEST_CASE("a bore as large as the wheel is refused")
{
    auto table = gear_table(0.1, 16, 0.08, 0.09);
    Shapes host = make_shapes(1);
    MassProperties solid;
    const std::string expected = "bore must be less than the radius at the teeth's roots, 0.082";
    CHECK(reason_of(prepare_gear(table.context(), 0, table.rows, host)).starts_with(expected));
    CHECK(reason_of(measure_gear(0, table.rows, solid)).starts_with(expected));
    table.rows.bore[0] = 0.082;
    CHECK(reason_of(prepare_gear(table.context(), 0, table.rows, host)) == "accepted");
}

TEST_CASE("a rotor is closed, balanced about its axle, and has the given width")
{
    const Made rotor = made(rotor_table());
    CHECK(check_closed(rotor.geometry.vertices, rotor.geometry.triangles).ok());
    double widest = 0;
    for (const Vec3& v : rotor.geometry.vertices) widest = std::fmax(widest, std::sqrt(v.x * v.x + v.y * v.y));
    CHECK(widest == doctest::Approx(0.3).epsilon(1e-12));
    CHECK(std::fabs(rotor.solid.center.x) < 1e-12);
    CHECK(std::fabs(rotor.solid.center.y) < 1e-12);
    CHECK(rotor.solid.inertia(0, 0) == doctest::Approx(rotor.solid.inertia(1, 1)).epsilon(1e-10));
    CHECK(std::fabs(rotor.solid.inertia(0, 2)) < 1e-12);
    // More than its hub without the nose, less than a full disc.
    CHECK(rotor.solid.mass > solid_cylinder(0.05, 0.05).mass);
    CHECK(rotor.solid.mass < solid_cylinder(0.3, 0.1).mass);

    auto bladeless = rotor_table();
    bladeless.rows.blades[0] = 1;
    const double blade = (rotor.solid.mass - made(bladeless).solid.mass) / 4;
    CHECK(blade > 0.02 * 0.1 * 0.25 * 0.1);  // thin, but solid
    CHECK(blade < 0.15 * 0.1 * 0.25 * 0.1);
}

TEST_CASE("a rotor's blades are right-handed: their leading faces look to -z")
{
    const Made rotor = made(rotor_table());
    // Turning positively, a face with normal n at p moves along z x p. Those that push (against the motion's rear) weigh
    // the air down: the sum over blade faces ahead of area * n.z is negative.
    double pushed = 0;
    for (std::size_t i = 0; i < rotor.geometry.triangles.size(); i += 3)
    {
        const Vec3 a = rotor.geometry.vertices[rotor.geometry.triangles[i]], b = rotor.geometry.vertices[rotor.geometry.triangles[i + 1]],
                   c = rotor.geometry.vertices[rotor.geometry.triangles[i + 2]];
        const Vec3 n = cross(b - a, c - a), middle = (a + b + c) / 3;
        if (std::sqrt(middle.x * middle.x + middle.y * middle.y) < 0.06) continue;
        const double ahead = dot(n, cross(Vec3{0, 0, 1}, middle));
        if (ahead > 0) pushed += ahead * n.z;
    }
    CHECK(pushed < 0);
}

TEST_CASE("rotors that cannot be built are refused")
{
    const auto refusal = [](const TableFixture<RotorRows>& table)
    {
        Shapes host = make_shapes(1);
        MassProperties solid;
        const std::string why = reason_of(prepare_rotor(table.context(), 0, table.rows, host));
        CHECK(reason_of(measure_rotor(0, table.rows, solid)) == why);
        return why;
    };
    auto table = rotor_table();
    table.rows.radius[0] = 0.05;
    CHECK(refusal(table) == "radius must be more than hub_radius, so that the blades extend beyond the hub");
    table = rotor_table();
    table.rows.pitch_angle[0] = 1.3;
    CHECK(refusal(table) == "pitch_angle must be less than 1.2 rad");
    table = rotor_table();
    table.rows.blades[0] = 40;
    CHECK(refusal(table) == "the blades do not fit on the hub; use fewer blades, a smaller width or a larger hub_radius");
}
