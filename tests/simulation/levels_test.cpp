// Governors: which level a component gets, why, and that a replay decides the same.
#include <algorithm>

#include "simulation/governed.h"
#include "simulation/snapshot/compare.h"
#include "support/scene.h"
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

std::string body(const std::string& id, double x, const std::string& more = "")
{
    return "<component id=\"" + id + "\" type=\"State/RigidBody\" mass=\"1\" shape=\"ball\" position=\"" + std::to_string(x) +
           " 0 0\" solver=\"Solver/RungeKutta4\" " + more + "/>";
}

/// Three bodies along x, each with a solver of its own.
std::string row_of_bodies(const std::string& governor, const std::string& more = "")
{
    return "<component id=\"ball\" type=\"Shape/Sphere\" radius=\"0.5\"/>" + body("near", 2.5) + body("middle", 12.5) + body("far", 40.5) +
           "<component id=\"eye\" type=\"Viewer/Free\"/>" + governor + more;
}

std::string by_distance(const std::string& more = "")
{
    return std::string("<component id=\"lod\" type=\"Governor/Distance\" watches=\"*.solver\" levels=\"") + kLadder +
           "\" distances=\"5 20\" look_ahead=\"0\" " + more + "/>";
}

std::string algorithm(const Scene& s, const std::string& id)
{
    return s.simulation().world().type_of(s.simulation().world().find(id))->info.name;
}

void move_eye(Scene& s, double x)
{
    const Reply reply = s.ask(SetOperation{"eye", "position", Value(Vec3{x, 0, 0})});
    REQUIRE_MESSAGE(reply.done, first_error(reply.errors));
}

}  // namespace

TEST_CASE("the nearer the viewer, the finer the level; the reason is told")
{
    Scene s(row_of_bodies(by_distance()));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    s.step();
    CHECK(algorithm(s, "near.solver") == "Solver/DormandPrince54");
    CHECK(algorithm(s, "middle.solver") == "Solver/RungeKutta4");
    CHECK(algorithm(s, "far.solver") == "Solver/SemiImplicitEuler");
    CHECK(s.count("level.changed") == 2);
    const auto levels = s.simulation().levels().levels();
    CHECK(level(levels, s, "near.solver").level == 2);
    CHECK(level(levels, s, "near.solver").reason == "2 m from eye");
    CHECK(level(levels, s, "middle.solver").reason.empty());
    CHECK(level(levels, s, "far.solver").level == 0);
    CHECK(level(levels, s, "far.solver").text == "Solver/SemiImplicitEuler");
}

TEST_CASE("finer at once, cheaper only beyond the hysteresis and after the dwell")
{
    Scene s(row_of_bodies(by_distance("every=\"0.1\" dwell=\"0.5\" hysteresis=\"0.25\"")));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step();
    move_eye(s, 38);  // 2 m from the surface of the far one
    s.run(0.15);
    CHECK(algorithm(s, "far.solver") == "Solver/DormandPrince54");
    CHECK(algorithm(s, "near.solver") == "Solver/DormandPrince54");  // changed at 0: it dwells until 0.5
    s.run(0.65);
    CHECK(algorithm(s, "near.solver") == "Solver/SemiImplicitEuler");
    move_eye(s, 40 - 6);  // beyond 5 m, within 5 m x 1.25
    s.run(2);
    CHECK(algorithm(s, "far.solver") == "Solver/DormandPrince54");
    move_eye(s, 40 - 6.5);
    s.run(2.2);
    CHECK(algorithm(s, "far.solver") == "Solver/RungeKutta4");
}

TEST_CASE("looking ahead by speed: the level is there before the viewer is")
{
    Scene s(row_of_bodies(by_distance("every=\"0.05\"")));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    REQUIRE(s.ask(SetOperation{"lod", "look_ahead", Value(0.5)}).done);
    REQUIRE(s.ask(SetOperation{"eye", "velocity", Value(Vec3{10, 0, 0})}).done);
    s.step();
    CHECK(algorithm(s, "middle.solver") == "Solver/RungeKutta4");  // 12 m, and 7 m in half a second
    move_eye(s, 2.5);                                              // 9.5 m, and 4.5 m in half a second
    s.run(0.1);
    CHECK(algorithm(s, "middle.solver") == "Solver/DormandPrince54");
}

