// Rotors, motors and servos of imported robots, against closed forms; and that dropped robots gain no energy.
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

/// A disc on the hinge `j` about z, 0.5 kg m^2; `joint`: further attributes of the hinge; `actuators`: what is in <actuator>.
std::string disc(const std::string& joint, const std::string& actuators)
{
    return "<mujoco><compiler angle='radian'/><worldbody><body name='disc'><inertial pos='0 0 0' mass='2' diaginertia='0.3 0.3 0.5'/>"
           "<joint name='j' axis='0 0 1' " +
           joint + "/></body></worldbody><actuator>" + actuators + "</actuator></mujoco>";
}

void command(Scene& scene, const std::string& id, double control)
{
    const auto reply = scene.ask(simulation::SetOperation{id, "control", Value(control)});
    REQUIRE_MESSAGE(reply.errors.empty(), first_error(reply.errors));
}

TEST_CASE("a motor turns its joint by gear times control, within the control's range, against body and rotor")
{
    const auto imported = imported_text(disc("armature='0.3'", "<motor name='m' joint='j' gear='4' ctrlrange='-1 1'/>"), SceneFormat::Mjcf);
    CHECK(imported.losses.empty());
    Scene scene = imported_scene(imported);
    command(scene, "m", 0.5), scene.run(1);
    CHECK(scene.vec("disc", "angular_velocity").z == doctest::Approx(2 / 0.8).epsilon(1e-9));
    CHECK(scene.real("m", "effort") == doctest::Approx(2));
    command(scene, "m", -7), scene.run(2);  // counts as -1
    CHECK(scene.vec("disc", "angular_velocity").z == doctest::Approx((2 - 4) / 0.8).epsilon(1e-9));
}

TEST_CASE("a position servo swings at sqrt(kp gear^2 / J) about its target; the joint's zero is that of the file")
{
    const auto imported = imported_text(disc("ref='0.25'", "<position name='p' joint='j' kp='3' gear='2'/>"), SceneFormat::Mjcf);
    Scene scene = imported_scene(imported);
    command(scene, "p", 1);  // l = gear q = 1: q = 0.5
    const double w = std::sqrt(3 * 4 / 0.5);
    for (const double t : {0.3, 0.7, 1.1})
    {
        scene.run(t);
        CHECK(std::fabs(scene.real("j", "angle") - 0.25 * (1 - std::cos(w * scene.simulation().time()))) < 1e-6);
    }
}

TEST_CASE("a velocity servo approaches its speed as exp(-kv gear^2 t / J); forces are bounded")
{
    const auto imported = imported_text(disc("", "<velocity name='v' joint='j' kv='2'/>"), SceneFormat::Mjcf);
    Scene scene = imported_scene(imported);
    command(scene, "v", 3), scene.run(0.5);
    CHECK(std::fabs(scene.vec("disc", "angular_velocity").z - 3 * (1 - std::exp(-2 / 0.5 * 0.5))) < 1e-6);
    Scene weak = imported_scene(imported_text(disc("", "<velocity name='v' joint='j' kv='2' forcerange='-1 1'/>"), SceneFormat::Mjcf));
    command(weak, "v", 30), weak.run(0.5);
    CHECK(weak.vec("disc", "angular_velocity").z == doctest::Approx(1));
}

TEST_CASE("an actuator of a fixed tendon acts on fingers that follow one another")
{
    const auto hand = [](const std::string& equality)
    {
        const auto finger = [](const std::string& id, const std::string& axis)
        {
            return "<body name='" + id + "'><inertial pos='0 0 0' mass='0.5' diaginertia='0.1 0.1 0.1'/><joint name='" + id +
                   "_joint' type='slide' axis='" + axis + "'/></body>";
        };
        return imported_text("<mujoco><worldbody>" + finger("left", "0 1 0") + finger("right", "0 -1 0") +
                                 "</worldbody><tendon><fixed name='split'><joint joint='left_joint' coef='0.5'/><joint joint='right_joint' "
                                 "coef='0.5'/></fixed><fixed name='idle'/></tendon>" +
                                 equality + "<actuator><motor name='close' tendon='split' gear='2'/></actuator></mujoco>",
                             SceneFormat::Mjcf);
    };
    const auto imported = hand("<equality><joint joint1='left_joint' joint2='right_joint' polycoef='0 3 0 0 0'/></equality>");
    Scene scene = imported_scene(imported);
    command(scene, "close", 1), scene.run(1);
    // The length changes by (3 + 1) / 2 times what the right finger moves, and the gear doubles the force: 4 N on m + 9 m.
    CHECK(near(scene.vec("right", "position").y, -0.5 * 4 / 5, 1e-6));
    CHECK(near(scene.vec("left", "position").y, 3 * 0.5 * 4 / 5, 1e-6));
    CHECK(lists(imported, "'idle': is not carried over: no actuator acts by it"));
    const auto apart = hand("<equality><joint joint1='left_joint' joint2='right_joint' polycoef='0 0 0 0 0'/></equality>");
    CHECK(lists(apart, "'close': is not carried over: the joints of its tendon do not follow one another here"));
    CHECK(lists(hand(""), "'close': is not carried over: of a tendon's actuator all joints have to follow one another"));
}

