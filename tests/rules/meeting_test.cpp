// What a rule makes when two objects meet, once, and the same in a replay, after a rewind and from a snapshot.
#include "blueprint/writer.h"
#include "rules/workbench.h"

using namespace plab;
using namespace plab::test;

namespace
{

const std::string kTwoWheels = wheel("one", 0.1, "0 0 0", "angular_velocity='3'") + wheel("two", 0.25, "0.5 0 0");

}  // namespace

TEST_CASE("two wheels that come to mesh are coupled by the ratio of their pitch radii, once")
{
    Scene s(kTwoWheels + meshing());
    serve(s);
    s.step(10);
    CHECK(!exists(s, "mesh.one.two"));
    CHECK(s.spin("two") == 0);
    set(s, "two", "position", "0.352 0 0");
    s.step();
    REQUIRE(exists(s, "mesh.one.two"));
    CHECK(s.real("mesh.one.two", "velocity_factor") == -0.1 / 0.25);
    CHECK(made_by(s, "mesh.one.two") == "mesh");
    CHECK(s.count("component.made") == 1);
    CHECK(message_of(s, "component.made") == "mesh.one.two: one and two meet");
    s.step(100);
    // Angular momentum about the teeth: J w1 + f J w2 stays, w2 = f w1.
    CHECK(near(s.spin("one"), 3 / (1 + 0.16), 1e-14));
    CHECK(near(s.spin("two"), -0.4 * s.spin("one"), 1e-14));
    CHECK(s.count("component.made") == 1);
    CHECK(std::get<std::int64_t>(s.get("mesh", "made")) == 1);
}

TEST_CASE("wheels that are already there when the scene begins are coupled before the first step")
{
    Scene s(wheel("one", 0.1, "0 0 0", "angular_velocity='3'") + wheel("two", 0.2, "0.3 0 0") + meshing());
    serve(s);
    s.step();
    CHECK(exists(s, "mesh.one.two"));
    CHECK(near(s.spin("two"), -0.5 * s.spin("one"), 1e-14));
}

TEST_CASE("tolerances: a gap, an axle that is inclined, and wheels that lie side by side do not mesh")
{
    for (const char* const place : {"position='0.306 0 0'", "position='0.3 0 0' axis='0.03 0 1'", "position='0.3 0 0.2'"})
    {
        Scene s(wheel("one", 0.1, "0 0 0") + wheel("two", 0.2, "0.3 0 0").substr(0, wheel("two", 0.2, "0.3 0 0").find(" position")) + " " +
                place + "/>" + meshing("along='0.02'"));
        serve(s);
        s.step(2);
        CHECK(!exists(s, "mesh.one.two"));
    }
}

TEST_CASE("the same run again, a rewound one, and one continued from a snapshot make the same, bit for bit")
{
    const auto move = [](Scene& s) { set(s, "two", "position", "0.351 0 0"); };
    Scene live(kTwoWheels + meshing("removes='true'")), again(kTwoWheels + meshing("removes='true'"));
    for (Scene* const s : {&live, &again}) serve(*s);
    simulation::HistoryOptions history;
    history.interval = 0.05;
    live.simulation().history().configure(history);
    REQUIRE(live.ask(simulation::ResetOperation{}).done);
    std::vector<std::uint64_t> hashes;
    simulation::Snapshot before;
    for (int n = 0; n < 60; ++n)
    {
        if (n == 20) move(live), move(again);
        if (n == 30) before = live.simulation().capture();
        if (n == 40) set(live, "two", "position", "0.5 0 0"), set(again, "two", "position", "0.5 0 0");
        live.step(), again.step();
        hashes.push_back(live.hash());
        CHECK(live.hash() == again.hash());
    }
    CHECK(!exists(live, "mesh.one.two"));
    CHECK(live.count("component.removed") == 1);

    // Back to a time at which they were coupled: made again by the rule, not by the journal.
    const auto back = live.ask(simulation::RewindOperation{30.0 / 240, false});
    REQUIRE_MESSAGE(back.done, first_error(back.errors));
    CHECK(exists(live, "mesh.one.two"));
    CHECK(made_by(live, "mesh.one.two") == "mesh");
    CHECK(live.hash() == hashes[29]);

    REQUIRE(again.simulation().restore(before).ok());
    CHECK(exists(again, "mesh.one.two"));
    for (int n = 30; n < 60; ++n)
    {
        if (n == 40) set(live, "two", "position", "0.5 0 0"), set(again, "two", "position", "0.5 0 0");
        live.step(), again.step();
        CHECK(live.hash() == hashes[static_cast<std::size_t>(n)]);
        CHECK(again.hash() == hashes[static_cast<std::size_t>(n)]);
    }
    CHECK(!exists(again, "mesh.one.two"));
}

