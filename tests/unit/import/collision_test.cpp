// Which bodies of imported robots collide: parent and child, masks, exclusions, pairs, models; and that what collides holds.
#include <set>

#include "unit/import/imported.h"

namespace plab::test
{
namespace
{

using import::SceneFormat;

/// "a-b c-d": the pairs of bodies that touch in the pose of the file, in alphabetical order.
std::string touching(const import::ImportedScene& imported)
{
    std::string settings, content = content_of(imported, settings);
    // What overlaps would be pushed apart.
    const auto replace = [&](const std::string& id, const std::string& by)
    {
        const std::size_t begin = content.find("<component id=\"" + id + "\"");
        if (begin != std::string::npos) content.replace(begin, content.find("/>", begin) + 2 - begin, by);
        return begin != std::string::npos;
    };
    if (!replace("contact.response", "<component id=\"contact.response\" type=\"Response/None\"/>")) return "";
    replace("contact.resolution", "");
    if (const std::size_t at = content.find(" resolution="); at != std::string::npos)
        content.erase(at, content.find(" response=", at) - at);
    Scene scene(content, "dt=\"1e-6\"");
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    scene.warnings_expected = true;  // shapes that overlap
    scene.step();
    std::set<std::string> pairs;
    const world::World& world = scene.simulation().world();
    for (const auto& found : scene.simulation().stepper().touching())
    {
        std::string a = world.id_of(found.contact.a), b = world.id_of(found.contact.b);
        if (b < a) std::swap(a, b);
        pairs.insert(a + "-" + b);
    }
    std::string all;
    for (const std::string& pair : pairs) all += (all.empty() ? "" : " ") + pair;
    return all;
}

// ---- MJCF

/// A chain p-q-r on the world, a free body f; all balls overlap one another and the box of the world.
std::string overlapping(const std::string& contact = "", const std::string& of_q = "", const std::string& of_r = "",
                        const std::string& defaults = "")
{
    return "<mujoco><default><geom size='0.1' " + defaults +
           "/></default><worldbody><geom name='floor' type='box' size='1 1 0.05'/>"
           "<body name='p'><joint axis='0 1 0'/><geom name='gp'/><body name='q' pos='0.01 0 0'><joint axis='1 0 0'/><geom name='gq' " +
           of_q + "/><body name='r' pos='0.01 0 0.01'><joint axis='0 0 1'/><geom name='gr' " + of_r +
           "/></body></body></body><body name='f' pos='0 0.02 0'><freejoint/><geom name='gf'/></body></worldbody><contact>" + contact +
           "</contact></mujoco>";
}
std::string touching_of(const std::string& mjcf) { return touching(imported_text(mjcf, SceneFormat::Mjcf)); }

TEST_CASE("MJCF: all collide but parent and child, whose parent is not the world")
{
    CHECK(touching_of(overlapping()) == "f-p f-q f-r f-world p-r p-world q-world r-world");
}

TEST_CASE("MJCF: <exclude> takes out a pair of bodies, also the world's")
{
    CHECK(touching_of(overlapping("<exclude body1='p' body2='r'/><exclude body1='f' body2='q'/><exclude body1='world' body2='p'/>")) ==
          "f-p f-r f-world q-world r-world");
    const auto refused = import_robot(overlapping("<exclude body1='p' body2='nobody'/>"), SceneFormat::Mjcf);
    CHECK(reasons(refused).find("<exclude>: there is no body 'nobody'") != std::string::npos);
}

TEST_CASE("MJCF: <exclude> of a body that is a part of another one takes out its own shapes alone")
{
    const auto with = [](const std::string& excluded)
    {
        return touching_of(
            "<mujoco><worldbody><body name='a'><freejoint/><geom size='0.1'/><body name='part' pos='1 0 0'><geom size='0.1'/>"
            "</body></body><body name='b' pos='0 0.1 0'><freejoint/><geom size='0.1'/></body><body name='c' pos='1 0.1 0'>"
            "<freejoint/><geom size='0.1'/></body></worldbody><contact>" +
            excluded + "</contact></mujoco>");
    };
    CHECK(with("") == "a-b a-c");
    CHECK(with("<exclude body1='part' body2='c'/><exclude body1='part' body2='b'/>") == "a-b");
    CHECK(with("<exclude body1='a' body2='c'/><exclude body1='a' body2='b'/>") == "a-c");
}

TEST_CASE("MJCF: shapes collide if contype of one has a bit of conaffinity of the other")
{
    // Legs that collide with the world and not with one another, as in most models.
    CHECK(touching_of(overlapping("", "conaffinity='0'", "conaffinity='0'")) == "f-p f-q f-r f-world p-r p-world q-world r-world");
    CHECK(touching_of(overlapping("", "", "", "conaffinity='0'")) == "");
    CHECK(touching_of(overlapping("", "contype='2' conaffinity='2'", "contype='2' conaffinity='0'")) == "f-p f-world p-world");
    CHECK(touching_of(overlapping("", "contype='0' conaffinity='3'", "contype='2' conaffinity='0'")) == "f-p f-q f-world p-world q-world");
    CHECK(touching_of(overlapping("", "contype='0' conaffinity='0'")) == "f-p f-r f-world p-r p-world r-world");
    // A body with shapes of two kinds: one touches, the other passes.
    CHECK(touching_of("<mujoco><worldbody><geom name='floor' type='box' size='1 1 0.05' contype='2' conaffinity='2'/><body name='a'>"
                      "<freejoint/><geom size='0.1'/><geom size='0.1' pos='0.5 0 0' contype='2' conaffinity='0'/></body>"
                      "<body name='b' pos='0 0.1 0'><freejoint/><geom size='0.1'/></body>"
                      "<body name='c' pos='0.5 0.1 0'><freejoint/><geom size='0.1'/></body></worldbody></mujoco>") == "a-b a-world");
}

TEST_CASE("MJCF: <pair> collides whatever masks, exclusions and joints say")
{
    const std::string none = "contype='0' conaffinity='0'";
    CHECK(touching_of(overlapping("<pair geom1='gp' geom2='gq'/><pair geom1='gf' geom2='floor'/>", "", "", none)) == "f-world p-q");
    CHECK(touching_of(overlapping("<pair geom1='gp' geom2='gq'/>")) == "f-p f-q f-r f-world p-q p-r p-world q-world r-world");
    CHECK(touching_of(overlapping("<pair geom1='gp' geom2='gr'/><exclude body1='p' body2='r'/><exclude body1='p' body2='f'/>")) ==
          "f-q f-r f-world p-r p-world q-world r-world");
    const auto refused = import_robot(overlapping("<pair geom1='gp' geom2='nothing'/>"), SceneFormat::Mjcf);
    CHECK(reasons(refused).find("<pair>: there is no geom 'nothing'") != std::string::npos);
}

// ---- SDF

std::string sdf_model(const std::string& name, const std::string& inside, const std::string& of_a = "")
{
    const auto link = [](const std::string& id, const std::string& more)
    {
        return "<link name='" + id + "'><inertial><mass>1</mass></inertial>" + more +
               "<collision name='c'><geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link>";
    };
    const auto joint = [](const std::string& parent, const std::string& child)
    {
        return "<joint name='j" + child + "' type='revolute'><parent>" + parent + "</parent><child>" + child +
               "</child><axis><xyz>0 1 0</xyz></axis></joint>";
    };
    return "<model name='" + name + "'>" + inside + link("a", of_a) + link("b", "") + link("c", "") + joint("a", "b") + joint("b", "c") +
           "</model>";
}
std::string touching_in(const std::string& models)
{
    return touching(
        imported_text("<sdf version='1.9'><world name='w'><gravity>0 0 0</gravity>" + models + "</world></sdf>", SceneFormat::Sdf));
}
const std::string kSelf = "<self_collide>true</self_collide>";

TEST_CASE("SDF: links of a model do not collide unless one of them has self_collide; joined links never do")
{
    CHECK(touching_in(sdf_model("m", "")) == "");
    CHECK(touching_in(sdf_model("m", kSelf)) == "m::a-m::c");
    CHECK(touching_in(sdf_model("m", "", kSelf)) == "m::a-m::c");
    CHECK(touching_in(sdf_model("m", kSelf, "<self_collide>false</self_collide>")) == "m::a-m::c");  // c still has it
}

TEST_CASE("SDF: links of different models collide, also with static ones and with the link that is joined to the world")
{
    CHECK(touching_in(sdf_model("m", "") + sdf_model("n", "")) ==
          "m::a-n::a m::a-n::b m::a-n::c m::b-n::a m::b-n::b m::b-n::c m::c-n::a m::c-n::b m::c-n::c");
    CHECK(touching_in(sdf_model("m",
                                "<joint name='root' type='revolute'><parent>world</parent><child>a</child><axis><xyz>0 1 0</xyz>"
                                "</axis></joint>") +
                      "<model name='post'><static>true</static><link name='l'><collision name='c'><geometry><box><size>1 1 1</size></box>"
                      "</geometry></collision></link></model>") == "m::a-post::l m::b-post::l m::c-post::l");
}

TEST_CASE("SDF: links that a joint joins in a loop do not collide")
{
    const std::string loop = "<joint name='loop' type='ball'><parent>a</parent><child>c</child></joint>";
    CHECK(touching_in(sdf_model("m", kSelf + loop)) == "");
}

// ---- URDF

std::string urdf_chain(const std::string& more)
{
    std::string out = "<robot name='r'>" + more;
    for (const char* const link : {"a", "b", "c"})
        out += std::string("<link name='") + link +
               "'><inertial><mass value='1'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/></inertial>"
               "<collision><geometry><sphere radius='0.1'/></geometry></collision></link>";
    for (const auto& [parent, child] : {std::pair("a", "b"), std::pair("b", "c")})
        out += std::string("<joint name='j") + child + "' type='continuous'><parent link='" + parent + "'/><child link='" + child +
               "'/><axis xyz='0 1 0'/></joint>";
    return out + "</robot>";
}

TEST_CASE("URDF: links do not collide with one another unless that is asked for; joined links never do")
{
    CHECK(touching(imported_text(urdf_chain(""), SceneFormat::Urdf)) == "");
    CHECK(touching(imported_text(urdf_chain("<gazebo reference='c'><selfCollide>true</selfCollide></gazebo>"), SceneFormat::Urdf)) ==
          "a-c");
    CHECK(touching(imported_text(urdf_chain("<gazebo><self_collide>1</self_collide></gazebo>"), SceneFormat::Urdf)) == "a-c");
    import::ImportOptions options;
    options.self_collide = true;
    const auto asked = import::import_text(urdf_chain(""), "robot", SceneFormat::Urdf, options);
    REQUIRE_MESSAGE(asked.ok(), reasons(asked));
    CHECK(touching(*asked) == "a-c");
}

}  // namespace
}  // namespace plab::test
