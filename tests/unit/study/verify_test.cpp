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

TEST_CASE("what cannot be checked is told")
{
    const auto power = verified(falling(by_error("bound='1' unit='W'")), 0.5);
    REQUIRE_FALSE(power.ok());
    CHECK(test::has(power.error().text(), "lod has a bound in W"));
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
