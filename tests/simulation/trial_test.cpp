// How a swap is checked: trial steps of the objects that it can affect, within a budget, and the refusal of swaps that add energy.
#include <chrono>
#include <cmath>
#include <cstdio>

#include "simulation/requests/request_words.h"
#include "support/scene.h"

using namespace plab;
using namespace plab::simulation;
using plab::test::first_error;
using plab::test::Scene;

namespace
{

Reply ask(Scene& s, std::vector<Operation> operations, TrialChoice trial = {})
{
    Request request;
    request.operations = std::move(operations), request.trial = trial;
    return s.simulation().carry_out_now(request);
}

TrialChoice budget(double ms, bool must = false)
{
    TrialChoice out;
    out.budget = TrialChoice::Budget::Given, out.ns = 1e6 * ms, out.must = must;
    return out;
}
TrialChoice no_trial()
{
    TrialChoice out;
    out.budget = TrialChoice::Budget::None;
    return out;
}

std::string numbered(const char* format, int i)
{
    char text[512];
    std::snprintf(text, sizeof text, format, i, i, i, i, i, i);
    return text;
}

/// Trains of gears beside balls that rest on a floor.
std::string gears_and_balls(int trains, int balls)
{
    std::string out = R"(<component id="f" type="Shape/Plane"/><component id="ground" type="State/Static" shape="f"/>
      <component id="r" type="Shape/Sphere" radius="0.1"/><component id="g" type="Field/Gravity" between="*"/>)";
    for (int i = 0; i < trains; ++i)
        out += numbered(
            R"(<component id="in%d" type="State/Shaft" inertia="1" angular_velocity="3"/><component id="out%d" type="State/Shaft" inertia="2"/>
          <component id="gears.%d" type="Constraint/AngularVelocity/Graph" driver="in%d" driven="out%d" velocity_factor="0.5"/>)",
            i);
    for (int i = 0; i < balls; ++i)
    {
        char text[256];
        std::snprintf(text, sizeof text, R"(<component id="b%03d" type="State/RigidBody" mass="1" shape="r" position="%d %d 0.1"/>)", i,
                      i % 20, i / 20);
        out += text;
    }
    return out + R"(<component id="c" type="CDetection/ODE" between="*" resolution="Resolution/None" response="Response/Rows"/>)";
}

const char* const kImpulse = "Constraint/AngularVelocity/Impulse";

}  // namespace

TEST_CASE("a trial steps the objects that the swap can affect, and no others")
{
    Scene s(gears_and_balls(3, 40));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(20);
    const Reply gear = ask(s, {SwapOperation{"gears.1", kImpulse, {}}});
    REQUIRE_MESSAGE(gear.done, first_error(gear.errors));
    CHECK(gear.trial.outcome == TrialReport::Outcome::Made);
    CHECK(gear.trial.objects == 2);
    CHECK(!gear.trial.everything);
    // Energies are those of the train: 1/2 1 w^2 + 1/2 2 (w/2)^2, with w from the 3 rad/s that were shared.
    const double w = s.spin("in1");
    CHECK(gear.swaps[0].energy_before == doctest::Approx(0.5 * w * w + 0.25 * w * w).epsilon(1e-12));
    CHECK(gear.swaps[0].with_new.energy == doctest::Approx(gear.swaps[0].energy_before).epsilon(1e-9));
    // Another response affects all bodies that collide.
    const Reply response = ask(s, {SwapOperation{"c.response", "Response/Impulse", {}}});
    REQUIRE_MESSAGE(response.done, first_error(response.errors));
    CHECK(response.trial.objects == 40);
}