TEST_CASE("<general> with an affine bias, defaults of actuators, and what is listed")
{
    const auto imported = imported_text(
        "<mujoco><default><motor ctrlrange='-2 2'/></default><worldbody><body name='disc'><inertial pos='0 0 0' "
        "mass='2' diaginertia='0.3 0.3 0.5'/><joint name='j'/></body></worldbody><actuator>"
        "<general name='g' joint='j' gainprm='5' biastype='affine' biasprm='0.1 -0.2 -0.3'/>"
        "<general name='h' joint='j' dyntype='integrator'/><motor name='t' tendon='x'/><muscle joint='j'/>"
        "</actuator></mujoco>",
        SceneFormat::Mjcf);
    const Scene scene = imported_scene(imported);
    CHECK(scene.real("g", "gain") == 5);
    CHECK(scene.vec("g", "bias") == Vec3{0.1, -0.2, -0.3});
    CHECK(scene.real("g", "control_upper") == 2);
    CHECK(lists(imported, "<general> 'h': is not carried over: it has a state of its own"));
    CHECK(lists(imported, "'t': is not carried over: of a tendon's actuator all joints have to follow one another"));
    CHECK(lists(imported, "<muscle>: is not carried over"));
    CHECK(reasons(import_robot(disc("", "<motor joint='gone'/>"), SceneFormat::Mjcf)).find("there is no joint 'gone'") !=
          std::string::npos);
}

TEST_CASE("armature between two free bodies acts on both: what one gains the other loses")
{
    // Coaxial, J1 = 0.2 and J2 = 0.5, rotor 0.3: q'' (1 + 0.3 (1/J1 + 1/J2)) = T (1/J1 + 1/J2), and no angular momentum in all but the
    // rotor.
    const auto imported = imported_text(
        "<mujoco><option gravity='0 0 0'/><worldbody><body name='a'><freejoint/><inertial pos='0 0 0' mass='1' "
        "diaginertia='0.2 0.2 0.2'/><body name='b'><inertial pos='0 0 0' mass='2' diaginertia='0.4 0.4 0.5'/>"
        "<joint name='j' armature='0.3'/></body></body></worldbody><actuator><motor name='m' joint='j'/>"
        "</actuator></mujoco>",
        SceneFormat::Mjcf);
    Scene scene = imported_scene(imported);
    command(scene, "m", 1.5), scene.run(1);
    const double sum = 1 / 0.2 + 1 / 0.5, rate = 1.5 * sum / (1 + 0.3 * sum), torque = 1.5 - 0.3 * rate;
    CHECK(scene.vec("a", "angular_velocity").z == doctest::Approx(-torque / 0.2).epsilon(1e-9));
    CHECK(scene.vec("b", "angular_velocity").z == doctest::Approx(torque / 0.5).epsilon(1e-9));
}

TEST_CASE("armature of a slide is mass along it that has no weight")
{
    // a = g m / (m + armature)
    const auto imported = imported_text(
        "<mujoco><worldbody><body name='b'><inertial pos='0 0 0' mass='2' diaginertia='0.1 0.1 0.1'/><joint name='j' type='slide' "
        "axis='0 0 1' armature='0.5'/></body></worldbody></mujoco>",
        SceneFormat::Mjcf);
    CHECK(!lists(imported, "armature"));
    Scene scene = imported_scene(imported);
    scene.run(1);
    CHECK(scene.vec("b", "linear_velocity").z == doctest::Approx(-9.81 * 2 / 2.5).epsilon(1e-9));
}

TEST_CASE("the period of a pendulum with a rotor is that of the closed form, to 1e-6")
{
    // 0.6 kg m^2 of the pendulum and 0.9 of its rotor: the period grows by sqrt(1.5 / 0.6).
    const auto imported = imported_text(R"(<mujoco><compiler angle="radian"/><worldbody><body name="bob" pos="0 0 2" euler="0 1 0">
      <inertial pos="0 0 -0.5" mass="2" diaginertia="0.1 0.1 0.01"/><joint axis="0 1 0" armature="0.9"/></body></worldbody></mujoco>)",
                                        SceneFormat::Mjcf);
    Scene scene = imported_scene(imported);
    CHECK(std::fabs(period_of(scene, "bob") / (expected_period() * std::sqrt(1.5 / 0.6)) - 1) < 1e-6);
}