TEST_CASE("matching by type, id and connector")
{
    const std::string parts = wheel("one", 0.1, "0 0 0") + wheel("two", 0.1, "0.2 0 0") +
                              "<component id='tag' type='Connector/Frame' object='one' kind='drive wheel'/>"
                              "<component id='other' type='Connector/Frame' object='two' kind='wheel' radius='0.05'/>";
    const auto made = [&](const std::string& more)
    {
        Scene s(parts + "<component id='r' type='Rule/Pair' reach='0.3' " + more +
                "><template><component id='${a}-${b}' type='Constraint/AngularVelocity/Graph' driver='${a}' driven='${b}' "
                "velocity_factor='${a.radius / b.radius}'/></template></component>");
        serve(s);
        s.step(2);
        if (exists(s, "one-two")) return "one-two " + std::to_string(s.real("one-two", "velocity_factor"));
        return exists(s, "two-one") ? std::string("two-one") : std::string("nothing");
    };
    CHECK(made("") == "one-two 1.000000");
    CHECK(made("a='t*'") == "two-one");
    CHECK(made("a='t*' b='t*'") == "nothing");
    CHECK(made("a_type='State/RigidBody'") == "nothing");
    CHECK(made("a_type='State/*'") == "one-two 1.000000");
    CHECK(made("b_connector='wheel'") == "one-two 2.000000");
    CHECK(made("a_connector='drive*' b_connector='wheel'") == "one-two 2.000000");
    CHECK(made("a_connector='axle' b_connector='wheel'") == "nothing");
    CHECK(made("a_shape='Shape/Sphere'") == "nothing");
}

TEST_CASE("a connector may be looser than the rule, on either side")
{
    const auto scene = [](const std::string& a, const std::string& b)
    {
        return wheel("one", 0.1, "0 0 0") + wheel("two", 0.1, "0.02 0 0.1") +
               "<component id='pin' type='Connector/Frame' object='one' kind='pin' " + a +
               "/><component id='hole' type='Connector/Frame' object='two' kind='hole' " + b +
               "/><component id='join' type='Rule/Pair' a_connector='pin' b_connector='hole' relation='coaxial' reach='0.5' tolerance='5 "
               "mm'>"
               "<template><component id='${rule}.${a}.${b}' type='Constraint/AngularVelocity/Graph' driver='${a}' driven='${b}' "
               "velocity_factor='1'/></template></component>";
    };
    const auto joins = [&](const std::string& a, const std::string& b)
    {
        Scene s(scene(a, b));
        serve(s);
        s.step(3);
        return exists(s, "join.one.two");
    };
    CHECK_FALSE(joins("", ""));
    CHECK_FALSE(joins("tolerance='19 mm'", ""));
    CHECK(joins("tolerance='21 mm'", ""));
    CHECK(joins("tolerance='1 mm'", "tolerance='21 mm'"));
}

TEST_CASE("Lua says what parameters cannot, and computes values")
{
    const std::string rule =
        "<component id='r' type='Rule/Pair' reach='1'><param name='values'><entry name='sum'>'a.radius + b.radius'</entry><entry "
        "name='factor'>0</entry></param>"
        "<param name='code'>function applies()\n state.factor = -2 * state.sum\n return driver.speed > parameters.distance end</param>"
        "<template><component id='${a}-${b}' type='Constraint/AngularVelocity/Graph' driver='${a}' driven='${b}' "
        "velocity_factor='${factor}'/></template></component>";
    Scene s(wheel("one", 0.1, "0 0 0", "angular_velocity='0.4'") + wheel("two", 0.25, "0.5 0 0") + rule);
    serve(s);
    s.step(5);
    CHECK(!exists(s, "one-two"));
    set(s, "one", "angular_velocity", "0.6");
    s.step();
    REQUIRE(exists(s, "one-two"));
    CHECK(near(s.real("one-two", "velocity_factor"), -0.7, 1e-15));
}

TEST_CASE("bad rules are refused with the place")
{
    const auto error = [](const std::string& rule) { return Scene(wheel("one", 0.1, "0 0 0") + rule).error(); };
    const auto holds = [](const std::string& text, const std::string& part) { CHECK_MESSAGE(text.find(part) != std::string::npos, text); };
    holds(error("<component id='r' type='Rule/Pair' reach='1'/>"), "template");
    holds(error("<component id='r' type='Rule/Pair' reach='1'><template><compnent/></template></component>"), "<template>");
    holds(
        error(
            "<component id='r' type='Rule/Pair' reach='1'><template><component id='x' typ='y'><param/></component></template></component>"),
        "name");
    holds(error("<component id='r' type='Rule/Pair' reach='1'><template><component id='x' type='${a'/></template></component>"),
          "'${' is not closed");
    holds(error("<component id='r' type='Rule/Pair' reach='1'><template><component id='x' f='${1 +}'/></template></component>"),
          "a number or a name is missing");
    holds(error("<component id='r' type='Rule/Pair' reach='1' relation='meting'><template><component id='x'/></template></component>"),
          "relation");
    holds(error("<component id='r' type='Rule/Pair' reach='1' code='function aplies() end'><template><component "
                "id='x'/></template></component>"),
          "applies() is not defined");
}