TEST_CASE("a trial of an addition steps what is new and what it can touch; with a new fixed body, or a part, it steps everything")
{
    Scene s(gears_and_balls(3, 40));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(20);
    const auto add = [&](const std::string& text)
    {
        const auto fragment = test::compile_text(test::whole_scene(text), "request.xml", &s.simulation().world().scene());
        REQUIRE_MESSAGE(fragment.ok(), test::reasons(fragment));
        const Reply reply = ask(s, {AddOperation{*fragment}});
        REQUIRE_MESSAGE(reply.done, first_error(reply.errors));
        CHECK(reply.trial.outcome == TrialReport::Outcome::Made);
        return reply.trial;
    };
    const std::string ball = "type=\"State/RigidBody\" mass=\"1\" shape=\"r\" position=";
    const TrialReport far = add("<component id=\"far\" " + ball + "\"0 0 5\"/>");
    CHECK(far.objects == 1);
    CHECK(!far.everything);
    // It stands in b000, which is found out in the step.
    const TrialReport near = add("<component id=\"near\" " + ball + "\"0 0 0.29\"/>");
    CHECK(near.objects == 2);
    const TrialReport wind = add("<component id=\"wind\" type=\"Field/Drag\" between=\"b001 b002\" linear=\"0.1\"/>");
    CHECK(wind.objects == 2);
    CHECK(add("<component id=\"shelf\" type=\"State/Static\" shape=\"f\" position=\"0 0 -1\"/>").everything);
    CHECK(add("<component id=\"manager\" type=\"Manager/Direct\"/>").everything);
}

TEST_CASE("a trial leaves no trace: with it and without it the run has the same bits")
{
    Scene with(gears_and_balls(3, 40)), without(gears_and_balls(3, 40));
    with.step(20), without.step(20);
    const auto both = [&](const std::string& id, const std::string& type)
    {
        CAPTURE(id);
        CHECK(ask(with, {SwapOperation{id, type, {}}}).done);
        CHECK(ask(without, {SwapOperation{id, type, {}}}, no_trial()).done);
        CHECK(with.hash() == without.hash());
        for (int i = 0; i < 10; ++i)
        {
            with.step(), without.step();
            REQUIRE(with.hash() == without.hash());
        }
    };
    both("gears.0", kImpulse);
    both("c.response", "Response/Penalty");
    both("b003", "State/Kinematic");
    both("c.response", "Response/Rows");
    both("gears.0", "Constraint/AngularVelocity/Graph");
    both("g", "Field/Gravity");
}

TEST_CASE("a body that is hit in the trial's step takes part in it")
{
    // b hits c, which is at rest on its own, within the next step.
    Scene s(R"(<component id="r" type="Shape/Sphere" radius="0.1"/>
      <component id="a" type="State/RigidBody" mass="1" shape="r" position="-0.5 0 0" linear_velocity="100 0 0"/>
      <component id="b" type="State/RigidBody" mass="1" shape="r"/>
      <component id="other" type="State/RigidBody" mass="1" shape="r" position="9 0 0"/>
      <component id="push" type="Field/Load" between="a" force="1 0 0"/>
      <component id="c" type="CDetection/ODE" between="*" resolution="Resolution/LocalRoot" response.restitution="1"/>)");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const Reply reply = ask(s, {SwapOperation{"push", "Field/Load", {{"force", std::string("2 0 0")}}}});
    REQUIRE_MESSAGE(reply.done, first_error(reply.errors));
    CHECK(reply.trial.objects == 2);
    // Both after the impact: the momentum is that of a, and of the push.
    CHECK(reply.swaps[0].with_new.momentum.x == doctest::Approx(100 + 2.0 / 240).epsilon(1e-12));
    CHECK(reply.swaps[0].with_new.energy == doctest::Approx(5000).epsilon(1e-3));
}

TEST_CASE("a trial that exceeds its budget is abandoned: the swap is carried out without it, or refused, as requested")
{
    // The first spring is slack, the second one swings a million times in a step of 100 s.
    const std::string scene = R"(<component id="r" type="Shape/Sphere" radius="0.1"/>
      <component id="a" type="State/RigidBody" mass="1" shape="r" position="1 0 0"/><component id="b" type="State/RigidBody" mass="1" shape="r"/>
      <component id="s" type="Constraint/SpringDamper" a="a" b="b" length="0.5" stiffness="0"/>
      <component id="solver" type="Solver/DormandPrince54" max_substeps="10000000"/>)";
    const std::string settings = "dt=\"100\" solver=\"solver\"";
    Scene s(scene, settings), refused(scene, settings);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(3), refused.step(3);
    const std::uint64_t before = refused.hash();
    const auto swap = [](const char* stiffness) {
        return SwapOperation{"s", "Constraint/SpringDamper", {{"stiffness", std::string(stiffness)}}};
    };
    const Reply no = ask(refused, {swap("1e9")}, budget(20, true));
    CHECK(!no.done);
    CHECK_MESSAGE(first_error(no.errors).find("budget of 20 ms") != std::string::npos, first_error(no.errors));
    CHECK(no.trial.outcome == TrialReport::Outcome::GivenUp);
    CHECK(no.pause_ns < 500e6);
    CHECK(refused.hash() == before);
    refused.step();
    const Reply yes = ask(s, {swap("1e9")}, budget(20));
    REQUIRE_MESSAGE(yes.done, first_error(yes.errors));
    CHECK(yes.trial.outcome == TrialReport::Outcome::GivenUp);
    CHECK(yes.trial.budget_ns == 20e6);
    CHECK(yes.pause_ns < 500e6);
    CHECK(std::isnan(yes.swaps[0].with_new.energy));
    CHECK(s.real("s", "stiffness") == 1e9);
    const Reply none = ask(s, {swap("0")}, no_trial());
    CHECK(none.done);
    CHECK(none.trial.outcome == TrialReport::Outcome::None);
}