TEST_CASE("two runs decide alike, and so does one that continues from a snapshot or goes back")
{
    const std::string scene = row_of_bodies(by_distance("every=\"0.1\" dwell=\"0.3\""));
    Scene one(scene), other(scene), third(scene);
    REQUIRE_MESSAGE(one.loaded(), one.error());
    HistoryOptions keep;
    keep.interval = 0.25;
    one.simulation().history().configure(keep);
    REQUIRE(one.ask(ResetOperation{}).done);
    Snapshot halfway;
    std::vector<std::uint64_t> hashes;
    for (int k = 0; k < 480; ++k)
    {
        if (k % 60 == 30) move_eye(one, 0.1 * k), move_eye(other, 0.1 * k);
        if (k == 200) halfway = one.simulation().capture();
        one.step(), other.step();
        CHECK(one.hash() == other.hash());
        hashes.push_back(one.hash());
    }
    CHECK(one.get("lod", "changes") == other.get("lod", "changes"));
    REQUIRE(third.simulation().restore(halfway).ok());
    for (int k = 200; k < 480; ++k)
    {
        if (k % 60 == 30) move_eye(third, 0.1 * k);
        third.step();
        CHECK(third.hash() == hashes[static_cast<std::size_t>(k)]);
    }
    REQUIRE(one.ask(RewindOperation{1.0, false}).done);
    CHECK(one.simulation().tick() == 240);
    CHECK(one.hash() == hashes[239]);
    one.step();
    CHECK(one.hash() == hashes[240]);
}

TEST_CASE("a ladder that cannot be read, and a component with two governors, are refused by name")
{
    const auto error = [](const std::string& governor)
    {
        Scene s(row_of_bodies(governor));
        CHECK_FALSE(s.loaded());
        return s.error();
    };
    const auto with_levels = [](const std::string& levels)
    { return "<component id=\"lod\" type=\"Governor/Distance\" levels=\"" + levels + "\" distances=\"5 20\"/>"; };
    CHECK(has(error(with_levels("Solver/RungeKutta4")), "at least two levels"));
    CHECK(has(error(with_levels("Solver/RungeKutta4; Solver/RungaKutta4")), "Solver/RungeKutta4"));
    CHECK(has(error(with_levels("Solver/RungeKutta4; Manager/Direct")), "family"));
    CHECK(has(error(with_levels("Solver/RungeKutta4 steps=3; Solver/Exact")), "has no parameter 'steps'"));
    const std::string twice = error(by_distance() +
                                    "<component id=\"lod2\" type=\"Governor/Distance\" watches=\"near.*\" levels=\"Solver\" "
                                    "distances=\"1 2 3\"/>");
    CHECK(has(twice, "'near.solver'"));
    CHECK(has(twice, "'lod'"));
}

TEST_CASE("a number of bounds that does not fit the ladder is told, and nothing is changed")
{
    Scene s(row_of_bodies(by_distance()));
    REQUIRE(s.loaded());
    s.warnings_expected = s.keep_events = true;
    REQUIRE(s.ask(SetOperation{"lod", "distances", Value(Reals{1, 2, 3})}).done);
    s.step();
    CHECK(s.count("decide.failed") == 1);
    CHECK(s.count("level.changed") == 0);
}

TEST_CASE("a governor is added and removed by request, and its ladder is changed by request")
{
    Scene s(row_of_bodies(""));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step();
    CHECK_FALSE(s.simulation().levels().watches_anything());
    const auto scene = test::compile_text(test::whole_scene(by_distance()), "request.xml", &s.simulation().world().scene());
    REQUIRE_MESSAGE(scene.ok(), test::reasons(scene));
    REQUIRE(s.ask(AddOperation{*scene}).done);
    s.run(0.5);
    CHECK(algorithm(s, "near.solver") == "Solver/DormandPrince54");
    const Reply bad = s.ask(SetOperation{"lod", "levels", Value(std::string("Solver/Unknown; Solver/Exact"))});
    CHECK_FALSE(bad.done);
    CHECK(s.simulation().levels().levels().size() == 3);
    REQUIRE(s.ask(SetOperation{"lod", "levels", Value(std::string("Solver/RungeKutta4; Solver/StoermerVerlet; Solver/Exact"))}).done);
    s.run(1);
    CHECK(algorithm(s, "near.solver") == "Solver/Exact");
    REQUIRE(s.ask(RemoveOperation{"lod"}).done);
    s.step();
    CHECK_FALSE(s.simulation().levels().watches_anything());
}

