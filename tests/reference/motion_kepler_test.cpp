// A6: Kepler's ellipse, e = 0.9, the force in a script, to t = 10 (1.59 orbits). Reference: Kepler's equation in 30 digits.
//
// rung                     force calls per orbit   error
// DormandPrince54, 1e-7    < 850                   3e-6
// DormandPrince54, 1e-9    < 1600                  1e-7
// DormandPrince54, 1e-11   < 3800                  1e-9
// the others at 1/1000 or 1/10: the table below; RungeKutta4's order: scripts_test.cpp
//
// 1e-9 with fewer than 400 calls is beyond a pair of order 5: with steps h ~ r^p placed by the known solution, p the best of
// 1.0, 1.05 .. 1.8, no step refused and 6 calls each, this pair reaches 2.1e-5 with 400 calls per orbit, 1.7e-8 with 1000,
// 3.4e-10 with 1900, 1.3e-12 with 4800 (a separate program). What is spent above that: one call in seven books the energy
// ledger, and error control spreads steps by tolerance, not by what the end needs.
#include "reference/motion.h"

using namespace plab;
using namespace plab::test;

namespace
{

struct Orbit
{
    double error = 0, calls = 0, energy = 0;  ///< m; per orbit; J, between ledger and kinetic energy
};

Orbit orbit(const SolverRung& rung, const std::string& step)
{
    Scene s(
        solver(rung) +
            R"(<component id="planet" type="State/RigidBody" mass="1" inertia="1 1 1" position="0.1 0 0" linear_velocity="0 4.358898943540674 0"/>
                   <component id="sun" type="Script/Lua" driven="planet"><param name="code">
                   function force(t, state)
                       local r = driven.position
                       local d = r:length()
                       driven:add_force(r * (-1 / (d * d * d)))
                   end</param></component>)",
        step);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    double calls = 0;
    const double before = s.simulation().totals().kinetic;
    while (s.simulation().time() < 10 - 1e-9)
    {
        s.step();
        calls += static_cast<double>(s.simulation().stepper().report().evaluations);
    }
    double work = 0;
    for (const double w : s.simulation().stepper().work()) work += w;
    return {distance(s.vec("planet", "position"), {-1.8538537094055792, -0.130885404839925551, 0}), calls * 2 * M_PI / 10,
            std::fabs(s.simulation().totals().kinetic - before - work)};
}

std::string tolerance(const std::string& relative) { return "relative_tolerance=\"" + relative + "\""; }

}  // namespace

TEST_CASE("A6: DormandPrince54 goes round in one step of 10 s, as well in steps of 0.1 s")
{
    struct Row
    {
        std::string tolerance;
        double calls, error;
    };
    for (const Row& row : {Row{"1e-7", 850, 3e-6}, Row{"1e-9", 1600, 1e-7}, Row{"1e-11", 3800, 1e-9}})
    {
        CAPTURE(row.tolerance);
        const std::string attributes = tolerance(row.tolerance);
        const Orbit once = orbit({"DormandPrince54", attributes}, "dt=\"10\""),
                    often = orbit({"DormandPrince54", attributes}, "dt=\"0.1\"");
        MESSAGE(row.tolerance << ": " << once.error << " " << once.calls << " " << once.energy << "; " << often.error << " "
                              << often.calls);
        CHECK(once.error < row.error);
        CHECK(once.calls < row.calls);
        CHECK(once.energy < 10 * row.error);
        CHECK(often.error < row.error);
        CHECK(often.calls < 2.5 * row.calls);
    }
}

TEST_CASE("A6: the other rungs")
{
    struct Row
    {
        SolverRung rung;
        std::string step;
        double error;
    };
    const Row table[] = {{{"Radau5"}, "dt=\"0.1\"", 1e-7},
                         {{"RungeKutta4"}, "dt=\"1/1000\"", 3e-6},
                         {{"RotationSplitting"}, "dt=\"1/1000\"", 1e-7},
                         {{"Exponential"}, "dt=\"1/1000\"", 2e-6},
                         {{"StoermerVerlet"}, "dt=\"1/1000\"", 0.03},
                         {{"ImplicitMidpoint"}, "dt=\"1/1000\"", 0.03},
                         {{"SemiImplicitEuler"}, "dt=\"1/1000\"", 0.1},
                         {{"Automatic"}, "dt=\"1/1000\"", 3e-6}};
    for (const Row& row : table)
    {
        CAPTURE(row.rung.type);
        const Orbit o = orbit(row.rung, row.step);
        MESSAGE(row.rung.type << ": " << o.error << " " << o.calls);
        CHECK(o.error < row.error);
    }
}
