// What is told of a change of level: cost and error of the level before and of the one after, as far as they are known.
#include <cmath>

#include "simulation/governed.h"
#include "simulation/levels/level_change.h"
#include "support/text.h"

using namespace plab;
using namespace plab::simulation;
using plab::test::first_error;
using plab::test::has;
using plab::test::kLadder;
using plab::test::level;
using plab::test::Scene;

namespace
{

enum Figure : std::uint8_t
{
    kCostBefore,
    kCostAfter,
    kErrorBefore,
    kErrorAfter,
};

/// The changes of one component, in order.
std::vector<Event> changes_of(const Scene& s, const std::string& id)
{
    std::vector<Event> out;
    for (const Event& e : s.events)
        if (e.kind == "level.changed" && s.simulation().world().id_of(e.component) == id) out.push_back(e);
    return out;
}

/// Two masses on springs, 10 m apart, and an eye between them.
std::string two_springs(const std::string& governor, const std::string& solver = "Solver/RungeKutta4")
{
    std::string out =
        "<component id='ball' type='Shape/Sphere' radius='0.1'/><component id='eye' type='Viewer/Free' position='0 -3 0' "
        "direction='0 1 0'/>";
    for (const auto& [id, x] : {std::pair("near", "0"), std::pair("far", "10")})
    {
        const std::string n = id;
        out += "<component id='post." + n + "' type='State/Static' position='" + x + " 0 1'/><component id='" + n +
               "' type='State/RigidBody' mass='1' shape='ball' position='" + x + " 0.5 0' solver='" + solver + "'/><component id='spring." +
               n + "' type='Constraint/SpringDamper' a='post." + n + "' b='" + n + "' length='1' stiffness='40'/>";
    }
    return out + "<component id='lod' watches='*.solver' every='0.05' dwell='0' levels='" + kLadder + "' " + governor + "/>";
}

void move_eye(Scene& s, double x)
{
    const Reply reply = s.ask(SetOperation{"eye", "position", Value(Vec3{x, -3, 0})});
    REQUIRE_MESSAGE(reply.done, first_error(reply.errors));
}

}  // namespace

TEST_CASE("by distance: before anything has run nothing is known, and later what each level cost when it was there")
{
    Scene s(two_springs("type='Governor/Distance' distances='4 7' look_ahead='0'"));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    s.step();
    std::vector<Event> changes = changes_of(s, "near.solver");
    REQUIRE(changes.size() == 1);
    REQUIRE(changes[0].values.size() == 4);
    for (const double figure : changes[0].values) CHECK(std::isnan(figure));
    CHECK(has(changes[0].message, "Solver/RungeKutta4 -> Solver/DormandPrince54: "));
    CHECK(has(changes[0].message, "; cost unknown -> unknown, error unknown -> unknown"));
    s.run(0.5);
    move_eye(s, 10);
    s.run(1);
    changes = changes_of(s, "near.solver");
    REQUIRE(changes.size() == 2);
    // The other one has had the cheapest level in the meantime, so the account of its type tells the cost.
    CHECK(changes[1].values[kCostBefore] > 0);
    CHECK(changes[1].values[kCostAfter] > 0);
    CHECK(changes[1].values[kCostAfter] < 1e-3);
    const LevelInfo now = level(s.simulation().levels().levels(), s, "near.solver");
    CHECK(now.last.from == "Solver/DormandPrince54");
    CHECK(now.last.to == "Solver/SemiImplicitEuler");
    CHECK(now.last.cost.before == changes[1].values[kCostBefore]);
    CHECK_FALSE(now.last.is_trial);
}

TEST_CASE("by sight: what the type accounts for as its error is told for the level that goes, and for one that it had before")
{
    const std::string scene = two_springs("type='Governor/Visibility' pixels='5 20'");
    Scene s(scene);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    s.run(0.3);
    double until = 0.3;
    for (const double x : {100.0, 0.0, 100.0}) move_eye(s, x), s.run(until += 0.3);
    const std::vector<Event> changes = changes_of(s, "near.solver");
    REQUIRE(changes.size() == 4);
    CHECK(changes[3].values[kCostBefore] > 0);
    CHECK(changes[3].values[kCostAfter] > 0);
    // DormandPrince54 estimates its error; SemiImplicitEuler does not, so nothing is claimed of it.
    const double own = s.simulation().error_of(s.simulation().world().find("near.solver"));
    MESSAGE("error of the present level: ", own, ", told: ", changes[3].message);
    CHECK(std::isnan(changes[3].values[kErrorAfter]));
}

TEST_CASE("by error: the error of both levels is that of trial steps, and is not carried over from one level to the other")
{
    Scene s(two_springs("type='Governor/Error' bound='1e-4'", "Solver/SemiImplicitEuler"));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.simulation().let_measure(true);
    s.keep_events = true;
    s.run(0.5);
    const std::vector<Event> changes = changes_of(s, "near.solver");
    REQUIRE(!changes.empty());
    const Event& first = changes[0];
    REQUIRE(first.values.size() == 4);
    CHECK(first.values[kErrorBefore] > 1e-4);
    CHECK(first.values[kErrorAfter] < 1e-4);
    CHECK(first.values[kErrorAfter] >= 0);
    CHECK(first.values[kCostBefore] > 0);
    CHECK(first.values[kCostAfter] > 0);
    CHECK(has(first.message, "(trial), error "));
    CHECK(has(first.message, " m -> "));
}

TEST_CASE("by budget: cost and error of both levels, and no level keeps the error that was told of another one")
{
    Scene s(two_springs("type='Governor/Budget' budget='1e-3'"));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    s.step();
    for (int k = 0; k < 120; ++k)
    {
        REQUIRE(s.ask(SetOperation{"lod", "step_cost", Value(1e-5)}).done);
        s.step();
    }
    const std::vector<Event> changes = changes_of(s, "near.solver");
    REQUIRE(changes.size() >= 2);
    const Event& finer = changes.back();
    CHECK(finer.values[kCostBefore] > 0);
    CHECK(finer.values[kErrorBefore] > finer.values[kErrorAfter]);
    CHECK(finer.values[kErrorAfter] >= 0);
    const LevelInfo now = level(s.simulation().levels().levels(), s, "near.solver");
    CHECK(now.error == finer.values[kErrorAfter]);
}

TEST_CASE("figures in words")
{
    LevelChange change;
    change.cost = {1.234e-7, 5e-3, "s"};
    change.error.after = 0.00123, change.error.unit = "m";
    CHECK(change.text() == "cost 123 ns -> 5 ms, error unknown -> 0.00123 m");
    const FigurePair none, half{1, std::nan(""), "m"}, both{1, 2, "rad"};
    CHECK(&better(none, half) == &half);
    CHECK(&better(half, both) == &both);
    CHECK(&better(both, half) == &both);
    CHECK(&better(half, none) == &half);
}
