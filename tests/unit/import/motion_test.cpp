// How imported robots move: a pendulum's period, limits, springs, friction, gears.
#include <numbers>

#include "unit/import/imported.h"
#include "unit/import/pendulum.h"

namespace plab::test
{
namespace
{

using import::SceneFormat;

TEST_CASE("the period of a pendulum from URDF is that of the closed form, to 1e-6")
{
    const auto imported = imported_text(R"(<robot name="p"><link name="world"/><link name="bob"><inertial><origin xyz="0 0 -0.5"/>
      <mass value="2"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.01"/></inertial></link>
      <joint name="pivot" type="continuous"><parent link="world"/><child link="bob"/><origin xyz="0 0 2" rpy="0 1 0"/>
      <axis xyz="0 1 0"/></joint></robot>)",
                                        SceneFormat::Urdf);
    CHECK(imported.losses.empty());
    Scene scene = imported_scene(imported);
    CHECK(std::fabs(period_of(scene, "bob") / expected_period() - 1) < 1e-6);
}

TEST_CASE("the period of a pendulum from MJCF is that of the closed form, to 1e-6")
{
    const auto imported = imported_text(R"(<mujoco><compiler angle="radian"/><worldbody><body name="bob" pos="0 0 2" euler="0 1 0">
      <inertial pos="0 0 -0.5" mass="2" diaginertia="0.1 0.1 0.01"/><joint axis="0 1 0"/></body></worldbody></mujoco>)",
                                        SceneFormat::Mjcf);
    CHECK(imported.losses.empty());
    Scene scene = imported_scene(imported);
    CHECK(scene.simulation().dt() == doctest::Approx(0.002));
    CHECK(std::fabs(period_of(scene, "bob") / expected_period() - 1) < 1e-6);
}

std::string urdf_joint(const std::string& type, const std::string& inside)
{
    return R"(<robot name="p"><link name="world"/><link name="bob"><inertial><origin xyz="0.5 0 0"/>
      <mass value="2"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
      <joint name="j" type=")" +
           type + R"("><parent link="world"/><child link="bob"/>)" + inside + "</joint></robot>";
}

TEST_CASE("limits of a hinge and of a slider hold")
{
    // Gravity turns +x down: positively about y.
    Scene hinge = imported_scene(imported_text(
        urdf_joint("revolute", "<axis xyz='0 1 0'/><limit lower='-0.3' upper='0.7' effort='0' velocity='0'/>"), SceneFormat::Urdf));
    hinge.run(3);
    CHECK(std::fabs(hinge.real("j", "angle") - 0.7) < 1e-3);
    Scene slider = imported_scene(imported_text(
        urdf_joint("prismatic", "<axis xyz='0 0 1'/><limit lower='-0.4' upper='0.2' effort='0' velocity='0'/>"), SceneFormat::Urdf));
    slider.run(3);
    CHECK(std::fabs(slider.vec("bob", "position").z + 0.4) < 1e-3);
}

TEST_CASE("a joint whose limits exclude 0 begins at the nearest one, and its limits are meant from 0")
{
    Scene scene = imported_scene(imported_text(
        urdf_joint("revolute", "<axis xyz='0 1 0'/><limit lower='0.5' upper='1.2' effort='0' velocity='0'/>"), SceneFormat::Urdf));
    CHECK(attitude_error(scene.quat("bob", "orientation"), {std::cos(0.25), 0, std::sin(0.25), 0}) < 1e-12);
    scene.run(3);
    CHECK(attitude_error(scene.quat("bob", "orientation"), {std::cos(0.6), 0, std::sin(0.6), 0}) < 1e-3);
}

TEST_CASE("a joint of MJCF whose range excludes the pose of the file begins at the nearest bound; ref moves the zero")
{
    const auto imported = imported_text(R"(<mujoco><worldbody><body name="bob"><inertial pos="0.5 0 0" mass="2" diaginertia="0.1 0.1 0.1"/>
      <joint name="j" axis="0 1 0" range="30 70" ref="10"/></body></worldbody></mujoco>)",
                                        SceneFormat::Mjcf);
    CHECK(lists(imported, "begins at the nearest bound"));
    Scene scene = imported_scene(imported);
    const auto turned = [](double degrees)
    {
        const double half = degrees * std::numbers::pi / 360;
        return Quat{std::cos(half), 0, std::sin(half), 0};
    };
    CHECK(attitude_error(scene.quat("bob", "orientation"), turned(30 - 10)) < 1e-12);
    scene.run(3);
    CHECK(attitude_error(scene.quat("bob", "orientation"), turned(70 - 10)) < 1e-3);
}

TEST_CASE("a spring with damping comes to rest where its torque is that of the weight")
{
    const auto imported = imported_text(R"(<mujoco><compiler angle="radian"/><worldbody><body name="bob">
      <inertial pos="0.5 0 0" mass="2" diaginertia="0.1 0.1 0.1"/><joint name="j" axis="0 1 0" stiffness="40" damping="6" springref="-0.2"/>
      </body></worldbody></mujoco>)",
                                        SceneFormat::Mjcf);
    Scene scene = imported_scene(imported);
    scene.run(8);
    const double q = scene.real("j", "angle");
    CHECK(near(40 * (q + 0.2), 2 * 9.81 * 0.5 * std::cos(q), 1e-6));
}

TEST_CASE("dry friction holds a joint up to its torque")
{
    for (const double friction : {12.0, 8.0})  // the weight's torque is 9.81 N m
    {
        Scene scene = imported_scene(imported_text(
            urdf_joint("continuous", "<axis xyz='0 1 0'/><dynamics friction='" + std::to_string(friction) + "'/>"), SceneFormat::Urdf));
        scene.run(0.5);
        CHECK((std::fabs(scene.real("j", "angle")) < 1e-3) == (friction > 9.81));
    }
}