TEST_CASE("a template that cannot be filled, or whose component is refused, is told once, and does not stop the scene")
{
    Scene s(kTwoWheels +
            "<component id='r' type='Rule/Pair' reach='1'>\n<template>\n<component id='${a}-${b}' type='Constraint/AngularVelocity/Graph'\n"
            "driver='${a}' driven='${b}' velocity_factor='${a.speed_of_light}'/></template></component>");
    serve(s);
    s.warnings_expected = true;
    s.step(5);
    CHECK(s.count("rule.refused") == 1);
    CHECK(message_of(s, "rule.refused") == "one and two: template: ${a.speed_of_light}: neither object, connector nor shape has it");

    Scene t(kTwoWheels +
            "<component id='r' type='Rule/Pair' reach='1'>\n<template>\n<component id='${a}-${b}' type='Constraint/Gear'\n"
            "a='${a}' b='nobody'/></template></component>");
    serve(t);
    t.warnings_expected = true;
    t.step(5);
    CHECK(t.count("decide.refused") == 1);
    CHECK_MESSAGE(message_of(t, "decide.refused").find(":3:") != std::string::npos, message_of(t, "decide.refused"));
}

TEST_CASE("a condition that fails quarantines its rule, and says where")
{
    Scene s(kTwoWheels +
            "<component id='r' type='Rule/Pair' reach='1'><param name='code'>\nfunction applies()\n return nothing.here\nend</param>"
            "<template><component id='${a}-${b}' type='Constraint/Gear' driver='${a}' driven='${b}'/></template></component>");
    serve(s);
    s.warnings_expected = true;
    s.step(5);
    CHECK(s.count("rule.failed") == 1);
    CHECK_MESSAGE(message_of(s, "rule.failed").find("code:3:") != std::string::npos, message_of(s, "rule.failed"));
    CHECK(!exists(s, "one-two"));
}

TEST_CASE("a condition is sandboxed: it ends, reaches nothing outside, and remembers nothing that a snapshot would lack")
{
    const auto message = [](const std::string& code)
    {
        Scene s(
            kTwoWheels + "<component id='r' type='Rule/Pair' reach='1'><param name='code'>" + code +
            "</param><template><component id='${a}-${b}' type='Constraint/AngularVelocity/Graph' driver='${a}' driven='${b}'/></template>"
            "</component>");
        serve(s);
        s.warnings_expected = true;
        s.step(5);
        CHECK(!exists(s, "one-two"));
        CHECK(near(s.simulation().time(), 5.0 / 240, 1e-12));
        return message_of(s, "rule.failed");
    };
    CHECK_MESSAGE(message("function applies() while true do end end").find("budget") != std::string::npos,
                  message("function applies() while true do end end"));
    CHECK(message("function applies() return io.open('/etc/passwd') ~= nil end").find("io") != std::string::npos);
    CHECK(message("function applies() return os.time() > 0 end").find("os") != std::string::npos);
    // A count that no snapshot holds would let a run that continues decide otherwise.
    const std::string counts = message("count = 0\nfunction applies() count = count + 1 return count > 3 end");
    CHECK_MESSAGE(!counts.empty(), "it counts in a global");
    const std::string closure = message("local seen = {}\nfunction applies() seen[#seen + 1] = 1 return #seen > 3 end");
    CHECK_MESSAGE(!closure.empty(), "it counts in a table");
}

TEST_CASE("the long form has the template as an element, and gives the same rule")
{
    const std::string text = whole_scene(kTwoWheels + meshing(), "dt='1/240'");
    const auto scene = compile_text(text);
    REQUIRE(scene.ok());
    const std::string long_form = blueprint::write_long_form(*scene, library());
    CHECK(long_form.find("<template><component id=\"${rule}.${a}.${b}\"") != std::string::npos);
    const auto again = compile_read(blueprint::read_blueprint(long_form, "long.xml"));
    REQUIRE_MESSAGE(again.ok(), reasons(again));
    Scene s("");
    REQUIRE(s.simulation().load(*again).ok());
    serve(s);
    set(s, "two", "position", "0.352 0 0");
    s.step();
    CHECK(exists(s, "mesh.one.two"));
}

TEST_CASE("a template is one component, of the blueprint's grammar, with the places of its own errors")
{
    const auto error = [](const std::string& inside)
    { return Scene("<component id='r' type='Rule/Pair' reach='1'><template>\n" + inside + "</template></component>").error(); };
    for (const auto& [inside, why] : {std::pair("<component id='x'/><component id='y'/>", "holds one <component>"),
                                      std::pair("text", "holds text"), std::pair("<repeat count='2'/>", "holds one <component>"),
                                      std::pair("\n<component id='x'>stray<param name='p'>1</param></component>", ":3:"),
                                      std::pair("<component id='x'><param nam='p'>1</param></component>", ":2:")})
        CHECK_MESSAGE(error(inside).find(why) != std::string::npos, error(inside));
}
