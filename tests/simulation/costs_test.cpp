// Where the time of a step goes: each solver, manager, script and detection has its own account, and together they are the step.
#include <numeric>
#include <random>

#include "publish/figures.h"
#include "simulation/costs/component_costs.h"
#include "support/scene.h"
#include "support/text.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// ns a step, mean of all steps.
double cost_of(const Scene& s, const std::string& id)
{
    const std::uint32_t i = s.simulation().world().find(id);
    REQUIRE_MESSAGE(i != kNoIndex, id);
    return simulation::ComponentCosts(s.simulation().world(), s.simulation().stepper().cost()).of(i).mean;
}

/// The cost of all components together, and the server's own.
double sum_of(const Scene& s)
{
    const simulation::ComponentCosts costs(s.simulation().world(), s.simulation().stepper().cost());
    double sum = s.simulation().stepper().cost().mean_of_host();
    for (const std::uint32_t i : s.simulation().world().in_id_order())
        if (s.simulation().world().component(i).table != kNoIndex) sum += costs.of(i).mean;
    return sum;
}

double step_of(const Scene& s) { return s.simulation().stepper().cost().mean(); }

std::string script(const std::string& id, const std::string& body, int turns)
{
    return "<component id='" + id + "' type='Script/Lua' driven='" + body +
           "'><param name='code'>function force(t, state) local x = 0 for i = 1, " + std::to_string(turns) +
           " do x = x + i end driven:add_force(vec(x * 1e-30, 0, 0)) end</param></component>";
}

std::string pile(const std::string& id, double x, const std::string& manager)
{
    std::string out;
    std::string members;
    for (int i = 0; i < 6; ++i)
    {
        const std::string box = id + std::to_string(i);
        out += "<component id='" + box + "' type='State/RigidBody' mass='1' shape='box' position='" + text(x) + " 0 " +
               text(0.1 + 0.2 * i) + "'/>";
        members += box + " ";
    }
    return out + "<component id='" + id + "' type='CDetection/ODE' between='" + members +
           "' against='ground' resolution='Resolution/None' " + "response='Response/Rows' response.manager='Manager/" + manager +
           "'/><component id='" + id + ".weight' type='Field/Gravity' between='" + members + "'/>";
}

}  // namespace

TEST_CASE("400 bodies under Radau5: the solver has its account, and all accounts together are the step")
{
    Scene s(
        "<component id='stiff' type='Solver/Radau5'/><repeat id='all' count='400' step='1 0 0'><component id='b' type='State/RigidBody' "
        "mass='1' inertia='0.1 0.2 0.3' angular_velocity='1 2 3' solver='stiff'/></repeat>"
        "<component id='g' type='Field/Gravity' between='all'/><component id='air' type='Field/Drag' between='all' linear='0.1'/>");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(64);
    MESSAGE("step ", step_of(s), " ns, solver ", cost_of(s, "stiff"), " ns, drag ", cost_of(s, "air"), " ns");
    CHECK(cost_of(s, "stiff") > 0.5 * step_of(s));
    CHECK(cost_of(s, "air") > 0);
    CHECK(cost_of(s, "air") < 0.5 * step_of(s));
    CHECK(sum_of(s) == doctest::Approx(step_of(s)).epsilon(0.02));
    // Medians: another program that interrupts one of these steps for a millisecond is no work of the server.
    const simulation::CostBook& cost = s.simulation().stepper().cost();
    CHECK(cost.host().median < 0.1 * cost.step().median);
}

TEST_CASE("two scripts of different cost have two figures, in proportion to what they do")
{
    Scene s(
        "<component id='a' type='State/RigidBody' mass='1' inertia='1 1 1'/><component id='b' type='State/RigidBody' mass='1' inertia='1 1 "
        "1'/>" +
        script("short", "a", 100) + script("long", "b", 2000));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(100);
    const simulation::ComponentCosts costs(s.simulation().world(), s.simulation().stepper().cost());
    const auto last = [&](const char* id) { return costs.of(s.simulation().world().find(id)).last; };
    CHECK(costs.of(s.simulation().world().find("short")).shared == 1);
    CHECK(last("short").median > 0);
    CHECK(last("long").median > 5 * last("short").median);
    CHECK(last("long").low > last("short").high);
    CHECK(sum_of(s) == doctest::Approx(step_of(s)).epsilon(0.02));
}