std::string two_wheels(const std::string& mimic)
{
    const std::string link =
        "<inertial><mass value='1'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/></inertial></link>";
    return "<robot name='g'><link name='world'/><link name='a'>" + link + "<link name='b'>" + link +
           "<joint name='ja' type='continuous'><parent link='world'/><child link='a'/><axis xyz='0 0 1'/></joint>"
           "<joint name='jb' type='continuous'><parent link='world'/><child link='b'/><origin xyz='1 0 0'/><axis xyz='0 0 1'/>" +
           mimic + "</joint></robot>";
}

TEST_CASE("a joint that mimics another follows it as a gear")
{
    Scene scene = imported_scene(imported_text(two_wheels("<mimic joint='ja' multiplier='-2' offset='0.3'/>"), SceneFormat::Urdf),
                                 "<component id='push' type='Field/Load' between='a' torque='0 0 0.5'/>");
    CHECK(attitude_error(scene.quat("b", "orientation"), {std::cos(0.15), 0, 0, std::sin(0.15)}) < 1e-12);
    scene.run(1);
    // J_a + 4 J_b = 0.5 kg m^2
    CHECK(near(scene.real("ja", "angle"), 0.5, 1e-6));
    CHECK(near(scene.real("jb", "angle"), -1, 1e-6));
}

TEST_CASE("fingers of a gripper that slide follow one another, and so do joints in a chain")
{
    const std::string link =
        "<inertial><mass value='1'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/></inertial></link>";
    const std::string limit = "<limit lower='-9' upper='9' effort='9' velocity='9'/>";
    const std::string gripper =
        "<robot name='g'><link name='world'/><link name='a'>" + link + "<link name='b'>" + link +
        "<joint name='ja' type='prismatic'><parent link='world'/><child link='a'/><axis xyz='0 1 0'/>" + limit +
        "</joint><joint name='jb' type='prismatic'><parent link='world'/><child link='b'/><axis xyz='0 -1 0'/><mimic joint='ja' "
        "multiplier='0.5'/>" +
        limit + "</joint></robot>";
    Scene fingers =
        imported_scene(imported_text(gripper, SceneFormat::Urdf), "<component id='push' type='Field/Load' between='a' force='0 1 0'/>");
    fingers.run(1);
    CHECK(near(fingers.vec("a", "position").y, 0.5 / 1.25, 1e-6));  // m_a + m_b / 4
    CHECK(near(fingers.vec("b", "position").y, -0.25 / 1.25, 1e-6));
    const std::string chain =
        "<robot name='g'><link name='world'/><link name='a'>" + link + "<link name='b'>" + link +
        "<joint name='ja' type='continuous'><parent link='world'/><child link='a'/><axis xyz='0 0 1'/></joint><joint name='jb' "
        "type='continuous'><parent link='a'/><child link='b'/><origin xyz='1 0 0'/><axis xyz='0 0 1'/><mimic joint='ja' "
        "multiplier='0.8'/></joint></robot>";
    Scene finger =
        imported_scene(imported_text(chain, SceneFormat::Urdf), "<component id='push' type='Field/Load' between='a' torque='0 0 2'/>");
    finger.run(1);
    CHECK(finger.real("ja", "angle") > 0.2);
    CHECK(near(finger.real("jb", "angle"), 0.8 * finger.real("ja", "angle"), 1e-9));
}

TEST_CASE("a planar joint moves in its plane and turns about its axis; floating is free")
{
    Scene planar = imported_scene(imported_text(urdf_joint("planar", "<axis xyz='0 0 1'/>"), SceneFormat::Urdf),
                                  "<component id='push' type='Field/Load' between='bob' force='2 4 0'/>");
    planar.run(1);
    const Vec3 center = planar.vec("bob", "position") + rotate(planar.quat("bob", "orientation"), {0.5, 0, 0});
    CHECK(distance(center, {0.5 + 0.5, 1, 0}) < 1e-4);
    Scene floating = imported_scene(imported_text(urdf_joint("floating", "<origin xyz='0 0 5'/>"), SceneFormat::Urdf));
    floating.run(1);
    CHECK(near(floating.vec("bob", "position").z, 5 - 9.81 / 2, 1e-9));
}

TEST_CASE("connect closes a loop, and two joints at a ratio turn as a gear")
{
    const auto imported = imported_text(R"(<mujoco><worldbody><body name="a"><joint name="ja" axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 1 0 0" size="0.05" contype="0" conaffinity="0"/></body>
      <body name="b" pos="2 0 0"><joint name="jb" axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 -1 0 0" size="0.05" contype="0" conaffinity="0"/></body>
      <body name="c" pos="0 3 0"><joint name="jc" axis="0 1 0" damping="0.1"/>
        <geom type="capsule" fromto="0 0 0 1 0 0" size="0.05" contype="0" conaffinity="0"/></body></worldbody>
      <equality><connect body1="a" body2="b" anchor="1 0 0"/><joint joint1="jc" joint2="ja" polycoef="0 -1 0 0 0"/></equality></mujoco>)",
                                        SceneFormat::Mjcf);
    Scene scene = imported_scene(imported);
    CHECK(imported.losses.empty());
    scene.warnings_expected = true;
    scene.run(0.5);
    const Vec3 end_a = scene.vec("a", "position") + rotate(scene.quat("a", "orientation"), {1, 0, 0});
    const Vec3 end_b = scene.vec("b", "position") + rotate(scene.quat("b", "orientation"), {-1, 0, 0});
    CHECK(distance(end_a, end_b) < 1e-6);
    CHECK(near(scene.real("jc", "angle"), -scene.real("ja", "angle"), 1e-6));
}

}  // namespace
}  // namespace plab::test
