// Friction and restitution of imported contacts, and joints of SDF that mimic others.
#include "import/surface_law.h"
#include "unit/import/imported.h"

namespace plab::test
{
namespace
{

using import::SceneFormat;

/// The law between two bodies of a loaded scene, as the response would use it.
SurfaceLaw law(const Scene& scene, const std::string& a, const std::string& b)
{
    const world::World& world = scene.simulation().world();
    const auto material = [&](const std::string& id) { return world.host().bodies.material[world.component(world.find(id)).host_index]; };
    if (const SurfaceLaw* const own = world.host().materials.find_pair(material(a), material(b))) return *own;
    const auto of_response = [&](const char* name) { return scene.real("contact.response", name); };
    return {of_response("friction"), of_response("restitution"), of_response("rolling_friction"), of_response("spinning_friction")};
}

Scene mjcf_of(const std::string& of_a, const std::string& of_b, const std::string& of_floor = "", const std::string& contact = "")
{
    return imported_scene(imported_text("<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1' " + of_floor +
                                            "/><body name='a' pos='0 0 1'><freejoint/><geom name='ga' size='0.1' " + of_a +
                                            "/></body><body name='b' pos='1 0 1'><freejoint/><geom name='gb' size='0.1' " + of_b +
                                            "/></body></worldbody><contact>" + contact + "</contact></mujoco>",
                                        SceneFormat::Mjcf));
}

TEST_CASE("MJCF: the larger friction counts, that of the higher priority alone, none if no shape has condim 3")
{
    const Scene plain = mjcf_of("friction='0.2'", "friction='0.7'", "friction='0.4'");
    CHECK(law(plain, "a", "b").friction == 0.7);
    CHECK(law(plain, "a", "world").friction == 0.4);
    const Scene above = mjcf_of("friction='0.2' priority='2'", "friction='0.7'", "friction='0.4' priority='1'");
    CHECK(law(above, "a", "b").friction == 0.2);
    CHECK(law(above, "a", "world").friction == 0.2);
    CHECK(law(above, "b", "world").friction == 0.4);
    const Scene smooth = mjcf_of("friction='0.2' condim='1'", "friction='0.7' condim='1'", "friction='0.4'");
    CHECK(law(smooth, "a", "b").friction == 0);
    CHECK(law(smooth, "a", "world").friction == 0.4);
    CHECK(law(mjcf_of("condim='1'", "condim='1'", "condim='1'"), "a", "world").friction == 0);
}

TEST_CASE(
    "MJCF: friction of twisting counts from condim 4 on, that of rolling with condim 6; the larger condim and the larger friction count")
{
    const Scene none = mjcf_of("friction='1 0.1 0.01'", "friction='1 0.2 0.02'");
    CHECK(!law(none, "a", "b").resists_turning());
    CHECK(!law(none, "a", "world").resists_turning());
    const Scene twisting = mjcf_of("friction='1 0.1 0.01' condim='4'", "friction='1 0.2 0.02'");
    CHECK(law(twisting, "a", "b").spinning_friction == 0.2);
    CHECK(law(twisting, "a", "b").rolling_friction == 0);
    CHECK(law(twisting, "a", "world").spinning_friction == 0.1);
    CHECK(law(twisting, "b", "world").spinning_friction == 0);
    const Scene rolling = mjcf_of("condim='6'", "friction='1 0.2 0.02'", "friction='1 0.001 0.003' priority='1' condim='6'");
    CHECK(law(rolling, "a", "b").rolling_friction == 0.02);
    CHECK(law(rolling, "a", "b").spinning_friction == 0.2);
    CHECK(law(rolling, "b", "world").rolling_friction == 0.003);
    CHECK(law(rolling, "b", "world").spinning_friction == 0.001);
    // What all shapes have is a parameter of the response.
    const Scene alike = mjcf_of("condim='6'", "condim='6'", "condim='6'");
    CHECK(alike.real("contact.response", "rolling_friction") == 0.0001);
    CHECK(alike.real("contact.response", "spinning_friction") == 0.005);
}

TEST_CASE("MJCF: a <pair> has a friction of its own")
{
    const Scene pair = mjcf_of("friction='0.2'", "friction='0.7'", "", "<pair geom1='gb' geom2='ga' friction='0.05'/>");
    CHECK(law(pair, "a", "b").friction == 0.05);
    CHECK(law(pair, "a", "world").friction == 1);
    CHECK(law(pair, "b", "world").friction == 1);
}

TEST_CASE("MJCF: below critical damping a contact rebounds as MuJoCo's does, to 0.2 %")
{
    // What MuJoCo 3 (npm mujoco-js 0.0.7) returns of 2 m/s at a step of 50 us, time constant 0.02 s, no gravity.
    for (const auto& [ratio, rebound] : {std::pair(0.1, 0.74362), {0.3, 0.45017}, {0.5, 0.29778}, {0.8, 0.17933}})
        CHECK(std::fabs(import::rebound_of(import::spring_of({0.02, ratio})) / rebound - 1) < 3e-3);
    CHECK(import::rebound_of(import::spring_of({0.02, 1})) == 0);
    CHECK(import::rebound_of(import::spring_of({-10000, 0})) == 1);
    CHECK(import::rebound_of(import::spring_of({-10000, -20})) == doctest::Approx(import::rebound_of({100, 0.1})));
    const Scene scene = mjcf_of("solref='0.02 0.1' priority='1'", "", "");
    CHECK(law(scene, "a", "world").restitution == doctest::Approx(0.74408).epsilon(1e-4));
    CHECK(law(scene, "b", "world").restitution == 0);
    // Of two shapes of equal priority the mean counts.
    CHECK(law(mjcf_of("solref='0.02 0.2'", "solref='0.02 0.8'"), "a", "b").restitution == doctest::Approx(import::rebound_of({100, 0.5})));
    const auto imported = imported_text("<mujoco><worldbody><geom size='1' solref='0.02 0.5'/></worldbody></mujoco>", SceneFormat::Mjcf);
    CHECK(lists(imported, "solref: contacts are rigid; the spring of 15.9154943091895"));
}

std::string sdf_ball(const std::string& name, const std::string& surface, double x)
{
    return "<model name='" + name + "'><pose>" + std::to_string(x) +
           " 0 0.6 0 0 0</pose><link name='l'><inertial auto='true'/><collision name='c'>" +
           "<geometry><sphere><radius>0.1</radius></sphere></geometry><surface>" + surface + "</surface></collision></link></model>";
}
std::string sdf_world(const std::string& models)
{
    return "<sdf version='1.9'><world name='w'><gravity>0 0 -9.81</gravity><model name='ground'><static>true</static><link "
           "name='l'><collision "
           "name='c'><geometry><plane/></geometry><surface><bounce><restitution_coefficient>0.8</restitution_coefficient></"
           "bounce><friction>"
           "<ode><mu>0.9</mu></ode></friction></surface></collision></link></model>" +
           models + "</world></sdf>";
}

TEST_CASE("SDF: of two surfaces the smaller friction and restitution count; a ball rises to e^2 of its height")
{
    Scene scene = imported_scene(imported_text(
        sdf_world(
            sdf_ball("lively", "<bounce><restitution_coefficient>0.9</restitution_coefficient></bounce>", 0) +
            sdf_ball("dull",
                     "<bounce><restitution_coefficient>0.5</restitution_coefficient></bounce><friction><ode><mu>0.3</mu></ode></friction>",
                     1)),
        SceneFormat::Sdf));
    CHECK(law(scene, "lively::l", "ground::l").restitution == 0.8);
    CHECK(law(scene, "dull::l", "ground::l").restitution == 0.5);
    CHECK(law(scene, "dull::l", "ground::l").friction == 0.3);
    CHECK(law(scene, "lively::l", "ground::l").friction == 0.9);
    double lively = 0, dull = 0;
    while (scene.simulation().time() < 0.8)
    {
        scene.step();
        if (scene.simulation().time() < 0.35) continue;
        lively = std::max(lively, scene.vec("lively::l", "position").z), dull = std::max(dull, scene.vec("dull::l", "position").z);
    }
    CHECK(std::fabs(lively - 0.1 - 0.5 * 0.64) < 2e-3);
    CHECK(std::fabs(dull - 0.1 - 0.5 * 0.25) < 2e-3);
}

TEST_CASE("SDF: masks decide what collides")
{
    const auto falls = [](const std::string& contact)
    {
        Scene scene = imported_scene(imported_text(sdf_world(sdf_ball("a", "<contact>" + contact + "</contact>", 0)), SceneFormat::Sdf));
        scene.run(0.6);
        return scene.vec("a::l", "position").z < 0;
    };
    CHECK(!falls("<collide_bitmask>0x01</collide_bitmask>"));
    CHECK(falls("<collide_bitmask>0x10000</collide_bitmask>"));
    CHECK(!falls("<collide_bitmask>0x10000</collide_bitmask><category_bitmask>2</category_bitmask>"));
    const auto refused =
        import_robot(sdf_world(sdf_ball("a", "<contact><collide_bitmask>yes</collide_bitmask></contact>", 0)), SceneFormat::Sdf);
    CHECK(reasons(refused).find("collide_bitmask must be a whole number of 32 bits") != std::string::npos);
}

TEST_CASE("SDF: a joint that mimics another begins where that one puts it, and follows it as a gear")
{
    const auto wheel = [](const std::string& name, double x, const std::string& mimic)
    {
        return "<link name='" + name + "'><pose>" + std::to_string(x) +
               " 0 0 0 0 0</pose><inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy>"
               "<izz>0.1</izz></inertia></inertial></link><joint name='j" +
               name + "' type='revolute'><parent>world</parent><child>" + name + "</child><axis><xyz>0 0 1</xyz>" + mimic +
               "</axis></joint>";
    };
    const auto scene_of = [&](const std::string& mimic)
    { return "<sdf version='1.11'><model name='m'>" + wheel("a", 0, "") + wheel("b", 1, mimic) + "</model></sdf>"; };
    Scene scene = imported_scene(
        imported_text(scene_of("<mimic joint='ja'><multiplier>-2</multiplier><offset>0.3</offset><reference>0.1</reference></mimic>"),
                      SceneFormat::Sdf),
        "<component id='push' type='Field/Load' between='a' torque='0 0 0.5'/>");
    // -2 (0 - 0.1) + 0.3
    CHECK(attitude_error(scene.quat("b", "orientation"), {std::cos(0.25), 0, 0, std::sin(0.25)}) < 1e-12);
    scene.run(1);
    CHECK(near(scene.real("ja", "angle"), 0.5, 1e-6));  // J_a + 4 J_b = 0.5 kg m^2
    CHECK(near(scene.real("jb", "angle"), -1, 1e-6));
    const auto refused = import_robot(scene_of("<mimic joint='nothing'/>"), SceneFormat::Sdf);
    CHECK(reasons(refused).find("'jb' cannot follow 'nothing'") != std::string::npos);
}

TEST_CASE("URDF: contact parameters of Bullet and of Gazebo")
{
    const auto imported = [](const std::string& more, const std::string& gazebo)
    {
        const std::string link =
            "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>"
            "<collision><geometry><sphere radius='0.1'/></geometry></collision>";
        return imported_text(
            "<robot name='r'><link name='a'>" + link + more + "</link><link name='b'>" + link + "</link><link name='c'>" + link +
                "</link><joint name='j' type='floating'><parent link='a'/><child link='b'/></joint><joint name='k' type='floating'>"
                "<parent link='a'/><child link='c'/></joint><gazebo><selfCollide>true</selfCollide></gazebo>" +
                gazebo + "</robot>",
            SceneFormat::Urdf);
    };
    const auto given = imported("<contact><lateral_friction value='0.3'/><restitution value='0.6'/><stiffness value='9'/></contact>",
                                "<gazebo reference='b'><mu1>0.5</mu1><mu2>0.5</mu2><kp>3</kp></gazebo>");
    CHECK(lists(given, "<stiffness>"));
    CHECK(lists(given, "<kp>"));
    const Scene scene = imported_scene(given);
    CHECK(law(scene, "a", "b").friction == 0.3);
    CHECK(law(scene, "b", "c").friction == 0.5);
    CHECK(law(scene, "a", "c").restitution == 0);
    CHECK(law(scene, "a", "a").restitution == 0.6);
}

}  // namespace
}  // namespace plab::test