TEST_CASE("a SoftStep among Directs has its own figure, and managers carry most of a stack's step")
{
    Scene s(
        "<component id='floor' type='Shape/Plane'/><component id='ground' type='State/Static' shape='floor'/>"
        "<component id='box' type='Shape/Box' half_extents='0.1 0.1 0.1'/>" +
        pile("one", 0, "Direct") + pile("soft", 5, "SoftStep") + pile("two", 10, "Direct"));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(120);
    const double soft = cost_of(s, "soft.response.manager"), one = cost_of(s, "one.response.manager"),
                 two = cost_of(s, "two.response.manager");
    MESSAGE("Direct ", one, " and ", two, " ns, SoftStep ", soft, " ns, step ", step_of(s), " ns");
    CHECK(one > 0);
    CHECK(soft > 0);
    CHECK(two > 0);
    CHECK(soft != one);
    // The same pile with the same manager costs the same, another one a different amount. The medians cover a few milliseconds, in which
    // another program may disturb one of them, so this has to hold in one of some measurements.
    const auto median = [&](const char* id)
    {
        return simulation::ComponentCosts(s.simulation().world(), s.simulation().stepper().cost())
            .of(s.simulation().world().find(id))
            .last.median;
    };
    bool alike = false;
    for (int i = 0; i < 20 && !alike; ++i)
    {
        s.step(64);
        const double first = median("one.response.manager"), second = median("two.response.manager");
        alike = std::fabs(first - second) < 0.5 * std::max(first, second);
    }
    CHECK(alike);
    CHECK(sum_of(s) == doctest::Approx(step_of(s)).epsilon(0.02));
}

TEST_CASE("threads: the work of each is counted, waiting is not")
{
    const std::string scene =
        "<repeat id='all' count='64' step='1 0 0'><component id='b' type='State/RigidBody' mass='1' inertia='0.1 0.2 0.3' "
        "angular_velocity='1 2 3'/></repeat><component id='air' type='Field/Drag' between='all' linear='0.1'/>";
    Scene one(scene, "dt='1/240'", 1), two(scene, "dt='1/240'", 2);
    one.step(200), two.step(200);
    CHECK(sum_of(two) == doctest::Approx(step_of(two)).epsilon(0.02));
    CHECK(cost_of(two, "solver") > 0.2 * cost_of(one, "solver"));
    CHECK(one.hash() == two.hash());
}

TEST_CASE("trial steps of a swap are not steps of the run: neither sums nor medians include them")
{
    Scene s(
        "<component id='a' type='State/Shaft' inertia='1' angular_velocity='1'/><component id='air' type='Field/Drag' between='a' "
        "rotational='1'/>");
    s.step(10);
    const std::uint64_t steps = s.simulation().stepper().cost().steps();
    CHECK(steps == 10);
    REQUIRE(s.ask(simulation::SwapOperation{"solver", "Solver/RungeKutta4", {}}).done);
    CHECK(s.simulation().stepper().cost().steps() == steps);
    // Another algorithm begins a new account.
    CHECK(simulation::ComponentCosts(s.simulation().world(), s.simulation().stepper().cost())
              .of(s.simulation().world().find("solver"))
              .last.samples == 0);
    CHECK(simulation::ComponentCosts(s.simulation().world(), s.simulation().stepper().cost())
              .of(s.simulation().world().find("air"))
              .last.samples == 10);
}

TEST_CASE("two medians differ where quartiles of eight samples, or all of four, do not overlap")
{
    const auto spread = [](std::vector<double> v) { return simulation::spread_of(v); };
    const simulation::Spread low = spread({1, 2, 3, 4, 5}), high = spread({11, 12, 13, 14, 15}), wide = spread({1, 4, 8, 12, 20});
    CHECK(low.median == 3);
    CHECK(low.low == 2);
    CHECK(low.high == 4);
    CHECK(low.least == 1);
    CHECK(low.most == 5);
    CHECK(simulation::differ(low, high));
    CHECK_FALSE(simulation::differ(low, wide));
    CHECK_FALSE(simulation::differ(spread({1, 2, 3}), spread({100, 101, 102})));
    // Quartiles apart, one sample among the others.
    CHECK_FALSE(simulation::differ(spread({1, 2, 3, 4, 50}), high));
    CHECK(simulation::differ(spread({1, 2, 3, 4, 5, 6, 7, 50}), spread({11, 12, 13, 14, 15, 16, 17, 18})));
    CHECK(spread({}).samples == 0);
    CHECK_FALSE(spread({1, 2}).is_known());
}

TEST_CASE("equal costs differ by chance in less than 6 of 100 cases, whatever the number of samples")
{
    std::mt19937 random(7);
    // Step times: a constant minimum, and occasionally a longer one.
    std::exponential_distribution<double> noise(1);
    const auto samples = [&](int n)
    {
        std::vector<double> out;
        for (int i = 0; i < n; ++i) out.push_back(10 + noise(random));
        return simulation::spread_of(out);
    };
    for (const int n : {4, 5, 7, 8, 9, 11, 16})
    {
        int wrong = 0;
        for (int i = 0; i < 20000; ++i) wrong += simulation::differ(samples(n), samples(n)) ? 1 : 0;
        CHECK_MESSAGE(wrong < 1200, n, " samples: ", wrong, " of 20000");
    }
}
