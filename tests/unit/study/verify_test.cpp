// The true errors of levels, measured afterwards.
#include "study/verify.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "support/scene.h"
#include "support/text.h"

using namespace plab;
using namespace plab::study;

namespace
{

/// A body that falls freely: the closed form of what semi-implicit Euler makes of it is known.
std::string falling(const std::string& governor, int bodies = 1)
{
    std::string text = "<component id='ball' type='Shape/Sphere' radius='0.1'/>";
    for (int k = 0; k < bodies; ++k)
        text += "<component id='ball." + std::to_string(k) + "' type='State/RigidBody' mass='1' shape='ball' position='0 " +
                std::to_string(k) + " 0' solver='Solver/SemiImplicitEuler'/>";
    return text + "<component id='weight' type='Field/Gravity' between='*'/>" + governor;
}

std::string by_error(const std::string& more, const std::string& every = "0.25")
{
    return "<component id='lod' type='Governor/Error' watches='*.solver' levels='Solver/SemiImplicitEuler; Solver/RungeKutta4' "
           "interval='0.25' every='" +
           every + "' " + more + "/>";
}

/// `meanwhile` is called before each step, with the number of steps made.
Result<VerifyResult> verified(const std::string& body, double until, const std::function<void(test::Scene&, int)>& meanwhile = {})
{
    test::Scene run(body, "dt=\"1/100\"");
    REQUIRE_MESSAGE(run.loaded(), run.error());
    LevelVerifier verifier(test::library());
    for (int n = 0;; ++n)
    {
        if (auto done = verifier.at_boundary(run.simulation()); !done) return done.errors();
        if (run.simulation().time() > until - 1e-6) return verifier.take();
        if (meanwhile) meanwhile(run, n);
        run.step();
    }
}

constexpr double kGravity = 9.81, kStep = 0.01, kInterval = 0.25;

}  // namespace

TEST_CASE("the true error of a level is that of the closed form")
{
    const auto result = verified(falling(by_error("bound='1'")), 1.0);
    REQUIRE_MESSAGE(result.ok(), test::reasons(result));
    REQUIRE(result->governors.size() == 1);
    const VerifiedGovernor& g = result->governors[0];
    CHECK(g.counted() == 4);
    CHECK(g.held() == 4);
    REQUIRE(g.worst());
    // v_n = n g h and z_n = -g h^2 n (n + 1) / 2, instead of -g h^2 n^2 / 2.
    CHECK(g.worst()->error == doctest::Approx(0.5 * kGravity * kStep * kInterval).epsilon(1e-6));
    CHECK(g.worst()->component == "ball.0.solver");
    CHECK(g.worst()->level == "Solver/SemiImplicitEuler");
}

TEST_CASE("a level that errs more than the bound is found, with its component and its time")
{
    // The governor looks only at the start, and gives the exact level; then a client gives one ball a cheap one.
    const auto meanwhile = [](test::Scene& s, int steps)
    {
        if (steps == 50) REQUIRE(s.ask(simulation::SwapOperation{"ball.2.solver", "Solver/SemiImplicitEuler", {}}).done);
    };
    const auto result = verified(falling(by_error("bound='1e-3'", "100"), 4), 0.75, meanwhile);
    REQUIRE_MESSAGE(result.ok(), test::reasons(result));
    const VerifiedGovernor& g = result->governors[0];
    CHECK(g.components == 4);
    CHECK(g.intervals.size() == 3);
    CHECK(g.counted() == 1);  // those with the most exact level promise nothing
    CHECK(g.held() == 0);
    CHECK(g.share() == 0);
    REQUIRE(g.worst());
    CHECK(g.worst()->component == "ball.2.solver");
    CHECK(g.worst()->begin == doctest::Approx(0.5));
    const auto sentences = verify_findings(*result);
    REQUIRE(sentences.size() == 3);
    CHECK(test::has(sentences[0], "0 % of 1 intervals"));
    // The error of a fall grows linearly, which is how trial steps continue it.
    CHECK(test::has(sentences[2], "lod, Solver/SemiImplicitEuler: trial steps tell 1 times the true error"));
    CHECK(test::has(sentences[1], "ball.2.solver with Solver/SemiImplicitEuler in the interval from 0.5 s on"));
}