TEST_CASE("what is out of sight or hidden by a box gets the cheapest level")
{
    Scene s(row_of_bodies(std::string("<component id=\"lod\" type=\"Governor/Visibility\" watches=\"*.solver\" levels=\"") + kLadder +
                              "\" pixels=\"10 100\" look_ahead=\"0\" margin=\"0\" occluders=\"wall\" dwell=\"0\"/>",
                          "<component id=\"slab\" type=\"Shape/Box\" half_extents=\"0.1 4 4\"/>"
                          "<component id=\"wall\" type=\"State/Static\" shape=\"slab\" position=\"20 0 0\"/>" +
                              body("behind", -5)));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step();
    CHECK(algorithm(s, "near.solver") == "Solver/DormandPrince54");
    CHECK(algorithm(s, "middle.solver") == "Solver/RungeKutta4");
    CHECK(algorithm(s, "far.solver") == "Solver/SemiImplicitEuler");
    CHECK(algorithm(s, "behind.solver") == "Solver/SemiImplicitEuler");
    auto levels = s.simulation().levels().levels();
    CHECK(level(levels, s, "far.solver").reason == "hidden from every viewer");
    CHECK(level(levels, s, "behind.solver").reason == "out of every viewer's sight");
    REQUIRE(s.ask(SetOperation{"wall", "position", Value(Vec3{20, 20, 0})}).done);
    s.run(0.5);
    levels = s.simulation().levels().levels();
    CHECK(level(levels, s, "far.solver").level == 1);  // 21.9 pixels at 40 m
}

TEST_CASE("a budget of time: what was measured is an input, and with the same inputs another run decides the same")
{
    const std::string scene = row_of_bodies(std::string("<component id=\"lod\" type=\"Governor/Budget\" watches=\"*.solver\" levels=\"") +
                                            kLadder + "\" budget=\"1e-9\" every=\"0.05\" dwell=\"0\"/>");
    Scene live(scene), again(scene);
    REQUIRE_MESSAGE(live.loaded(), live.error());
    live.simulation().let_measure(true);
    int measurements = 0, trials = 0, exchanges = 0;
    for (int k = 0; k < 120; ++k)
    {
        live.step();
        // The replay gets the measurements as requests, and makes none itself: step_once() measures nothing.
        for (const Reply& reply : live.simulation().own_requests())
        {
            if (!reply.made || !reply.decided_by.empty()) continue;
            for (const Operation& operation : reply.made->operations)
            {
                const std::string& name = std::get<SetOperation>(operation).name;
                measurements += name == "step_cost" ? 1 : 0, trials += name == "trial_costs" ? 1 : 0;
                exchanges += name == "exchange_cost" ? 1 : 0;
            }
            CHECK(again.simulation().carry_out_now(*reply.made).done);
        }
        CHECK(again.simulation().step_once());
        CHECK(live.hash() == again.hash());
    }
    CHECK(measurements >= 8);
    CHECK(trials >= 1);
    CHECK(exchanges >= 1);
    CHECK(std::get<std::int64_t>(live.get("lod", "given_up")) == 3);  // nothing fits into a nanosecond
    CHECK(algorithm(live, "near.solver") == "Solver/SemiImplicitEuler");
}

namespace
{

/// A mass on a spring, whose error depends on the solver, under a governor by error.
std::string spring_under_error(const std::string& more)
{
    return "<component id=\"ball\" type=\"Shape/Sphere\" radius=\"0.1\"/><component id=\"post\" type=\"State/Static\"/>"
           "<component id=\"bob\" type=\"State/RigidBody\" mass=\"1\" shape=\"ball\" position=\"1.5 0 0\" linear_velocity=\"0 2 0\" "
           "solver=\"Solver/SemiImplicitEuler\"/>"
           "<component id=\"spring\" type=\"Constraint/SpringDamper\" a=\"post\" b=\"bob\" length=\"1\" stiffness=\"40\"/>" +
           (more.empty() ? std::string()
                         : std::string("<component id=\"lod\" type=\"Governor/Error\" watches=\"bob.solver\" levels=\"") + kLadder +
                               "\" interval=\"0.25\" every=\"0.05\" dwell=\"0\" " + more + "/>");
}

std::int64_t whole(const Scene& s, const std::string& id, const std::string& field) { return std::get<std::int64_t>(s.get(id, field)); }

}  // namespace