TEST_CASE("one request exchanges all components that a pattern names, as one transaction")
{
    Scene s(gears_and_balls(12, 0)), one_by_one(gears_and_balls(12, 0));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(5), one_by_one.step(5);
    const Reply all = ask(s, {SwapOperation{"gears.*", kImpulse, {}}});
    REQUIRE_MESSAGE(all.done, first_error(all.errors));
    REQUIRE(all.swaps.size() == 12);
    CHECK(all.trial.objects == 24);
    CHECK(all.revision == 1);
    for (const SwapReport& swap : all.swaps) CHECK(swap.to == kImpulse);
    for (int i = 0; i < 12; ++i) CHECK(ask(one_by_one, {SwapOperation{"gears." + std::to_string(i), kImpulse, {}}}).done);
    s.step(50), one_by_one.step(50);
    CHECK(s.hash() == one_by_one.hash());

    const Reply some = ask(s, {SwapOperation{"gears.?", "Constraint/AngularVelocity/Graph", {}}});
    REQUIRE(some.done);
    CHECK(some.swaps.size() == 10);
    const Reply none = ask(s, {SwapOperation{"gear.*", kImpulse, {}}});
    CHECK(!none.done);
    CHECK(first_error(none.errors).find("no component's id matches") != std::string::npos);
    const Reply wrong = ask(s, {SwapOperation{"in*", kImpulse, {}}});
    CHECK(!wrong.done);
    CHECK(first_error(wrong.errors).find("none of which can be exchanged") != std::string::npos);
    // A single failure rolls all of them back.
    const std::uint64_t before = s.hash();
    const Reply bad = ask(s, {SwapOperation{"gears.*", kImpulse, {}}, SwapOperation{"nobody", kImpulse, {}}});
    CHECK(!bad.done);
    CHECK(s.hash() == before);
    CHECK(s.simulation().world().type_of(s.simulation().world().find("gears.1"))->info.name == "Constraint/AngularVelocity/Graph");
}

TEST_CASE(
    "a swap whose first step multiplies the energy by a hundred is refused, and rolled back bit for bit, unless it is explicitly allowed")
{
    const std::string scene = R"(<component id="r" type="Shape/Sphere" radius="0.1"/>
      <component id="a" type="State/RigidBody" mass="1" shape="r" linear_velocity="3 0 0"/>
      <component id="s" type="Script/Lua" driven="a"><param name="code">function force(t, state) driven:add_force(vec(1, 0, 0)) end</param></component>)";
    Scene s(scene), alone(scene);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(3), alone.step(3);
    // v = 1e5 / 240 after the step: 8.7e4 J out of 4.5.
    const SwapOperation swap{"s", "Script/Lua", {{"code", std::string("function force(t, state) driven:add_force(vec(1e5, 0, 0)) end")}}};
    const Reply no = ask(s, {swap});
    CHECK(!no.done);
    const std::string why = first_error(no.errors);
    CHECK_MESSAGE(why.find("kinetic energy") != std::string::npos, why);
    CHECK_MESSAGE(why.find("4.5") != std::string::npos, why);
    CHECK(s.hash() == alone.hash());
    s.step(10), alone.step(10);
    CHECK(s.hash() == alone.hash());

    TrialChoice wanted;
    wanted.energy_factor = 1e6;
    CHECK(ask(s, {swap}, wanted).done);
    // The energy stored in a spring may be released.
    Scene spring(R"(<component id="r" type="Shape/Sphere" radius="0.1"/>
      <component id="a" type="State/RigidBody" mass="1" shape="r" position="1 0 0"/><component id="b" type="State/RigidBody" mass="1" shape="r"/>
      <component id="s" type="Constraint/SpringDamper" a="a" b="b" length="0.5" stiffness="1e4" damping="0"/>)");
    REQUIRE_MESSAGE(spring.loaded(), spring.error());
    const Reply again = ask(spring, {SwapOperation{"s", "Constraint/SpringDamper", {}}});
    CHECK_MESSAGE(again.done, first_error(again.errors));
}