TEST_CASE("in pixels only what a viewer sees counts")
{
    const std::string viewer = "<component id='eye' type='Viewer/Free' position='-10 1 -1' direction='";
    const std::string pixels = by_error("bound='1e6' unit='pixels'");
    const auto seen = verified(falling(pixels + viewer + "1 0 0'/>", 3), 1.0),
               unseen = verified(falling(pixels + viewer + "-1 0 0'/>", 3), 1.0);
    REQUIRE_MESSAGE(seen.ok(), test::reasons(seen));
    REQUIRE(unseen.ok());
    CHECK(seen->governors[0].counted() == 3 * 4);
    // 720 pixels high, 0.7 rad: pixels for a metre at 10 m.
    const double scale = 360 / std::tan(0.35) / 10;
    CHECK(seen->governors[0].worst()->error == doctest::Approx(scale * 0.5 * kGravity * kStep * kInterval).epsilon(1e-3));
    CHECK(unseen->governors[0].counted() == 0);
    CHECK(unseen->governors[0].share() == 1);
}

TEST_CASE("in W: the energy that the cheap level makes or loses, divided by the interval, as in the closed form and as trial steps tell it")
{
    const auto result = verified(falling(by_error("bound='1' unit='W'"), 3), 1.0);
    REQUIRE_MESSAGE(result.ok(), test::reasons(result));
    const VerifiedGovernor& g = result->governors[0];
    CHECK(g.counted() == 3 * 4);
    CHECK(g.held() == g.counted());
    // The speed is exact, and the height is wrong by -g h^2 n / 2 after n steps: m g times that in n h.
    REQUIRE(g.worst());
    CHECK(g.worst()->error == doctest::Approx(0.5 * kGravity * kGravity * kStep).epsilon(1e-9));
    const auto spreads = spreads_of(g.estimates);
    REQUIRE(spreads.size() == 1);
    CHECK(spreads[0].samples >= 3);
    CHECK(spreads[0].tenth == doctest::Approx(1).epsilon(1e-6));
    CHECK(spreads[0].nine_tenths == doctest::Approx(1).epsilon(1e-6));
    CHECK(test::has(verify_findings(*result)[0], "a true error of at most 1 W"));
}

namespace
{

/// Pairs of bodies that are joined by springs: what a pair stores is neither the one's nor the other's.
std::string swinging(const std::string& governor)
{
    std::string text = "<component id='ball' type='Shape/Sphere' radius='0.1'/><component id='post' type='State/Static'/>";
    for (int k = 0; k < 4; ++k)
    {
        const std::string n = std::to_string(k), x = std::to_string(3 * k);
        text += "<component id='upper." + n + "' type='State/RigidBody' mass='1' shape='ball' position='" + x +
                " 0 -1.2' linear_velocity='0 1 0' solver='Solver/SemiImplicitEuler'/>"
                "<component id='lower." +
                n + "' type='State/RigidBody' mass='0.5' shape='ball' position='" + x + " 0.3 -2.2' solver='upper." + n +
                ".solver'/>"
                "<component id='long." +
                n + "' type='Constraint/SpringDamper' a='post' b='upper." + n + "' anchor_a='" + x + " 0 0' length='1' stiffness='" +
                std::to_string(40 + 20 * k) +
                "'/>"
                "<component id='short." +
                n + "' type='Constraint/SpringDamper' a='upper." + n + "' b='lower." + n + "' length='1' stiffness='60'/>";
    }
    return text + "<component id='weight' type='Field/Gravity' between='*'/>" + governor;
}

}  // namespace