TEST_CASE("the cheapest level with an error below the bound: measured by trials that leave no trace, and true afterwards")
{
    Scene loose(spring_under_error("bound=\"0.5\"")), tight(spring_under_error("bound=\"1e-5\"")),
        tighter(spring_under_error("bound=\"1e-13\""));
    REQUIRE_MESSAGE(loose.loaded(), loose.error());
    Scene plain(spring_under_error(""));
    loose.run(1), plain.run(1);
    CHECK(loose.vec("bob", "position") == plain.vec("bob", "position"));
    CHECK(whole(loose, "lod", "measured") > 0);
    CHECK(algorithm(loose, "bob.solver") == "Solver/SemiImplicitEuler");
    tighter.step();
    CHECK(algorithm(tighter, "bob.solver") == "Solver/DormandPrince54");
    Scene exact(spring_under_error(""));
    REQUIRE(exact.ask(SwapOperation{"bob.solver", "Solver/DormandPrince54", {}}).done);
    tight.run(0.25), exact.run(0.25);
    CHECK(algorithm(tight, "bob.solver") == "Solver/RungeKutta4");
    CHECK(test::distance(tight.vec("bob", "position"), exact.vec("bob", "position")) < 1e-5);
    const LevelInfo told = level(tight.simulation().levels().levels(), tight, "bob.solver");
    CHECK(told.error_unit == "m");
    CHECK(told.error > 0);
    CHECK(told.error < 1e-5);
    CHECK(told.next_look > tight.simulation().time());
    CHECK(told.reason.find("of 1e-05 m in 0.25 s, confidence") != std::string::npos);
}

/// A trial copies what it shares with a snapshot, so a governor must not keep what belongs to the world.
TEST_CASE("a run that measures errors continues from a snapshot as if there had been no interruption, whoever takes snapshots meanwhile")
{
    const std::string scene = row_of_bodies(std::string("<component id=\"lod\" type=\"Governor/Error\" watches=\"*.solver\" levels=\"") +
                                                kLadder + "\" bound=\"1e-3\" every=\"0.05\" dwell=\"0.1\"/>",
                                            "<component id=\"weight\" type=\"Field/Gravity\" between=\"*\"/>");
    Scene run(scene);
    REQUIRE_MESSAGE(run.loaded(), run.error());
    for (int from = 0; from < 240; from += 60)
    {
        const Snapshot begin = run.simulation().capture();
        std::vector<Snapshot> course;
        for (int k = 0; k < 60; ++k) run.step(), course.push_back(run.simulation().capture());
        Scene twin(scene);
        REQUIRE(twin.simulation().restore(begin).ok());
        for (int k = 0; k < 60; ++k)
        {
            (void)twin.simulation().capture();
            twin.step();
            const auto difference = compare(course[static_cast<std::size_t>(k)], twin.simulation().capture());
            REQUIRE_MESSAGE(!difference, "from step ", from, ", after ", k, ": ", difference->text());
        }
    }
    CHECK(whole(run, "lod", "measured") > 10);
}

TEST_CASE("a budget is spent on what is seen largest, and saved on what is seen smallest; what is given up is told")
{
    Scene s(row_of_bodies(std::string("<component id=\"lod\" type=\"Governor/Budget\" watches=\"*.solver\" levels=\"") + kLadder +
                          "\" budget=\"1e-3\" every=\"0.05\" dwell=\"0\"/>"));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    constexpr double kCost[] = {1e-4, 2e-4, 4e-4};  // s, of a step with all components at the level
    const auto run = [&](int steps)
    {
        for (int k = 0; k < steps; ++k)
        {
            double cost = 0;
            for (const LevelInfo& l : s.simulation().levels().levels()) cost += kCost[l.level] / 3;
            if (k > 0) REQUIRE(s.ask(SetOperation{"lod", "step_cost", Value(cost)}).done);
            s.step();
        }
    };
    run(1);
    CHECK(whole(s, "lod", "given_up") == 3);  // nothing is known of costs yet
    CHECK(algorithm(s, "near.solver") == "Solver/SemiImplicitEuler");
    run(240);
    CHECK(whole(s, "lod", "given_up") == 0);
    CHECK(algorithm(s, "far.solver") == "Solver/DormandPrince54");
    REQUIRE(s.ask(SetOperation{"lod", "budget", Value(3e-4)}).done);
    run(240);
    CHECK(algorithm(s, "near.solver") == "Solver/DormandPrince54");
    CHECK(algorithm(s, "middle.solver") == "Solver/RungeKutta4");
    CHECK(algorithm(s, "far.solver") == "Solver/RungeKutta4");  // (4 + 2 + 2) / 3 of 1e-4 s
    CHECK(whole(s, "lod", "given_up") == 2);
    CHECK(s.real("lod", "spent") < 1);
    CHECK(s.real("lod", "lost") > 0.1);
    CHECK(s.real("lod", "lost") < 0.3);  // 0.04 + 0.012 of 0.25
    move_eye(s, 38);                     // in front of the far one, and the others are behind
    run(240);
    CHECK(algorithm(s, "far.solver") == "Solver/DormandPrince54");
    CHECK(algorithm(s, "near.solver") != "Solver/DormandPrince54");
    CHECK(s.real("lod", "spent") < 1);
}