TEST_CASE("the cost of a swap is a median of repetitions, and its difference is reported if it is significant")
{
    const auto script = [](int turns)
    {
        return "function force(t, state) local x = 0 for i = 1, " + std::to_string(turns) +
               " do x = x + i end driven:add_force(vec(x * 1e-30, 0, 0)) end";
    };
    Scene s(
        "<component id='a' type='State/RigidBody' mass='1' inertia='1 1 1'/><component id='s' type='Script/Lua' driven='a'>"
        "<param name='code'>" +
        script(200) + "</param></component>" + gears_and_balls(1, 1));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(5);
    const Reply dearer = ask(s, {SwapOperation{"s", "Script/Lua", {{"code", script(8000)}}}});
    REQUIRE_MESSAGE(dearer.done, first_error(dearer.errors));
    CHECK(dearer.trial.with_old.samples == 11);
    CHECK(dearer.trial.with_new.samples == 11);
    CHECK(dearer.swaps[0].with_old.cost_ns == dearer.trial.with_old.median);
    CHECK(dearer.swaps[0].with_new.cost_ns > 5 * dearer.swaps[0].with_old.cost_ns);
    const std::string words = text_of(dearer.trial);
    CHECK_MESSAGE(words.find(" us more") != std::string::npos, words);

    // A type for itself: only noise. Because the clock is imperfect, a difference may be reported in a few cases.
    int reported = 0;
    for (int i = 0; i < 40; ++i)
    {
        const Reply same = ask(s, {SwapOperation{"gears.0", "Constraint/AngularVelocity/Graph", {}}});
        REQUIRE(same.done);
        REQUIRE(same.swaps[0].with_new.cost_ns == same.trial.with_new.median);
        const bool differs = !std::isnan(same.swaps[0].with_old.cost_ns);
        CHECK(differs == costs_differ(same.trial.with_old, same.trial.with_new));
        CHECK((text_of(same.trial).find("no significant difference") == std::string::npos) == differs);
        reported += differs ? 1 : 0;
        if (differs) MESSAGE(text_of(same.trial));
    }
    CHECK_MESSAGE(reported <= 4, reported, " of 40");
    MESSAGE(reported, " of 40 swaps of a type for itself were reported to differ");
    CHECK(text_of(ask(s, {SetOperation{"a", "mass", std::string("2")}}).trial).find("costs") == std::string::npos);
}

TEST_CASE("a step is not repeated for its cost beyond the budget")
{
    // The budget allows some steps, but not enough to find a difference.
    const std::string code =
        "function force(t, state) local x = 0 for i = 1, 20000 do x = x + i end driven:add_force(vec(x * 1e-30, 0, 0)) end";
    Scene s(
        "<component id='a' type='State/RigidBody' mass='1' inertia='1 1 1'/><component id='s' type='Script/Lua' driven='a'>"
        "<param name='code'>" +
        code + "</param></component>");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(3);
    const auto begin = std::chrono::steady_clock::now();
    s.step(10);
    const double step_ms = 100 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const Reply reply = ask(s, {SwapOperation{"s", "Script/Lua", {{"code", code}}}}, budget(6 * step_ms));
    REQUIRE_MESSAGE(reply.done, first_error(reply.errors));
    CHECK(reply.trial.with_new.samples < 8);
    CHECK(std::isnan(reply.swaps[0].with_old.cost_ns));
    CHECK(reply.trial.ns < 12 * 1e6 * step_ms);
}