TEST_CASE("a promise in W is kept, interval by interval, and one that is broken is found")
{
    const auto kept = verified(swinging(by_error("bound='0.3' unit='W' dwell='0'", "0.1")), 5.0);
    REQUIRE_MESSAGE(kept.ok(), test::reasons(kept));
    const VerifiedGovernor& g = kept->governors[0];
    CHECK(g.counted() >= 20);
    CHECK(g.share() >= 0.95);
    REQUIRE(g.worst());
    CHECK(g.worst()->error > 0.01);
    // A client takes away what the governor has chosen, and the governor looks again only much later.
    const auto meanwhile = [](test::Scene& s, int steps)
    {
        if (steps == 25) REQUIRE(s.ask(simulation::SwapOperation{"upper.1.solver", "Solver/SemiImplicitEuler", {}}).done);
    };
    const auto broken = verified(swinging(by_error("bound='0.01' unit='W'", "100")), 0.5, meanwhile);
    REQUIRE_MESSAGE(broken.ok(), test::reasons(broken));
    REQUIRE(broken->governors[0].worst());
    CHECK(broken->governors[0].worst()->component == "upper.1.solver");
    CHECK(broken->governors[0].worst()->error > 0.01);
    CHECK(broken->governors[0].held() < broken->governors[0].counted());
}

TEST_CASE("in W: what springs of contacts store belongs to the bodies that touch")
{
    // One ball bounces on a soft ground, the other one rests in it: m g = k d.
    const std::string scene =
        "<component id='ball' type='Shape/Sphere' radius='0.1'/><component id='floor' type='Shape/Plane'/>"
        "<component id='ground' type='State/Static' shape='floor'/>"
        "<component id='ball.0' type='State/RigidBody' mass='1' shape='ball' position='0 0 0.3' solver='Solver/SemiImplicitEuler'/>"
        "<component id='ball.1' type='State/RigidBody' mass='1' shape='ball' position='3 0 " +
        std::to_string(0.1 - kGravity / 2000) +
        "' solver='Solver/SemiImplicitEuler'/>"
        "<component id='weight' type='Field/Gravity' between='*'/>"
        "<component id='soft' type='Response/Penalty' stiffness='2000' restitution='1' steps_per_contact='20'/>"
        "<component id='contact' type='CDetection/ODE' between='*' resolution='Resolution/None' response='soft'/>";
    const auto result = verified(scene + by_error("bound='0.01' unit='W'", "100"), 0.75,
                                 [](test::Scene& s, int steps)
                                 {
                                     if (steps != 1) return;  // after the only look
                                     for (const char* id : {"ball.0.solver", "ball.1.solver"})
                                         REQUIRE(s.ask(simulation::SwapOperation{id, "Solver/SemiImplicitEuler", {}}).done);
                                 });
    REQUIRE_MESSAGE(result.ok(), test::reasons(result));
    const VerifiedGovernor& g = result->governors[0];
    CHECK(g.counted() == 2 * 3);
    CHECK(g.held() == 3);  // those of the one that rests
    REQUIRE(g.worst());
    CHECK(g.worst()->component == "ball.0.solver");
}

TEST_CASE("what cannot be checked is told")
{
    const auto none = verified(falling(""), 0.5);
    REQUIRE_FALSE(none.ok());
    CHECK(test::has(none.error().text(), "no governor of the scene states a bound"));
}

TEST_CASE("the check changes nothing of the run")
{
    std::uint64_t with = 0, without = 0;
    const std::string body = falling(by_error("bound='1e-3'"), 4);
    REQUIRE(verified(body, 1.0, [&](test::Scene& s, int) { with = s.hash(); }).ok());
    test::Scene plain(body, "dt=\"1/100\"");
    for (int n = 0; n < 100; ++n) without = plain.hash(), plain.step();
    CHECK(with == without);
}
