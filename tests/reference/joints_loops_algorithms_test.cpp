// Closed loops, a heavy chain and contradictory joints, with every solver and, for rows with bounded impulses, with every
// manager (catalogue: E4, E5, E8). Reference digits and scenes: joints_loops_test.cpp, linkages.h, pendulums.h.
//
// Managers satisfy rows with bounded impulses (limits, weak motors, contacts); the joints of a group without such rows are the
// solver's. E5 is therefore run twice: with joints, by solvers, and with ropes (distance limits), by managers. E2, E4 and E8
// have no such rows. For E2 see joints_fourbars_algorithms_test.cpp.
#include <algorithm>

#include "reference/algorithms.h"
#include "reference/pendulums.h"
#include "support/linkages.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// m, largest error of the rocker's end in one turn.
double four_bar_error(const SolverAlgorithm& algorithm, int steps)
{
    Scene s(FourBar::scene(solver(algorithm)), per_second(steps));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    double worst = 0;
    for (int i = 0; i < steps; ++i)
    {
        s.step();
        worst = std::fmax(worst, FourBar::error(s));
    }
    return worst;
}

struct Hanging
{
    double tension = 0, stretch = 0;  ///< relative to each link's load, the worst; m, of the whole
};
Hanging measure_chain(const Scene& s, int links)
{
    Hanging out;
    for (int i = 0; i <= links; ++i)
    {
        const double load = (1000 + links - i) * 9.81;
        out.tension = std::fmax(out.tension, std::fabs(length(s.vec("j" + chain_id(i), "force")) / load - 1));
    }
    out.stretch = std::fabs(s.vec(chain_id(links), "position").z + .1 * (links + 1));
    return out;
}

}  // namespace

TEST_CASE("E4: a four-bar with a motor, with every solver")
{
    // The motor's row and the loop leave no freedom, and its speed is constant, which all solvers integrate without error. The
    // remaining error is that of rows that change within a step and are then projected.
    const AlgorithmRow table[] = {
        {{"SemiImplicitEuler"}, 240, 1.1e-10, 0},
        {{"StoermerVerlet"}, 240, 1.2e-11, 2},
        {{"RotationSplitting", "order=\"2\""}, 240, 5.9e-12, 2},
        {{"ImplicitMidpoint"}, 240, 5.9e-12, 2},
        {{"RungeKutta4"}, 60, 6.6e-14, 0},
        {{"RotationSplitting"}, 60, 5e-15, 0},
        {{"Exponential"}, 20, 5.2e-13, 0},
        {{"DormandPrince54"}, 20, 5e-15, 0},
        {{"Radau5"}, 10, 5e-15, 0},
    };
    for (const AlgorithmRow& row : table) check_algorithm(row, four_bar_error);
    check_same({"Exact"}, {"RungeKutta4"}, 60, four_bar_error);
    check_same({"Automatic"}, {"RungeKutta4"}, 60, four_bar_error);
}

TEST_CASE("E5: a chain under a tonne, with every solver: it hangs still, so no order can be observed")
{
    for (const SolverAlgorithm& algorithm : kEverySolver)
    {
        const std::string name = name_of(algorithm);
        CAPTURE(name);
        // Dense methods: 12 numbers per link, at a cubic cost.
        const int links = algorithm.type == "Radau5" || algorithm.type == "Exponential" ? 10 : 100;
        Scene s(heavy_chain(solver(algorithm), links), per_second(60));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.step(10);
        const Hanging found = measure_chain(s, links);
        MESSAGE(name << ": tension " << found.tension << " stretch " << found.stretch);
        CHECK(found.tension < 1.1e-14);  // twice the error reached
        CHECK(found.stretch < 1e-14);
    }
}

TEST_CASE("E5: the same chain of ropes, with every manager")
{
    // A tonne on a hundred links of a kilogram: sweeps alone would let it fall (4.9 m in 1 s).
    struct Row
    {
        std::string manager;
        double tension, stretch;  ///< relative; m
    };
    for (const Row& row :
         {Row{"Direct", 1.6e-13, 6.9e-14}, Row{"SequentialImpulse", 2.3e-16, 9.1e-10}, Row{"SoftStep", 1.8e-6, 8.2e-6}})
    {
        CAPTURE(row.manager);
        Scene s("<component id='manager' type='Manager/" + row.manager + "'/>" +
                    heavy_chain(solver_is("RungeKutta4"), 100, "Limit",
                                "along='distance' anchor_a='0 0 0' anchor_b='0 0 0' upper='0.1' manager='manager'"),
                dt(240));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = s.keep_events = true;
        s.run(1);
        const Hanging found = measure_chain(s, 100);
        MESSAGE(row.manager << ": tension " << found.tension << " stretch " << found.stretch << " reports "
                            << s.count("manager.not_converged"));
        CHECK(found.tension < 2 * row.tension);
        CHECK(found.stretch < 2 * row.stretch);
        CHECK(s.count("manager.not_converged") == 0);
    }
}

TEST_CASE("E8: pins too far apart, with every solver: both share the error, both are named")
{
    for (const SolverAlgorithm& algorithm : kEverySolver)
    {
        const std::string name = name_of(algorithm);
        CAPTURE(name);
        Scene s(torn_rod(solver(algorithm)), per_second(240));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = s.keep_events = true;
        double most = 0;
        for (int i = 0; i < 240; ++i)
        {
            s.step();
            most = std::fmax(most, s.simulation().totals().kinetic);
        }
        CHECK(std::fabs(s.real("left", "position_error") - .1) < 1e-6);
        CHECK(std::fabs(s.real("right", "position_error") - .1) < 1e-6);
        CHECK(length(s.vec("rod", "position")) < 1e-6);
        CHECK(most < 1e-9);
        CHECK(s.count("constraint.contradiction") == 2);
        for (const char* pin : {"left", "right"})
            CHECK(std::any_of(s.events.begin(), s.events.end(),
                              [&](const Event& e)
                              { return e.kind == "constraint.contradiction" && e.component == s.simulation().world().find(pin); }));
    }
}
