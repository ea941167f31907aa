#include <doctest/doctest.h>

#include <algorithm>

#include "blueprint/reader.h"
#include "blueprint/writer.h"
#include "model/compile.h"
#include "support/sample_types.h"

using namespace plab;
using model::ComponentSpec;
using model::SceneSpec;

namespace
{

SceneSpec load(const std::string& text)
{
    test::SampleTypes types;
    const auto blueprint = blueprint::read_blueprint(text, "w.xml");
    REQUIRE_MESSAGE(blueprint.ok(), (blueprint.ok() ? "" : blueprint.error().text()));
    auto scene = model::compile(*blueprint, types);
    REQUIRE_MESSAGE(scene.ok(), (scene.ok() ? "" : scene.error().text()));
    return scene.take();
}

/// Commands that are selected, in the order of their declaration. Those that always run (Init) count where they are listed.
std::vector<std::string> active_commands(const ComponentSpec& c, test::SampleTypes& types)
{
    std::vector<std::string> out;
    if (c.type.empty()) return out;
    const auto type = types.require(c.type);
    REQUIRE(type.ok());
    for (const CommandInfo& command : (*type)->info.commands)
    {
        const bool chosen = std::find(c.commands.begin(), c.commands.end(), command.name) != c.commands.end();
        const bool by_default = !c.explicit_commands && stage_of(command.phase) != Stage::Init;
        if (command.phase != Phase::Measure && ((chosen && c.explicit_commands) || by_default)) out.push_back(command.name);
    }
    return out;
}

void check_same(const SceneSpec& a, const SceneSpec& b)
{
    CHECK(a.settings.dt.seconds == b.settings.dt.seconds);
    CHECK(a.settings.dt.numerator == b.settings.dt.numerator);
    CHECK(a.settings.dt.denominator == b.settings.dt.denominator);
    CHECK(a.settings.seed == b.settings.seed);
    CHECK(a.settings.title == b.settings.title);
    CHECK(a.settings.solver == b.settings.solver);
    REQUIRE(a.settings.cameras.size() == b.settings.cameras.size());
    for (std::size_t i = 0; i < a.settings.cameras.size(); ++i)
    {
        CHECK(a.settings.cameras[i].name == b.settings.cameras[i].name);
        CHECK(a.settings.cameras[i].position == b.settings.cameras[i].position);
        CHECK(a.settings.cameras[i].field_of_view == b.settings.cameras[i].field_of_view);
    }
    REQUIRE(a.components.size() == b.components.size());
    test::SampleTypes types;
    for (const ComponentSpec& x : a.components)
    {
        CAPTURE(x.id);
        const ComponentSpec* y = b.find(x.id);
        REQUIRE(y);
        CHECK(x.name == y->name);
        CHECK(x.type == y->type);
        CHECK(x.parent == y->parent);
        CHECK(x.alias_of == y->alias_of);
        CHECK(x.group == y->group);
        REQUIRE(x.fields.size() == y->fields.size());
        for (std::size_t k = 0; k < x.fields.size(); ++k)
        {
            CHECK(x.fields[k].name == y->fields[k].name);
            CHECK(x.fields[k].value == y->fields[k].value);
        }
        REQUIRE(x.roles.size() == y->roles.size());
        for (std::size_t k = 0; k < x.roles.size(); ++k)
        {
            CHECK(x.roles[k].name == y->roles[k].name);
            CHECK(x.roles[k].members == y->roles[k].members);
            CHECK(x.roles[k].everyone == y->roles[k].everyone);
            CHECK(x.roles[k].patterns == y->roles[k].patterns);
        }
        CHECK(active_commands(x, types) == active_commands(*y, types));
    }
}

/// The long form of a scene, after checking that it is equivalent and is its own long form.
std::string round_trip(const std::string& text)
{
    test::SampleTypes types;
    const SceneSpec scene = load(text);
    const std::string once = blueprint::write_long_form(scene, types);
    CAPTURE(once);
    const SceneSpec again = load(once);
    check_same(scene, again);
    CHECK(blueprint::write_long_form(again, types) == once);
    return once;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

std::string in_plab(const std::string& body) { return "<plab version='1'>" + body + "</plab>"; }

}  // namespace

TEST_CASE("the long form of an empty scene")
{
    CHECK(round_trip(in_plab("")) ==
          "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<plab version=\"1\">\n"
          "  <scene dt=\"1/240\" seed=\"1\"/>\n</plab>\n");
}

TEST_CASE("generated components, defaults of roles and commands are written out")
{
    const std::string text =
        round_trip(in_plab("<component id='ball' type='State/RigidBody' mass='2' position='0.1 -0 1e-300'>"
                           "<component id='ball.shape' type='Shape/Sphere' radius='5 cm'/></component>"
                           "<component id='floor' type='State/Static'/>"
                           "<component id='contact' type='CDetection/ODE' between='ball floor'/>"));
    CHECK(contains(text, "<component id=\"contact.resolution\" type=\"Resolution/Bisection\"/>"));
    CHECK(contains(text,
                   "<component id=\"contact\" type=\"CDetection/ODE\" between=\"ball floor\" resolution=\"contact.resolution\" "
                   "response=\"contact.response\">"));
    CHECK(contains(text, "<component id=\"solver\" type=\"Solver/Automatic\">"));
    CHECK(contains(text, "<param name=\"position\">0.1 -0 "));
    CHECK(contains(text, "<param name=\"radius\">0.05</param>"));
    CHECK(contains(text,
                   "    <command name=\"contact/Simulation\">\n"
                   "      <command name=\"Stage/Step\">\n"
                   "        <command subject=\"contact\" type=\"CDetection/Update\"/>\n"
                   "      </command>\n"
                   "      <command name=\"Stage/PostStep\">\n"
                   "        <command subject=\"contact\" type=\"CDetection/Handle\"/>\n"
                   "        <command subject=\"contact.resolution\" type=\"Resolution/Locate\"/>\n"
                   "        <command subject=\"contact.response\" type=\"Response/Respond\"/>\n"
                   "      </command>\n"
                   "    </command>\n"));
    CHECK(!contains(text, "Shape/Prepare"));
}

TEST_CASE("numbers are written without loss of bits")
{
    round_trip(
        in_plab("<scene dt='0.0123456789' seed='18446744073709551615'><camera id='c' position='0.1 0.2 0.3' field_of_view='33 "
                "deg'/></scene>"
                "<component id='b' type='State/RigidBody' mass='0.1 g' inertia='1.1 2.2 3.3 0.01 -0.02 0.030000000000000002' "
                "orientation='axis 1 2 3 10 deg' position='9.9999999999999997e99 5e-324 -0.3333333333333333'/>"
                "<component id='s' type='State/Shaft' inertia='0.7' axis='1 1 1' angle='370 deg' prescribed='true'/>"
                "<component id='r' type='Response/Impulse' friction='inf'/>"));
}

TEST_CASE("objects, groups, sharing and names")
{
    const std::string text =
        round_trip(in_plab("<component id='a' name='the &lt;first&gt; &amp; \"best\"'><component id='a.state' "
                           "type='State/Static'/></component>"
                           "<component id='alias'><compref>a</compref></component>"
                           "<component id='both'><compref>a</compref><compref>other state</compref></component>"
                           "<component id='other state' type='State/Static'/><component id='third' type='State/Static'/>"
                           "<component id='g' type='Field/Gravity' between='*'/>"
                           "<component id='h' type='Field/Gravity'><param name='between'><compref>third</compref><compref>other "
                           "state</compref></param></component>"));
    CHECK(contains(text, "<component id=\"both\">\n    <compref>a</compref>\n    <compref>other state</compref>\n  </component>"));
    CHECK(contains(text, "between=\"*\""));
    CHECK(contains(text,
                   "<param name=\"between\">\n      <compref>other state</compref>\n      <compref>third</compref>\n   "
                   " </param>"));
}

TEST_CASE("members whose list would read as another id are written one by one")
{
    const std::string text =
        round_trip(in_plab("<component id='a' type='State/Static'/><component id='b' type='State/Static'/>"
                           "<component id='a b' type='State/Static'/><component id='g' type='Field/Gravity'>"
                           "<param name='between'><compref>a</compref><compref>b</compref></param></component>"));
    CHECK(contains(text, "<compref>b</compref>"));
}

TEST_CASE("patterns of ids are written as patterns")
{
    const std::string bodies = "<component id='b 1' type='State/Static'/><component id='b2' type='State/Static'/>";
    CHECK(contains(round_trip(in_plab(bodies + "<component id='g' type='Field/Gravity' between='b2 b*'/>")), "between=\"b* b2\""));
    const std::string apart = round_trip(in_plab(bodies + "<component id='g' type='Field/Gravity'><param name='between'>"
                                                          "<compref>b?</compref><compref>b 1</compref></param></component>"));
    CHECK(contains(apart, "<compref>b?</compref>\n      <compref>b 1</compref>"));
}

TEST_CASE("texts and entries: literal code, quotes, line ends")
{
    round_trip(
        in_plab("<component id='s' type='Script/Lua'><param name='code'>\n  if a &lt; b and c > d then\r\n\tx = ']]&gt;' end "
                "&#13;\n</param>"
                "<state name='n'>-0.1</state><state name='on'>true</state><state name='word'>\" a&lt;b &amp; 'c' \"</state>"
                "<state name='digits'>\"12\"</state></component>"));
    const std::string empty = round_trip(in_plab("<component id='s' type='Script/Lua' code=''><param name='state'/></component>"));
    CHECK(contains(empty, "<param name=\"state\"></param>"));
}

TEST_CASE("meshes are written as XGL")
{
    const std::string text =
        round_trip(in_plab("<component id='m'><MESH><P ID='a'>0,0,0.1</P><P ID='b'>1,0,0</P><P ID='c'>0,1,0</P>"
                           "<F><FV1><PREF>a</PREF></FV1><FV2><PREF>c</PREF></FV2><FV3><PREF>b</PREF></FV3></F></MESH></component>"));
    CHECK(contains(text, "<P ID=\"1\">0, 0, 0.1</P>"));
    CHECK(contains(text, "<F><FV1><PREF>1</PREF></FV1><FV2><PREF>3</PREF></FV2><FV3><PREF>2</PREF></FV3></F>"));
    CHECK(!contains(round_trip(in_plab("<component id='m' type='Shape/Mesh' vertices='0 0' triangles='1'/>")), "<MESH>"));
}

TEST_CASE("a simulation command that leaves commands out still does so")
{
    const std::string objects =
        "<component id='b'><component id='b.state' type='State/RigidBody'>"
        "<component id='b.shape' type='Shape/Sphere' radius='1'/></component>";
    const std::string text =
        round_trip(in_plab(objects + "<command name='B/Simulation'><command name='Stage/Rewind'>"
                                     "<command subject='b.state' type='State/Restore'/></command></command></component>"));
    CHECK(!contains(text, "Shape/Draw"));
    CHECK(contains(text, "type=\"State/Restore\""));
    const std::string nothing =
        round_trip(in_plab(objects + "<command name='B/Simulation'><command name='Stage/Init'/></command></component>"));
    CHECK(!contains(nothing, "State/Restore"));
    const std::string all = round_trip(in_plab(objects + "</component>"));
    CHECK(contains(all, "Shape/Draw"));
}

TEST_CASE("the paper's figures 6 and 7 in long form")
{
    const std::string text =
        round_trip(in_plab("<component id='20'><component id='200' type='State/Shaft' inertia='1'/></component>"
                           "<component id='21'><component id='201' type='State/Shaft' inertia='1'/><command id='202' "
                           "subject='201' type='State/Restore'/></component>"
                           "<component id='c'><component id='52' type='Constraint/AngularVelocity/Graph' driver='20'/>"
                           "<command id='01' name='ExampleConstraint/Simulation'><command name='Stage/Step'>"
                           "<command subject='52' type='Constraint/AngularVelocity'/>"
                           "<cmdparam type='SetTargetState'><udata><cmdref>202</cmdref></udata></cmdparam>"
                           "<cmdparam type='SetVelocityFactor'><udata>-0.5</udata></cmdparam></command></command></component>"
                           "<component id='hello'><command id='300' name='Hello' type='Script/Lua'><cmdparam type='SetCode'>"
                           "<udata>emit('hello')</udata></cmdparam></command></component>"));
    CHECK(contains(text, "<component id=\"52\" type=\"Constraint/AngularVelocity/Graph\" driver=\"200\" driven=\"201\">"));
    CHECK(contains(text, "<param name=\"velocity_factor\">-0.5</param>"));
    CHECK(contains(text, "<component id=\"300\" name=\"Hello\" type=\"Script/Lua\">"));
}

TEST_CASE("repetitions are written out")
{
    const std::string text =
        round_trip(in_plab("<repeat id='row' count='3' step='0.1 0 0'><component id='b' type='State/RigidBody'/></repeat>"));
    CHECK(contains(text, "<component id=\"b.2\" type=\"State/RigidBody\" solver=\"solver\">"));
    CHECK(contains(text, "<param name=\"position\">0.2 0 0</param>"));
}

TEST_CASE("characters that XML cannot hold are replaced, the others escaped")
{
    CHECK(blueprint::escape_text("a<b>&\"c\"\r\n\t") == "a&lt;b&gt;&amp;\"c\"&#13;\n\t");
    CHECK(blueprint::escape_attribute("a<b>&\"c\"\r\n\t") == "a&lt;b&gt;&amp;&quot;c&quot;&#13;&#10;&#9;");
    CHECK(blueprint::escape_text(std::string("x\0y\x1f", 4)) == "x\xEF\xBF\xBDy\xEF\xBF\xBD");
}

TEST_CASE("the reference manual has every type with fields, roles, commands and properties")
{
    test::SampleTypes types;
    const std::string manual = blueprint::write_reference(types);
    for (const std::string& name : types.names()) CHECK(contains(manual, "\n### " + name + "\n"));
    CHECK(contains(manual, "\n### Constraint/AngularVelocity/Graph\n\nkeeps a ratio of speeds\n"));
    CHECK(contains(manual, "| `velocity_factor` | param | number |  | required | not zero | turns of driven per turn of driver |"));
    CHECK(contains(manual, "| `acceleration` | param | vector | m/s^2 | `0 0 -9.81` |  | of free fall |"));
    CHECK(contains(manual, "| `restitution` | param | number |  | `1` | at least 0, at most 1 | Newton's coefficient |"));
    CHECK(contains(manual, "| `space` | param | text |  | `hash` | one of simple, hash, sweep | broad phase |"));
    CHECK(contains(manual, "| `friction` | param | number |  | `0` | at least 0, may be infinite | Coulomb's coefficient |"));
    CHECK(contains(manual, "| `driven` | shaft | 1 | acts on it | is turned |"));
    CHECK(contains(manual, "| `response` | component `Response/...` | 1 | reads it | pushes apart; by default a `Response/Impulse` |"));
    CHECK(contains(manual, "| `Solver/Advance` | Step | advance | advances its group |"));
    CHECK(contains(manual, "- order of convergence: 4\n- cost: 4 force evaluations\n"));
    CHECK(contains(manual, "- exchangeable within: `State/Body`\n"));
}

TEST_CASE("an id of the largest length")
{
    const std::string id(200, 'x');
    CHECK(contains(round_trip(in_plab("<component id='" + id + "' type='State/Static'/>")), "<command name=\"Simulation\">"));
}
