// Mass, centre and inertia of imported bodies, against sums over many small cubes or closed forms that are computed here.
#include <filesystem>
#include <fstream>
#include <numbers>

#include "unit/import/imported.h"

namespace plab::test
{
namespace
{

using import::SceneFormat;

struct Solid
{
    double mass;
    Vec3 center;
    Mat3 inertia;
};

/// Of points with masses: an independent way to the parallel-axis theorem.
struct Points
{
    double m = 0;
    Vec3 first;
    Mat3 second;

    void add(double mass, const Vec3& p)
    {
        m += mass, first += p * mass;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) second(i, j) += mass * p[i] * p[j];
    }
    /// Six points at +-a along the columns of R around c: the smallest set that has the moments of a body.
    void add_body(double mass, const Vec3& c, const Vec3& moments, const Mat3& R)
    {
        const double half = (moments.x + moments.y + moments.z) / 2;
        for (int k = 0; k < 3; ++k)
        {
            const double a = std::sqrt(3 * (half - moments[k]) / mass);
            const Vec3 axis{R(0, k), R(1, k), R(2, k)};
            add(mass / 6, c + axis * a), add(mass / 6, c - axis * a);
        }
    }
    Solid solid() const
    {
        const Vec3 c = first / m;
        Mat3 M = second - outer(c, c) * m;
        return {m, c, Mat3::identity() * (M(0, 0) + M(1, 1) + M(2, 2)) - M};
    }
};

void check_solid(const Scene& scene, const std::string& id, const Solid& expected)
{
    CHECK(scene.real(id, "mass") == doctest::Approx(expected.mass).epsilon(1e-12));
    CHECK(distance(scene.vec(id, "center_of_mass"), expected.center) < 1e-12);
    const Mat3 I = std::get<Mat3>(scene.get(id, "inertia"));
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) CHECK(std::fabs(I(i, j) - expected.inertia(i, j)) < 1e-12 * std::fabs(expected.inertia(0, 0)) + 1e-14);
}

Mat3 turn_z(double a) { return {{{std::cos(a), -std::sin(a), 0}, {std::sin(a), std::cos(a), 0}, {0, 0, 1}}}; }
Mat3 turn_y(double a) { return {{{std::cos(a), 0, std::sin(a)}, {0, 1, 0}, {-std::sin(a), 0, std::cos(a)}}}; }
Mat3 turn_x(double a) { return {{{1, 0, 0}, {0, std::cos(a), -std::sin(a)}, {0, std::sin(a), std::cos(a)}}}; }

TEST_CASE("a link of URDF with a turned inertia, and a second one fixed to it, are one body")
{
    const auto imported = imported_text(R"(<robot name="r"><link name="a"><inertial><origin xyz="0.1 -0.2 0.3" rpy="0.4 -0.5 0.6"/>
        <mass value="3"/><inertia ixx="0.2" iyy="0.3" izz="0.4" ixy="0" ixz="0" iyz="0"/></inertial></link>
      <link name="b"><inertial><origin xyz="0 0 0.5" rpy="0 0.3 0"/><mass value="2"/>
        <inertia ixx="0.1" iyy="0.15" izz="0.2" ixy="0" ixz="0" iyz="0"/></inertial></link>
      <joint name="j" type="fixed"><parent link="a"/><child link="b"/><origin xyz="1 2 3" rpy="0.1 0.2 0.3"/></joint></robot>)",
                                        SceneFormat::Urdf);
    CHECK(imported.bodies == 1);
    Points points;
    points.add_body(3, {0.1, -0.2, 0.3}, {0.2, 0.3, 0.4}, turn_z(0.6) * turn_y(-0.5) * turn_x(0.4));
    const Mat3 R = turn_z(0.3) * turn_y(0.2) * turn_x(0.1);
    points.add_body(2, Vec3{1, 2, 3} + R * Vec3{0, 0, 0.5}, {0.1, 0.15, 0.2}, R * turn_y(0.3));
    check_solid(imported_scene(imported), "a", points.solid());
}

TEST_CASE("a body of MJCF gets mass and inertia from its shapes")
{
    const auto imported = imported_text(R"(<mujoco><compiler eulerseq="XYZ"/><worldbody><body name="a" pos="0 0 1"><freejoint/>
      <geom type="box" size="0.1 0.2 0.3" pos="0.5 0 0" euler="90 0 45"/>
      <geom type="sphere" size="0.2" pos="-0.3 0.1 0" mass="4"/>
      <geom type="ellipsoid" size="0.1 0.2 0.3" density="500"/>
      <geom type="cylinder" size="0.1" fromto="0 0 0 0 1 0" density="100"/></body></worldbody></mujoco>)",
                                        SceneFormat::Mjcf);
    const double pi = std::numbers::pi;
    Points points;
    const double box = 8 * 0.1 * 0.2 * 0.3 * 1000;
    points.add_body(box, {0.5, 0, 0}, Vec3{0.04 + 0.09, 0.01 + 0.09, 0.01 + 0.04} * (box / 3), turn_z(pi / 4) * turn_x(pi / 2));
    points.add_body(4, {-0.3, 0.1, 0}, Vec3{1, 1, 1} * (0.4 * 4 * 0.04), Mat3::identity());
    const double ellipsoid = 4.0 / 3 * pi * 0.006 * 500;
    points.add_body(ellipsoid, {}, Vec3{0.13, 0.10, 0.05} * (ellipsoid / 5), Mat3::identity());
    const double cylinder = pi * 0.01 * 100, across = cylinder * (3 * 0.01 + 1) / 12;
    points.add_body(cylinder, {0, 0.5, 0}, {across, across, cylinder * 0.005}, turn_x(pi / 2));
    check_solid(imported_scene(imported), "a", points.solid());
}

