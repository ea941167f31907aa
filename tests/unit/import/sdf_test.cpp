// SDF: frames against products of matrices, masses, joints, worlds, files, and what is refused or listed.
#include <filesystem>
#include <fstream>
#include <numbers>

#include "unit/import/imported.h"
#include "unit/import/pendulum.h"

namespace plab::test
{
namespace
{

using import::SceneFormat;

constexpr const char* kMassOfOne = "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>";

std::string model_of(const std::string& inside) { return "<sdf version='1.9'><model name='m'>" + inside + "</model></sdf>"; }
std::string world_of(const std::string& inside) { return "<sdf version='1.9'><world name='w'>" + inside + "</world></sdf>"; }
std::string link_of(const std::string& name, const std::string& pose = "", const std::string& more = "")
{
    return "<link name='" + name + "'>" + pose + kMassOfOne + more + "</link>";
}

/// A rotation and a translation as matrix and vector: an independent way to what poses mean.
struct Placement
{
    Mat3 R = Mat3::identity();
    Vec3 p;

    static Placement of(double x, double y, double z, double roll, double pitch, double yaw)
    {
        const Mat3 Rx{{{1, 0, 0}, {0, std::cos(roll), -std::sin(roll)}, {0, std::sin(roll), std::cos(roll)}}};
        const Mat3 Ry{{{std::cos(pitch), 0, std::sin(pitch)}, {0, 1, 0}, {-std::sin(pitch), 0, std::cos(pitch)}}};
        const Mat3 Rz{{{std::cos(yaw), -std::sin(yaw), 0}, {std::sin(yaw), std::cos(yaw), 0}, {0, 0, 1}}};
        return {Rz * Ry * Rx, {x, y, z}};
    }
    Placement operator*(const Placement& b) const { return {R * b.R, p + R * b.p}; }
    Placement inverted() const { return {transposed(R), -(transposed(R) * p)}; }
};

void check_placed(const Scene& scene, const std::string& id, const Placement& expected)
{
    CHECK(distance(scene.vec(id, "position"), expected.p) < 1e-12);
    const Mat3 R = rotation_matrix(scene.quat(id, "orientation"));
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) CHECK(std::fabs(R(i, j) - expected.R(i, j)) < 1e-12);
}

TEST_CASE("links and frames are placed relative to what their poses name, also in models within models")
{
    const auto imported = imported_text(
        world_of("<frame name='hill'><pose>1 2 3 0.1 0.2 0.3</pose></frame><model name='m'><pose relative_to='hill'>0 0 1 0 0 0.5</pose>" +
                 link_of("a", "<pose>0.5 0 0 0.4 0 0</pose>") + link_of("b", "<pose relative_to='mark'>0 1 0 0 0.3 0</pose>") +
                 "<frame name='mark' attached_to='a'><pose>0 0 2 0 0 0.7</pose></frame><model name='inner'><pose relative_to='b'>3 0 0 0 "
                 "0 0.2</pose>" +
                 link_of("c", "<pose>0 0 1 0.1 0 0</pose>") + "</model></model>"),
        SceneFormat::Sdf);
    CHECK(imported.losses.empty());
    const Scene scene = imported_scene(imported);
    const Placement model = Placement::of(1, 2, 3, 0.1, 0.2, 0.3) * Placement::of(0, 0, 1, 0, 0, 0.5);
    const Placement a = model * Placement::of(0.5, 0, 0, 0.4, 0, 0);
    const Placement b = a * Placement::of(0, 0, 2, 0, 0, 0.7) * Placement::of(0, 1, 0, 0, 0.3, 0);
    check_placed(scene, "m::a", a), check_placed(scene, "m::b", b);
    check_placed(scene, "m::inner::c", b * Placement::of(3, 0, 0, 0, 0, 0.2) * Placement::of(0, 0, 1, 0.1, 0, 0));
}

TEST_CASE("a placement frame is what the model's pose places; angles in degrees and quaternions")
{
    const auto imported =
        imported_text(world_of("<model name='m' placement_frame='grip'><pose degrees='true'>1 0 0 0 0 90</pose>" +
                               link_of("a", "<pose rotation_format='quat_xyzw'>0 0 1 0 0 0.7071067811865476 0.7071067811865476</pose>") +
                               "<frame name='grip' attached_to='a'><pose>0 2 0 0.3 0 0</pose></frame></model>"),
                      SceneFormat::Sdf);
    const double right = std::numbers::pi / 2;
    const Placement a = Placement::of(0, 0, 1, 0, 0, right), grip = a * Placement::of(0, 2, 0, 0.3, 0, 0);
    check_placed(imported_scene(imported), "m::a", Placement::of(1, 0, 0, 0, 0, right) * grip.inverted() * a);
}

TEST_CASE("the period of a pendulum from SDF is that of the closed form, to 1e-6")
{
    // The axis is written in the frame of the world's link, the joint's own frame is turned, and the version's default is the model's.
    for (const char* const axis : {"<xyz expressed_in='__model__'>0 1 0</xyz>", "<xyz>0 0 1</xyz>"})
    {
        const auto imported = imported_text(
            world_of("<gravity>0 0 -9.81</gravity><physics><max_step_size>0.002</max_step_size></physics><model name='p'><link name='bob'>"
                     "<pose>0 0 2 0 1 0</pose><inertial><pose>0 0 -0.5 0 0 0</pose><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy>"
                     "<izz>0.01</izz></inertia></inertial></link><joint name='pivot' type='continuous'><pose>0 0 0 -1.5707963267948966 0 0"
                     "</pose><parent>world</parent><child>bob</child><axis>" +
                     std::string(axis) + "</axis></joint></model>"),
            SceneFormat::Sdf);
        CHECK(imported.losses.empty());
        Scene scene = imported_scene(imported);
        CHECK(scene.simulation().dt() == 0.002);
        CHECK(std::fabs(period_of(scene, "p::bob") / expected_period() - 1) < 1e-6);
    }
}

TEST_CASE("up to version 1.4 axes are meant in the model's frame")
{
    const auto axis_of = [](const std::string& version)
    {
        const auto imported = imported_text("<sdf version='" + version + "'><model name='m'>" + link_of("a") +
                                                link_of("b", "<pose>0 0 0 0 0 1.5707963267948966</pose>") +
                                                "<joint name='j' type='revolute'><parent>a</parent><child>b</child><axis><xyz>1 0 0</xyz>"
                                                "</axis></joint></model></sdf>",
                                            SceneFormat::Sdf);
        return imported_scene(imported).vec("j", "axis");
    };
    CHECK(distance(axis_of("1.4"), {1, 0, 0}) < 1e-12);
    CHECK(distance(axis_of("1.6"), {0, 1, 0}) < 1e-12);
}

TEST_CASE("a screw travels along its axis: m in a turn, or rad/m of a left-handed thread as before SDF 1.10")
{
    const auto screw = [](const std::string& pitch)
    {
        const auto imported = imported_text(
            model_of(link_of("a") + link_of("b", "<pose>0 0 1 0 0 0</pose>") +
                     "<joint name='s' type='screw'><parent>a</parent><child>b</child>" + pitch + "<axis><xyz>0 0 1</xyz></axis></joint>"),
            SceneFormat::Sdf);
        return imported_scene(imported).real("s", "lead");
    };
    CHECK(screw("<screw_thread_pitch>0.002</screw_thread_pitch>") == 0.002);
    CHECK(screw("<thread_pitch>-3141.592653589793</thread_pitch>") == doctest::Approx(0.002));
}

TEST_CASE("a universal joint has two axes, and limits of each")
{
    const auto imported = imported_text(
        model_of(link_of("a") + link_of("b", "<pose>0 0 1 0 0 0</pose>") +
                 "<joint name='u' type='universal'><parent>a</parent><child>b</child><axis><xyz>1 0 0</xyz><limit><lower>-0.1</lower>"
                 "<upper>0.2</upper></limit></axis><axis2><xyz>0 1 0</xyz></axis2></joint>"),
        SceneFormat::Sdf);
    CHECK(lists(imported, "'b' moves by several joints"));
    const Scene scene = imported_scene(imported);
    CHECK(scene.vec("u", "axis") == Vec3{1, 0, 0});
    CHECK(scene.vec("u.2", "axis") == Vec3{0, 1, 0});
    CHECK(scene.real("u.limit", "upper") == 0.2);
}

TEST_CASE("joints that close a loop hold: a four-bar linkage keeps its bars together")
{
    const auto bar = [](const std::string& name, const std::string& pose)
    {
        return "<link name='" + name + "'><pose>" + pose +
               "</pose><inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial></link>";
    };
    const auto hinge = [](const std::string& name, const std::string& parent, const std::string& child, const std::string& pose)
    {
        return "<joint name='" + name + "' type='revolute'><pose relative_to='__model__'>" + pose + "</pose><parent>" + parent +
               "</parent><child>" + child + "</child><axis><xyz>0 1 0</xyz></axis></joint>";
    };
    const auto imported =
        imported_text(model_of(bar("left", "0 0 0.5 0 0 0") + bar("top", "0.5 0 1 0 0 0") + bar("right", "1 0 0.5 0 0 0") +
                               hinge("j1", "world", "left", "0 0 0 0 0 0") + hinge("j2", "left", "top", "0 0 1 0 0 0") +
                               hinge("j3", "top", "right", "1 0 1 0 0 0") + hinge("j4", "world", "right", "1 0 0 0 0 0")),
                      SceneFormat::Sdf);
    CHECK(imported.joints == 4);
    Scene scene = imported_scene(imported);
    scene.run(1);
    CHECK(std::fabs(scene.real("j1", "angle")) > 0.0);
    const Vec3 corner = scene.vec("right", "position") + rotate(scene.quat("right", "orientation"), {0, 0, -0.5});
    CHECK(distance(corner, {1, 0, 0}) < 1e-9);
}

TEST_CASE("static models do not move, links without gravity stay in the air, and a world has its own gravity")
{
    const auto imported = imported_text(
        world_of("<gravity>0 0 -2</gravity><model name='ground'><static>true</static><link name='l'><collision name='c'><geometry><plane>"
                 "<normal>0 0 1</normal></plane></geometry></collision></link></model><model name='balloon'><pose>0 0 5 0 0 0</pose>" +
                 link_of("l", "", "<gravity>false</gravity>") + "</model><model name='stone'><pose>3 0 9 0 0 0</pose>" + link_of("l") +
                 "</model>"),
        SceneFormat::Sdf);
    CHECK(imported.losses.empty());
    Scene scene = imported_scene(imported);
    scene.run(1);
    CHECK(scene.vec("balloon::l", "position").z == 5);
    CHECK(scene.vec("stone::l", "position").z == doctest::Approx(8));
    CHECK(imported.blueprint.find("id=\"ground::l\" type=\"State/Static\"") != std::string::npos);
}

TEST_CASE("models are included from the folders of --import-path, with a name and a pose of their own")
{
    namespace fs = std::filesystem;
    const fs::path folder = fs::path(PLAB_BINARY_DIR) / "tests/unit/import/models/crate";
    fs::create_directories(folder);
    std::ofstream(folder / "model.config")
        << "<model><name>crate</name><sdf version='1.6'>old.sdf</sdf><sdf version='1.9'>crate.sdf</sdf></model>";
    std::ofstream(folder / "crate.sdf") << model_of("<pose>9 9 9 0 0 0</pose>" + link_of("body") + "<plugin name='p'/>");
    const std::string text = world_of(
        "<include><uri>model://crate</uri><name>one</name><pose>1 0 0 0 0 0</pose></include>"
        "<include><uri>model://crate</uri><name>two</name><static>true</static></include>");
    const auto imported = import::import_text(text, "world", SceneFormat::Sdf, {false, {folder.parent_path().string()}});
    REQUIRE_MESSAGE(imported.ok(), reasons(imported));
    const Scene scene = imported_scene(*imported);
    CHECK(scene.vec("one::body", "position") == Vec3{1, 0, 0});
    CHECK(imported->blueprint.find("two::body") == std::string::npos);  // static, and nothing of it can be seen
    CHECK(lists(*imported, "crate.sdf:1:"));
    CHECK(lists(*imported, "<plugin> 'p': is not carried over"));
    const auto without = import_robot(text, SceneFormat::Sdf);
    CHECK(reasons(without).find("there is no 'model://crate': name the folder that holds it with --import-path") != std::string::npos);
}

TEST_CASE("the ball of gate.world opens the gate, and the lamp hangs on")
{
    const auto imported = imported_file("gate.world");
    CHECK(imported.losses.size() == 1);
    CHECK(lists(imported, "'lamp::shade' moves by several joints"));
    Scene scene = imported_scene(imported);
    CHECK(scene.simulation().dt() == 0.002);
    CHECK(scene.real("ball::ball", "mass") == doctest::Approx(4.0 / 3 * std::numbers::pi * 0.027 * 60));
    // Along the road, which is turned by 0.3 rad.
    CHECK(scene.ask(simulation::SetOperation{"ball::ball", "linear_velocity", Value(Vec3{2.5 * std::cos(0.3), 2.5 * std::sin(0.3), 0})})
              .done);
    double widest = 0;
    while (scene.simulation().time() < 2) scene.step(), widest = std::fmax(widest, std::fabs(scene.real("swing::hinge", "angle")));
    CHECK(widest > 0.3);
    CHECK(widest < 1.5 + 1e-2);
    CHECK(distance(scene.vec("lamp::shade", "position"), {1.5, -1, 1.6}) < 1e-6);
}

TEST_CASE("mass by density of the collisions")
{
    const auto imported = imported_text(
        model_of("<link name='a'><inertial auto='true'><density>500</density></inertial><collision name='c'><pose>0 0 0.1 0 0 0</pose>"
                 "<geometry><box><size>0.2 0.4 0.6</size></box></geometry></collision></link>"),
        SceneFormat::Sdf);
    const Scene scene = imported_scene(imported);
    CHECK(scene.real("a", "mass") == doctest::Approx(24));
    CHECK(scene.vec("a", "center_of_mass") == Vec3{0, 0, 0.1});
}

TEST_CASE("faulty SDF is refused with its place and a reason")
{
    const auto check = [](const std::string& text, const std::string& message)
    { CHECK(reasons(import_robot(text, SceneFormat::Sdf)).find(message) != std::string::npos); };
    check("<sdf version='1.9'/>", "robot:1:1: <sdf>: has neither a <world> nor a <model>");
    check("<robot/>", "robot:1:1: <robot>: is not the root of SDF, which is <sdf>");
    check(model_of(link_of("a") + link_of("a")), "<link> 'a': there are two frames of this name");
    check(model_of("<link name='a'><pose>1 2</pose></link>"), "<pose>: its text needs 6 numbers, not '1 2'");
    check(model_of(link_of("a", "<pose relative_to='f'/>") + "<frame name='f'><pose relative_to='a'/></frame>"),
          "its pose depends on itself");
    check(model_of(link_of("a", "<pose relative_to='gone'/>")), "<link> 'a': there is no frame 'gone' in 'm'");
    check(model_of(link_of("a") + "<joint name='j' type='bendy'><parent>world</parent><child>a</child></joint>"), "not 'bendy'");
    check(model_of(link_of("a") + "<joint name='j' type='fixed'><parent>world</parent><child>b</child></joint>"), "there is no frame 'b'");
    check(model_of("<link name='a'><inertial><mass>-1</mass></inertial></link>"), "mass must be positive, not -1");
    check(world_of("<include><uri>model://gone</uri></include>"), "there is no 'model://gone'");
}

}  // namespace
}  // namespace plab::test
