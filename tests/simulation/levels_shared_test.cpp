// What several governors do at the same boundary, and how a budget spreads what it exchanges.
#include "simulation/governed.h"
#include "support/text.h"

using namespace plab;
using namespace plab::simulation;
using plab::test::count_at;
using plab::test::has;
using plab::test::kLadder;
using plab::test::level;
using plab::test::measure;
using plab::test::Scene;
using plab::test::springs_under_budget;

namespace
{

/// Two bodies ahead of a viewer and two behind it, each pair under a governor of its own.
std::string two_governors(const std::string& more = "")
{
    std::string out = "<component id=\"ball\" type=\"Shape/Sphere\" radius=\"0.5\"/><component id=\"eye\" type=\"Viewer/Free\"/>";
    for (const auto& [id, x] :
         {std::pair("a.ahead", "3"), std::pair("a.behind", "-30"), std::pair("b.ahead", "4"), std::pair("b.behind", "-40")})
        out += std::string("<component id=\"") + id + "\" type=\"State/RigidBody\" mass=\"1\" shape=\"ball\" position=\"" + x +
               " 0 0\" solver=\"Solver/RungeKutta4\"/>";
    const std::string levels = std::string("\" levels=\"") + kLadder + "\" every=\"0.1\" dwell=\"0\" ";
    return out + "<component id=\"near\" type=\"Governor/Distance\" watches=\"a.*.solver" + levels + "distances=\"5 20\"/>" +
           "<component id=\"seen\" type=\"Governor/Visibility\" watches=\"b.*.solver" + levels + "pixels=\"1 10\"/>" + more;
}

}  // namespace

TEST_CASE("what several governors exchange at a boundary is one transaction, told for each of them")
{
    Scene s(two_governors());
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    const std::uint64_t revision = s.simulation().revision();
    s.step();
    CHECK(s.simulation().revision() == revision + 1);
    const std::vector<Reply>& made = s.simulation().own_requests();
    REQUIRE(made.size() == 2);
    for (std::size_t k = 0; k < made.size(); ++k)
    {
        const std::string prefix = k == 0 ? "a." : "b.";
        CHECK(made[k].done);
        CHECK(made[k].decided_by == (k == 0 ? "near" : "seen"));
        REQUIRE(made[k].made);
        CHECK(made[k].made->operations.size() == 2);
        REQUIRE(made[k].swaps.size() == 2);
        CHECK(made[k].swaps[0].id == prefix + "ahead.solver");
        CHECK(made[k].swaps[0].to == "Solver/DormandPrince54");
        CHECK(made[k].swaps[1].to == "Solver/SemiImplicitEuler");
    }
    CHECK(s.count("level.changed") == 4);
    const auto levels = s.simulation().levels().levels();
    CHECK(has(level(levels, s, "a.ahead.solver").reason, "m from eye"));
    CHECK(has(level(levels, s, "b.ahead.solver").reason, "pixels for eye"));
}

TEST_CASE("a budget looks a boundary after the governors that look as often, so that their exchanges do not add up in one step")
{
    std::string scene = springs_under_budget(12, "trials=\"0\"");
    Scene s(scene);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step();
    measure(s, "step_cost", Value(1e-3)), measure(s, "trial_costs", Value(Reals{1e-6, 1.1e-6, 9e-4}));
    measure(s, "exchange_cost", Value(Reals{1, 1e-6}));
    s.step();
    CHECK(count_at(s, 0) == 12);  // there is no room
    measure(s, "budget", Value(5e-3));
    s.step(11);  // the boundary at 0.05 s, 12 steps of 1/240 s from the start, is the next one
    CHECK(s.simulation().tick() == 13);
    CHECK(count_at(s, 0) == 12);
    s.step();
    CHECK(count_at(s, 0) == 0);
}

TEST_CASE("a budget: as long as it is not known what an exchange costs, a few tell it")
{
    Scene s(springs_under_budget(40, "trials=\"0\""));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    measure(s, "every", Value(10.0));
    s.step();
    measure(s, "step_cost", Value(3e-4)), measure(s, "trial_costs", Value(Reals{1e-6, 1.1e-6, 9e-4}));
    s.step();
    CHECK(count_at(s, 1) == 16);
    measure(s, "exchange_cost", Value(Reals{16, 4e-4}));  // taken for 0.2 ms and 12.5 us for each; 0.7 ms are left
    s.step(5);
    CHECK(count_at(s, 1) == 40);
}

TEST_CASE("what was exact until now is far more wrong with a cheap level than what had it all along, because that damps stiff springs")
{
    // A lamp of scenes/city.xml.
    const std::string lamp =
        "<component id=\"form\" type=\"Shape/Box\" half_extents=\"0.2 0.2 0.3\"/><component id=\"weight\" type=\"Field/Gravity\" "
        "between=\"*\"/><component id=\"post\" type=\"State/Static\" position=\"0 0 3\"/>"
        "<component id=\"engine\" type=\"Solver/DormandPrince54\" relative_tolerance=\"1e-6\" absolute_tolerance=\"1e-7\"/>"
        "<component id=\"upper\" type=\"State/RigidBody\" shape=\"form\" mass=\"2\" position=\"0.2 0 5\" linear_velocity=\"0 1 0\" "
        "angular_velocity=\"0 2 1\" solver=\"engine\"/><component id=\"lower\" type=\"State/RigidBody\" shape=\"form\" mass=\"1\" "
        "position=\"0.2 0.2 4\" linear_velocity=\"1 0 0\" angular_velocity=\"3 0 1\" solver=\"engine\"/>"
        "<component id=\"long\" type=\"Constraint/SpringDamper\" a=\"post\" b=\"upper\" length=\"1\" stiffness=\"4000\" anchor_a=\"0 0 3\" "
        "anchor_b=\"0 0 0.3\"/><component id=\"short\" type=\"Constraint/SpringDamper\" a=\"upper\" b=\"lower\" length=\"1\" "
        "stiffness=\"1500\" anchor_a=\"0 0.2 -0.3\" anchor_b=\"0.2 0 0.3\"/>";
    Scene exact(lamp, "dt=\"1/60\""), cheap(lamp, "dt=\"1/60\"");
    REQUIRE_MESSAGE(exact.loaded(), exact.error());
    const Level runge_kutta{"Solver/RungeKutta4", {}, ""},
        fine{"Solver/DormandPrince54", {{"relative_tolerance", Value(1e-6)}, {"absolute_tolerance", Value(1e-7)}}, ""};
    REQUIRE(cheap.ask(SwapOperation{"engine", "Solver/RungeKutta4", {}}).done);
    const auto error = [&](Scene& s)
    { return s.simulation().try_level(s.simulation().world().find("engine"), runge_kutta, fine, 0.25).distance; };
    for (const double time : {1.0, 2.0, 4.0})
    {
        exact.run(time), cheap.run(time);
        CHECK_MESSAGE(error(exact) > 0.3, time);  // m, in 0.25 s
        CHECK_MESSAGE(error(cheap) < 0.15 * error(exact), time);
    }
}