double energy_of(const Scene& scene)
{
    const simulation::Totals totals = scene.simulation().totals();
    return totals.kinetic + totals.stored;
}

/// The most that the scene's energy rises above that of its start, J.
double energy_gained(Scene& scene, double seconds)
{
    const double start = energy_of(scene);
    double most = 0;
    while (scene.simulation().time() < seconds) scene.step(), most = std::fmax(most, energy_of(scene) - start);
    return most;
}

std::string text_of(const std::string& name)
{
    std::ifstream file(std::string(PLAB_SOURCE_DIR) + "/scenes/imported/" + name);
    return std::string(std::istreambuf_iterator<char>(file), {});
}

TEST_CASE("the energy of dropped robots never rises")
{
    for (const char* const name : {"crawler.mjcf", "walker.mjcf"})
    {
        CAPTURE(name);
        Scene scene = imported_scene(imported_file(name));
        scene.warnings_expected = true;
        CHECK(energy_gained(scene, 2) < 1e-9);
    }
}

TEST_CASE("dampers that are stiff for the step of the file add no energy")
{
    // Without rotors the dampers stop the legs within a fraction of the file's step.
    std::string text = text_of("crawler.mjcf");
    text.replace(text.find("armature=\"0.8\" "), 15, "");
    Scene scene = imported_scene(imported_text(text, SceneFormat::Mjcf));
    CHECK(scene.simulation().dt() == 0.01);
    CHECK(energy_gained(scene, 1) < 1e-7);  // of 3 J: the tolerance of the flight before it lands
}

TEST_CASE("gravity spares what compensates it; the mass of all can be given")
{
    const auto imported = imported_text(
        "<mujoco><compiler settotalmass='6'/><worldbody><body name='a'><freejoint/><geom size='0.1'/></body>"
        "<body name='b' pos='1 0 0' gravcomp='1'><freejoint/><geom size='0.1' mass='0'/><geom size='0.1'/>"
        "</body></worldbody></mujoco>",
        SceneFormat::Mjcf);
    Scene scene = imported_scene(imported);
    CHECK(scene.real("a", "mass") == doctest::Approx(3));
    scene.run(0.5);
    CHECK(scene.vec("a", "position").z < -1);
    CHECK(scene.vec("b", "position").z == 0);
}

TEST_CASE("files that a model of MJCF includes stand in its place")
{
    namespace fs = std::filesystem;
    const fs::path folder = fs::path(PLAB_BINARY_DIR) / "tests/unit/import/parts";
    fs::create_directories(folder / "more");
    std::ofstream(folder / "more/legs.xml")
        << "<mujocoinclude><body name='leg' pos='0 0 -1'>\n<joint/><geom size='0.1' spin='1'/></body></mujocoinclude>";
    std::ofstream(folder / "world.xml")
        << "<mujoco><default><geom density='500'/></default><worldbody><geom type='plane' size='1 1 1'/></worldbody></mujoco>";
    std::ofstream(folder / "self.xml") << "<mujoco><include file='self.xml'/></mujoco>";
    const auto import_in = [&](const std::string& text) { return import_robot(text, SceneFormat::Mjcf, (folder / "robot.xml").string()); };
    const auto imported = import_in(
        "<mujoco><include file='world.xml'/><worldbody><body name='trunk' pos='0 0 3'><freejoint/><geom size='0.2'/>"
        "<include file='more/legs.xml'/></body></worldbody></mujoco>");
    REQUIRE_MESSAGE(imported.ok(), reasons(imported));
    CHECK(imported->bodies == 2);
    CHECK(imported->blueprint.find("Shape/Plane") != std::string::npos);
    CHECK(lists(*imported, "more/legs.xml:2:9: <geom>: the attribute spin='1' is not carried over"));
    CHECK(imported_scene(*imported).real("leg", "mass") == doctest::Approx(4.0 / 3 * std::numbers::pi * 0.001 * 500));
    CHECK(reasons(import_in("<mujoco><include file='gone.xml'/><worldbody/></mujoco>")).find("gone.xml cannot be opened") !=
          std::string::npos);
    CHECK(reasons(import_in("<mujoco><include file='self.xml'/><worldbody/></mujoco>")).find("is included a second time") !=
          std::string::npos);
}

}  // namespace
}  // namespace plab::test
