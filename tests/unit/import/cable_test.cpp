// <spatial> tendons of MJCF: ropes, elastic bands, tackles and pistons between sites, against closed forms.
#include "unit/import/imported.h"

namespace plab::test
{
namespace
{

using import::SceneFormat;

constexpr double kWeight = 9.81;  // m/s^2

std::string load(const std::string& name, double mass, const Vec3& at)
{
    return "<body name='" + name + "' pos='" + text(at) + "'><freejoint/><inertial pos='0 0 0' mass='" + text(mass) +
           "' diaginertia='0.02 0.02 0.02'/><site name='" + name + "_eye' pos='0 0 0'/></body>";
}

/// Two hooks in the world at a height of 3 m, `loads`, a tendon of this `path`, and actuators.
auto hoist(const std::string& loads, const std::string& attributes, const std::string& path, const std::string& more = "")
{
    std::string sites;
    for (std::size_t at = 0; at < path.size();)
    {
        const std::size_t end = std::min(path.find(' ', at), path.size());
        const std::string word = path.substr(at, end - at);
        sites += word[0] == '/' ? "<pulley divisor='" + word.substr(1) + "'/>" : "<site site='" + word + "'/>";
        at = end + 1;
    }
    return imported_text("<mujoco><worldbody><site name='left' pos='-0.5 0 3'/><site name='right' pos='0.5 0 3'/>" + loads +
                             "</worldbody><tendon><spatial name='rope' " + attributes + ">" + sites + "</spatial></tendon>" + more +
                             "</mujoco>",
                         SceneFormat::Mjcf);
}

TEST_CASE("a load falls until its rope is taut, and hangs; unused hooks are listed")
{
    const auto imported = hoist(load("a", 2, {-0.5, 0, 2.8}), "range='0 0.6'", "left a_eye");
    CHECK(lists(imported, "<site> 'right': is not carried over: no tendon uses it"));
    Scene scene = imported_scene(imported);
    scene.run(0.2);
    CHECK(near(scene.vec("a", "position").z, 2.8 - 0.5 * kWeight * 0.04, 1e-9));
    CHECK(near(scene.real("rope", "position"), 3 - scene.vec("a", "position").z, 1e-12));
    scene.run(1);
    CHECK(near(scene.vec("a", "position").z, 2.4, 1e-9));
}

TEST_CASE("an elastic band swings at sqrt(k / m) about its equilibrium, with its length or a half of it")
{
    for (const std::string path : {"left a_eye", "right left /2 left a_eye"})
    {
        CAPTURE(path);
        const bool half = path.size() > 10;  // and 1 m that does not change
        const double k = half ? 200.0 / 4 : 200, rest = 0.4;
        Scene scene = imported_scene(
            hoist(load("a", 2, {-0.5, 0, 3 - rest}), "stiffness='200' springlength='" + text(half ? 1 + rest / 2 : rest) + "'", path));
        for (const double t : {0.2, 0.5, 0.9})
        {
            scene.run(t);
            const double down = 2 * kWeight / k * (1 - std::cos(std::sqrt(k / 2) * scene.simulation().time()));
            CHECK(near(scene.vec("a", "position").z, 3 - rest - down, 1e-6));
        }
    }
}

TEST_CASE("ropes over wheels are pulleys, also as tackles")
{
    for (const double parts : {1.0, 2.0})
    {
        CAPTURE(parts);
        // Length: of the left end, what is between the wheels, and of the right end its share.
        const bool tackle = parts > 1;
        const std::string length = text(tackle ? 2 + 2 / parts : 2 + 1 + 2);
        Scene scene = imported_scene(hoist(load("a", 1, {-0.5, 0, 1}) + load("b", 3, {0.5, 0, 1}), "range='0 " + length + "'",
                                           tackle ? "a_eye left /2 right b_eye" : "a_eye left right b_eye"));
        scene.run(0.5);
        // As a tackle: what b gains is a half of its own way, and twice of that of a.
        const double share = 1 / parts, a = kWeight * (3 - share) / (3 + share * share);
        CHECK(near(scene.vec("b", "position").z, 1 - 0.5 * a * 0.25, 1e-9));
        CHECK(near(scene.vec("a", "position").z, 1 + share * 0.5 * a * 0.25, 1e-9));
    }
}

TEST_CASE("an actuator of a spatial tendon is a piston between its ends")
{
    Scene scene = imported_scene(hoist(load("a", 1, {0, 0, 1}) + load("b", 4, {0, 0, 2}), "", "a_eye b_eye",
                                       "<option gravity='0 0 0'/><actuator><motor name='m' tendon='rope' gear='2'/></actuator>"));
    REQUIRE(scene.ask(simulation::SetOperation{"m", "control", Value(1.5)}).done);
    scene.run(0.8);
    CHECK(near(scene.vec("a", "position").z, 1 - 0.5 * 3 * 0.64, 1e-9));
    CHECK(near(scene.vec("b", "position").z, 2 + 0.5 * 3.0 / 4 * 0.64, 1e-9));
    CHECK(near(scene.real("m", "position"), scene.vec("b", "position").z - scene.vec("a", "position").z, 1e-12));
    // A servo of the length of which the way between the hooks is a part that does not change.
    Scene servo = imported_scene(hoist(load("a", 1, {-0.5, 0, 2}), "", "right left a_eye",
                                       "<option gravity='0 0 0'/><actuator><position name='p' tendon='rope' kp='50'/></actuator>"));
    REQUIRE(servo.ask(simulation::SetOperation{"p", "control", Value(2.5)}).done);
    servo.run(0.3);
    CHECK(near(servo.vec("a", "position").z, 3 - 1.5 + 0.5 * std::cos(std::sqrt(50) * servo.simulation().time()), 1e-6));
}

TEST_CASE("what cannot be carried over of a spatial tendon is listed, and so are its actuators")
{
    const std::string motor = "<actuator><motor name='m' tendon='rope'/></actuator>";
    const auto three = hoist(load("a", 1, {-0.5, 0, 1}) + load("b", 1, {0.5, 0, 1}), "range='0 9'", "left a_eye b_eye right", motor);
    CHECK(lists(three, "'rope': is not carried over: only one or two of its parts may have lengths that change"));
    CHECK(lists(three, "'m': is not carried over: its tendon is not between two points"));
    const auto endless = hoist(load("a", 1, {-0.5, 0, 1}) + load("b", 1, {0.5, 0, 1}), "", "a_eye left right b_eye");
    CHECK(lists(endless, "'rope': is not carried over: with two parts whose lengths change, it needs a range"));
    const auto wound = imported_text("<mujoco><worldbody><site name='s'/>" + load("a", 1, {0, 0, 1}) +
                                         "</worldbody><tendon><spatial name='t' margin='0.1'><site site='s'/><geom geom='g'/><site "
                                         "site='a_eye'/></spatial></tendon></mujoco>",
                                     SceneFormat::Mjcf);
    CHECK(lists(wound, "<spatial> 't': is not carried over: it winds around a shape"));
    CHECK(lists(wound, "the attribute margin='0.1' is not carried over"));
    CHECK(lists(hoist(load("a", 1, {0, 0, 1}), "range='0 2'", "left right"), "'rope': is not carried over: its length does not change"));
    const std::string twice =
        "<mujoco><worldbody><site name='s'/><site name='t'/></worldbody><tendon><spatial name='x'><site site='s'/>"
        "<site site='t'/></spatial><spatial name='x'><site site='t'/><site site='s'/></spatial></tendon></mujoco>";
    CHECK(reasons(import_robot(twice, SceneFormat::Mjcf)).find("there are two tendons of this name") != std::string::npos);
    CHECK(reasons(import_robot("<mujoco><worldbody/><tendon><spatial><site site='gone'/></spatial></tendon></mujoco>", SceneFormat::Mjcf))
              .find("there is no site 'gone'") != std::string::npos);
}

}  // namespace
}  // namespace plab::test