TEST_CASE("fullinertia, defaults of nested classes, and an orientation by axes")
{
    const auto imported = imported_text(R"(<mujoco><default><geom density="100"/><default class="heavy"><geom density="7000" type="box"
      size="0.1 0.1 0.1"/></default></default><worldbody>
      <body name="full" pos="0 0 1"><freejoint/><inertial pos="0.1 0 0" mass="2" fullinertia="0.3 0.4 0.5 0.01 0.02 0.03"/></body>
      <body name="heavy" pos="3 0 1" childclass="heavy"><freejoint/><geom pos="0.1 0 0" xyaxes="0 1 0 -1 0 0"/></body>
      <body name="light" pos="6 0 1"><freejoint/><geom size="0.1"/></body></worldbody></mujoco>)",
                                        SceneFormat::Mjcf);
    const Scene scene = imported_scene(imported);
    check_solid(scene, "full", {2, {0.1, 0, 0}, {{{0.3, 0.01, 0.02}, {0.01, 0.4, 0.03}, {0.02, 0.03, 0.5}}}});
    const double m = 56;
    check_solid(scene, "heavy", {m, {0.1, 0, 0}, Mat3::identity() * (m * 0.02 / 3)});
    CHECK(scene.real("light", "mass") == doctest::Approx(4.0 / 3 * std::numbers::pi * 0.001 * 100));
}

TEST_CASE("meshes: STL and OBJ with scale, mass by their volume; a missing one is listed")
{
    namespace fs = std::filesystem;
    const fs::path folder = fs::path(PLAB_BINARY_DIR) / "tests/unit/import/pack/meshes";
    fs::create_directories(folder);
    std::ofstream(folder / "tetra.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    std::ofstream(folder / "tetra.stl")
        << "solid t\n"
           "facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
           "facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
           "facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nendloop\nendfacet\n"
           "facet normal 1 1 1\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid t\n";
    for (const std::string file : {"tetra.obj", "tetra.stl"})
    {
        const auto imported = import_robot("<mujoco><compiler meshdir='meshes'/><asset><mesh name='m' file='" + file +
                                               "' scale='1 2 -3'/></asset><worldbody><body name='a'><freejoint/>"
                                               "<geom type='mesh' mesh='m'/></body></worldbody></mujoco>",
                                           SceneFormat::Mjcf, (folder.parent_path() / "m.mjcf").string());
        REQUIRE_MESSAGE(imported.ok(), reasons(imported));
        const Scene scene = imported_scene(*imported);
        CHECK(scene.real("a", "mass") == doctest::Approx(1000));
        CHECK(distance(scene.vec("a", "center_of_mass"), {0.25, 0.5, -0.75}) < 1e-6);
    }
    const std::string link =
        "<robot name='r'><link name='a'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial>"
        "<visual><geometry><mesh filename='package://pack/meshes/";
    const std::string file = (folder / "robot.urdf").string();
    const auto found = import_robot(link + "tetra.stl'/></geometry></visual></link></robot>", SceneFormat::Urdf, file);
    REQUIRE(found.ok());
    CHECK(found->blueprint.find("Shape/Mesh") != std::string::npos);
    CHECK(found->losses.empty());
    // What never moves collides as its triangles, unless these are convex; in MJCF as its hull.
    std::ofstream(folder / "tent.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\n";
    const auto fixed = [&](const std::string& mesh, SceneFormat format)
    {
        const std::string collision = "<collision name='c'><geometry><mesh><uri>meshes/" + mesh + "</uri></mesh></geometry></collision>";
        const std::string sdf =
            "<sdf version='1.9'><model name='m'><static>true</static><link name='a'>" + collision + "</link></model></sdf>";
        const std::string mjcf = "<mujoco><compiler meshdir='meshes'/><asset><mesh name='m' file='" + mesh +
                                 "'/></asset><worldbody><geom type='mesh' mesh='m'/></worldbody></mujoco>";
        const auto imported = import_robot(format == SceneFormat::Sdf ? sdf : mjcf, format, (folder.parent_path() / "m").string());
        REQUIRE_MESSAGE(imported.ok(), reasons(imported));
        return imported->blueprint.find("surface_collides=\"true\"") != std::string::npos;
    };
    CHECK(fixed("tent.obj", SceneFormat::Sdf));
    CHECK_FALSE(fixed("tetra.obj", SceneFormat::Sdf));
    CHECK_FALSE(fixed("tent.obj", SceneFormat::Mjcf));
    const auto missing = import_robot(link + "gone.stl'/></geometry></visual></link></robot>", SceneFormat::Urdf, file);
    REQUIRE(missing.ok());
    CHECK(lists(*missing, "gone.stl' is missing"));
}

}  // namespace
}  // namespace plab::test
