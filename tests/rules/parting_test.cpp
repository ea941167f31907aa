// What happens when two objects part, which of two rules gets a pair, and what is refused.
#include "rules/workbench.h"

using namespace plab;
using namespace plab::test;

namespace
{

std::string near_rule(const std::string& id, const std::string& more, const std::string& factor)
{
    return "<component id='" + id + "' type='Rule/Pair' reach='0.5' " + more + "><template><component id='${rule}.${a}.${b}' " +
           "type='Constraint/AngularVelocity/Graph' driver='${a}' driven='${b}' velocity_factor='" + factor + "'/></template></component>";
}

const std::string kWheels = wheel("one", 0.1, "0 0 0", "angular_velocity='3'") + wheel("two", 0.1, "1 0 0");

std::string makers(const Scene& s)
{
    std::string out;
    for (const model::ComponentSpec& c : s.simulation().world().scene().components)
        if (!c.made_by.empty()) out += (out.empty() ? "" : " ") + c.id;
    return out;
}

}  // namespace

TEST_CASE("what was made is removed when the two part beyond the bounds times hold, and made again when they meet again")
{
    Scene s(kWheels + near_rule("r", "removes='true' hold='1.2'", "1"));
    serve(s);
    set(s, "two", "position", "0.4 0 0");
    s.step(2);
    CHECK(makers(s) == "r.one.two");
    set(s, "two", "position", "0.59 0 0");
    s.step(2);
    CHECK(makers(s) == "r.one.two");
    set(s, "two", "position", "0.61 0 0");
    s.step(2);
    CHECK(makers(s) == "");
    CHECK(message_of(s, "component.removed") == "r.one.two: one and two have parted");
    set(s, "two", "position", "0.55 0 0");
    s.step(2);
    CHECK(makers(s) == "");
    set(s, "two", "position", "0.45 0 0");
    s.step(2);
    CHECK(makers(s) == "r.one.two");
    CHECK(s.count("component.made") == 2);
    CHECK(std::get<std::int64_t>(s.get("r", "made")) == 2);
}

TEST_CASE("without `removes` it stays")
{
    Scene s(kWheels + near_rule("r", "", "1"));
    serve(s);
    set(s, "two", "position", "0.4 0 0");
    s.step(2);
    set(s, "two", "position", "4 0 0");
    s.step(2);
    CHECK(makers(s) == "r.one.two");
}

TEST_CASE("what a client removes is not made again before the two have parted")
{
    Scene s(kWheels + near_rule("r", "", "1"));
    serve(s);
    set(s, "two", "position", "0.4 0 0");
    s.step(2);
    REQUIRE(s.ask(simulation::RemoveOperation{"r.one.two"}).done);
    s.step(10);
    CHECK(makers(s) == "");
    set(s, "two", "position", "1 0 0");
    s.step();
    set(s, "two", "position", "0.4 0 0");
    s.step();
    CHECK(makers(s) == "r.one.two");
}

TEST_CASE(
    "of two rules with the same slot the higher priority gets the pair, at the same priority the smaller id; other slots do not count")
{
    const auto winner = [](const std::string& first, const std::string& second)
    {
        Scene s(kWheels + near_rule("r1", first, "1") + near_rule("r2", second, "1"));
        serve(s);
        set(s, "two", "position", "0.4 0 0");
        s.step(20);
        return makers(s);
    };
    CHECK(winner("", "") == "r1.one.two");
    CHECK(winner("priority='1'", "priority='2'") == "r2.one.two");
    CHECK(winner("priority='-1'", "priority='-2'") == "r1.one.two");
    CHECK(winner("", "priority='2' b='three'") == "r1.one.two");  // it does not match
    CHECK(winner("slot='x'", "slot='y'") == "r1.one.two r2.one.two");
}

TEST_CASE("a pair stays with the rule that has it, whatever comes later")
{
    Scene s(kWheels + near_rule("r1", "", "1"));
    serve(s);
    set(s, "two", "position", "0.4 0 0");
    s.step(2);
    const auto text = blueprint::read_blueprint("<plab version='1'>" + near_rule("r2", "priority='9'", "-1") + "</plab>", "more.xml");
    REQUIRE(text.ok());
    REQUIRE(s.ask(simulation::AddBlueprintOperation{*text}).done);
    s.step(5);
    CHECK(makers(s) == "r1.one.two");
}

TEST_CASE("a loop of gears that cannot turn: the one that would close it is refused by name, and told; the rest turns")
{
    // Three equal wheels that mesh with one another: w2 = -w1, w3 = -w2, w1 = -w3.
    Scene s(wheel("one", 0.1, "0 0 0", "angular_velocity='3'") + wheel("two", 0.1, "0.2 0 0") +
            wheel("three", 0.1, "0.1 0.1732050807568877 0") + meshing());
    serve(s);
    s.warnings_expected = true;
    s.step(20);
    CHECK(makers(s) == "mesh.one.three mesh.one.two");
    CHECK(s.count("decide.refused") == 1);
    const std::string why = message_of(s, "decide.refused");
    CHECK_MESSAGE(why.find("mesh.three.two") != std::string::npos, why);
    CHECK(near(s.spin("one"), 1, 1e-14));
    CHECK(near(s.spin("three"), -1, 1e-14));
}

TEST_CASE("with `couples`, a rule refuses such a loop itself, also where the host could not know: gears of bodies")
{
    std::string text = meshing("couples='-a.radius / b.radius'");
    text.replace(text.find("Constraint/AngularVelocity/Graph"), 32, "Constraint/Gear");
    const auto body = [](const std::string& id, const std::string& at)
    {
        return "<component id='" + id + "_form' type='Shape/Gear' pitch_radius='0.1' teeth='20' width='0.02'/><component id='" + id +
               "' type='State/RigidBody' mass='1' inertia='0.01 0.01 0.01' shape='" + id + "_form' position='" + at + "'/>";
    };
    Scene s(body("one", "0 0 0") + body("two", "0.2 0 0") + body("three", "0.1 0.1732050807568877 0") + text);
    serve(s);
    s.warnings_expected = true;
    s.step(20);
    CHECK(makers(s) == "mesh.one.three mesh.one.two");
    CHECK(s.count("rule.refused") == 1);
    CHECK(message_of(s, "rule.refused") ==
          "three and two: a loop that cannot turn: two would make -1 turns per turn of three, but makes 1 by mesh.one.three, mesh.one.two");
}

TEST_CASE("at most so many pairs for one side")
{
    Scene s(wheel("hub", 0.1, "0 0 0") + wheel("p", 0.1, "0.1 0 0") + wheel("q", 0.1, "0.2 0 0") +
            near_rule("r", "a='hub' b='p q' a_most='1'", "1"));
    serve(s);
    s.step(5);
    CHECK(makers(s) == "r.hub.p");
}

TEST_CASE("a rule that can take no more pairs leaves them to the next one, whatever its priority")
{
    Scene s(wheel("hub", 0.1, "0 0 0") + wheel("p", 0.1, "0.1 0 0") + wheel("q", 0.1, "0.2 0 0") +
            near_rule("first", "a='hub' b='p q' a_most='1' priority='2'", "1") + near_rule("second", "a='hub' b='p q' priority='1'", "-1"));
    serve(s);
    s.step(5);
    CHECK(makers(s) == "first.hub.p second.hub.q");
}
