// Faulty files: a message with place and reason, and no crash whatever the bytes.
#include <array>
#include <random>

#include "unit/import/imported.h"

namespace plab::test
{
namespace
{

using import::SceneFormat;

std::string refusal(const std::string& text, SceneFormat format)
{
    const auto imported = import_robot(text, format);
    return imported.ok() ? "accepted" : imported.error().text();
}
std::string urdf(const std::string& inside) { return "<robot name='r'>\n" + inside + "</robot>"; }
std::string mjcf(const std::string& inside) { return "<mujoco>\n<worldbody>\n" + inside + "</worldbody></mujoco>"; }

const std::string kMass = "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/></inertial>";

TEST_CASE("faulty URDF is refused with its place and a reason")
{
    const auto check = [](const std::string& inside, const std::string& message)
    { CHECK(refusal(urdf(inside), SceneFormat::Urdf) == message); };
    CHECK(refusal("<robot><link name='a'>", SceneFormat::Urdf).starts_with("robot:1:"));
    check("", "robot:1:1: <robot> 'r': has no <link>");
    check("<link name='a'/><link name='a'/>", "robot:2:17: <link> 'a': there are two links of this name");
    check("<link name='a'/>\n<link name='b'/>", "robot:3:1: <link> 'b': is a second link without parent");
    check("<link name='a'/><joint name='j' type='fixed'><parent link='a'/><child link='x'/></joint>",
          "robot:2:17: <joint> 'j': there is no link 'x'");
    check("<link name='a'/><link name='b'/><joint name='j' type='bendy'><parent link='a'/><child link='b'/></joint>",
          "robot:2:33: <joint> 'j': type must be one of fixed, revolute, continuous, prismatic, planar, floating, not 'bendy'");
    check("<link name='a'/><link name='b'>" + kMass + "</link><joint name='j' type='revolute'><parent link='a'/><child link='b'/></joint>",
          "robot:2:111: <joint> 'j': a joint of type revolute needs a <limit>");
    check("<link name='a'/><link name='b'/><joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint>",
          "robot:2:17: 'b': has no mass, but the joint 'j' moves it: give it an inertia");
    check("<link name='a'><inertial><mass value='-1'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link>",
          "robot:2:16: <inertial> of link 'a': mass must be positive, not -1");
    check("<link name='a'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='3'/></inertial></link>",
          "robot:2:16: <inertial> of link 'a': inertia violates the triangle inequality, so no body can have it: its principal moments are "
          "1 1 3");
    check("<link name='a'><inertial><mass value='1,5'/><inertia ixx='1' iyy='1' izz='1'/></inertial></link>",
          "robot:2:26: <mass>: value must be 1 number, not '1,5'");
    check("<link name='a'><visual><geometry><sphere radius='nan'/></geometry></visual></link>",
          "robot:2:34: <sphere>: radius must be 1 number, not 'nan'");
    check("<xacro:include filename='x'/><link name='a'/>", "robot:2:1: <xacro:include>: is a macro: expand the file with xacro first");
    check("<link name='${prefix}_a'/>",
          "robot:2:1: <link> '${prefix}_a': name=\"${prefix}_a\" is for xacro: expand the file with xacro first");
    CHECK(refusal("<mujoco/>", SceneFormat::Urdf) == "robot:1:1: <mujoco>: is not the root of URDF, which is <robot>");
}

TEST_CASE("links that hang on one another in a ring are refused")
{
    const std::string joint = "<parent link='b'/><child link='c'/></joint>";
    CHECK(refusal(urdf("<link name='a'/>\n<link name='b'/><link name='c'/><joint name='j' type='fixed'>" + joint +
                       "<joint name='k' type='fixed'><parent link='c'/><child link='b'/></joint>"),
                  SceneFormat::Urdf) == "robot:3:1: <link> 'b': is its own ancestor");
}

TEST_CASE("faulty MJCF is refused with its place and a reason")
{
    const auto check = [](const std::string& inside, const std::string& message)
    { CHECK(refusal(mjcf(inside), SceneFormat::Mjcf) == message); };
    CHECK(refusal("<mujoco/>", SceneFormat::Mjcf) == "robot:1:1: <mujoco>: has no <worldbody>");
    CHECK(refusal("<mujoco><compiler coordinate='global'/><worldbody/></mujoco>", SceneFormat::Mjcf) ==
          "robot:1:9: <compiler>: coordinate=\"global\" is not supported");
    CHECK(refusal("<mujoco>\n<include/><worldbody/></mujoco>", SceneFormat::Mjcf) == "robot:2:1: <include>: needs a file");
    check("<geom type='box' size='1 2'/>", "robot:3:1: <geom>: size needs 3 numbers, not '1 2'");
    check("<geom class='none' size='1'/>", "robot:3:1: <geom>: there is no default class 'none'");
    check("<body><joint/></body>", "robot:3:1: 'body.1': has no mass, but the joint 'body.1.joint' moves it: give it an inertia");
    check("<body><geom size='1'/><joint axis='0 0 0'/></body>", "robot:3:23: <joint>: axis must be a direction, not the zero vector");
    check("<body><geom size='1'/><joint type='spin'/></body>",
          "robot:3:23: <joint>: type must be one of free, ball, slide, hinge, not 'spin'");
    CHECK(refusal("<mujoco><contact>\n<pair geom1='g' geom2='floor' friction='1'/></contact><worldbody><body><freejoint/><geom name='g' "
                  "size='1'/></body></worldbody></mujoco>",
                  SceneFormat::Mjcf) == "robot:2:1: <pair>: there is no geom 'floor'");
    check("<body><geom size='1' quat='0 0 0 0'/></body>", "robot:3:7: <geom>: quat must not be zero");
}

TEST_CASE("what is not carried over is listed in the order of the file, and nothing else")
{
    const auto imported = imported_text(urdf("<link name='a'>" + kMass + "</link>\n<gazebo/>\n<link name='b'>" + kMass +
                                             "</link>\n<joint name='j' type='revolute'><parent link='a'/><child link='b'/>"
                                             "<limit lower='-1' upper='1' effort='5'/><safety_controller/></joint>\n"),
                                        SceneFormat::Urdf);
    std::string all;
    for (const Error& loss : imported.losses) all += loss.text() + "\n";
    CHECK(all ==
          "robot:3:1: <gazebo>: is not carried over\n"
          "robot:5:68: <limit>: the attribute effort='5' is not carried over\n"
          "robot:5:108: <safety_controller>: is not carried over\n");
}

TEST_CASE("a shape whose contype and conaffinity match no other is only seen")
{
    const auto shapes = [](const std::string& ball)
    {
        return imported_text(
            "<mujoco><worldbody><geom type='plane' size='1 1 1' conaffinity='0'/><body name='b' pos='0 0 1'><freejoint/>"
            "<geom size='0.1' " +
                ball + "/></body></worldbody></mujoco>",
            SceneFormat::Mjcf);
    };
    const auto bounces = [](const import::ImportedScene& imported) { return imported.blueprint.find("CDetection") != std::string::npos; };
    CHECK(bounces(shapes("contype='0' conaffinity='1'")));
    CHECK(!bounces(
        imported_text("<mujoco><option><flag contact='disable'/></option><worldbody><geom type='plane' size='1 1 1'/><body pos='0 0 1'>"
                      "<freejoint/><geom size='0.1'/></body></worldbody></mujoco>",
                      SceneFormat::Mjcf)));
    CHECK(!bounces(shapes("contype='1' conaffinity='0'")));
    CHECK(!bounces(shapes("contype='4' conaffinity='2'")));
    CHECK(lists(shapes("contype='1' conaffinity='3'"), "collide with some shapes only") == false);
}

/// Random bytes, and files with random bytes in them.
TEST_CASE("random input ends in a scene or in an error")
{
    std::mt19937_64 random(7);
    const std::string models[] = {
        urdf("<link name='a'>" + kMass + "<visual><geometry><box size='1 1 1'/></geometry></visual></link><link name='b'>" + kMass +
             "</link><joint name='j' type='revolute'><parent link='a'/><child link='b'/><axis xyz='0 1 0'/><limit lower='-1' upper='1'/>"
             "<mimic joint='j'/></joint>"),
        mjcf("<body name='a'><freejoint/><geom type='capsule' fromto='0 0 0 0 0 1' size='0.1'/><body><joint range='0 1'/>"
             "<geom size='0.1'/></body></body>"),
        "<sdf version='1.9'><world name='w'><frame name='f'><pose>0 0 1 0 0 0</pose></frame><model name='m'><pose relative_to='f'>1 0 0 0 "
        "0 0</pose>"
        "<link name='a'/><link name='b'><pose relative_to='a'>0 0 1 0 0 0</pose><collision "
        "name='c'><geometry><sphere><radius>0.1</radius></sphere>"
        "</geometry></collision></link><joint name='j' type='revolute'><parent>a</parent><child>b</child><axis><xyz>0 1 "
        "0</xyz></axis></joint>"
        "<joint name='k' type='ball'><parent>world</parent><child>b</child></joint></model></world></sdf>"};
    const std::string words[] = {"'",     "<",      ">",     "/", "1e30", "-1", "0", "nan", " ", "<body>", "<link name='a'>",
                                 "fixed", "planar", "1e-30", "="};
    std::size_t accepted = 0;
    for (int i = 0; i < 6000; ++i)
    {
        const auto kind = std::size_t(i) % 3;
        std::string text = models[kind];
        if (i % 7 == 0)
        {
            text.resize(random() % 200);
            for (char& c : text) c = static_cast<char>(random());
        }
        for (std::uint64_t k = random() % 4; k > 0 && !text.empty(); --k)
        {
            const std::size_t at = random() % text.size();
            if (random() % 2)
                text.insert(at, words[random() % std::size(words)]);
            else
                text.erase(at, random() % 20);
        }
        const auto imported = import_robot(text, std::array{SceneFormat::Urdf, SceneFormat::Mjcf, SceneFormat::Sdf}[kind]);
        accepted += imported.ok() ? 1 : 0;
        CHECK((imported.ok() ? blueprint::read_blueprint(imported->blueprint, "b").ok() : !imported.error().reason.empty()));
    }
    CHECK(accepted > 100);
}

}  // namespace
}  // namespace plab::test
