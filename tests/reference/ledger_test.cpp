// The ledger closes where time goes back within a step, and where a joint comes that speeds do not fit: kinetic energy = at the start +
// work of all components.
#include "swaps.h"

using namespace plab;
using namespace plab::test;

namespace
{

double unexplained(const Scene& s)
{
    const simulation::Totals t = s.simulation().totals();
    return t.kinetic - s.simulation().kinetic_at_start() - t.work;
}

/// J: the worst of one second, at 1/60 s. The ball is thrown upwards at first, so that its bounces come at any time of a step.
double worst_of_bounces(const std::string& solver, const std::string& resolution, const std::string& response)
{
    Scene s(gravity() + solver_is(solver) +
                solid("ball", "Sphere' radius='0.1'", 10, {0, 0, 0.5}, "solver='solver' linear_velocity='1 0 1'") +
                ground_and_contact(resolution, response),
            dt(60));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = s.keep_events = true;
    double worst = 0;
    for (int i = 0; i < 60; ++i)
    {
        s.step();
        worst = std::max(worst, std::fabs(unexplained(s)));
    }
    CHECK(s.count("contact.impact") >= 1);
    return worst;
}

}  // namespace

TEST_CASE("what an event takes back is taken back in the ledger, by every solver")
{
    for (const std::string& solver : solvers())
        for (const std::string& resolution : resolutions())
        {
            if (resolution == "None" || resolution == "Speculative") continue;
            CAPTURE(solver);
            CAPTURE(resolution);
            // One kick of the method of order 1 is (h g)^2 m / 2 = 0.13 J short, with either sign where the ball turns round.
            const double most = solver == "SemiImplicitEuler" ? 60 * 0.14 : 1e-9;
            CHECK(worst_of_bounces(solver, resolution, "Impulse' response.restitution='0.8") <= most);
        }
}

TEST_CASE("a spring that begins and ends within a step is booked as far as it pushed")
{
    // What is left is the method's: springs in 20 pieces per contact, of which each is one step of it.
    const auto most = [](const std::string& solver)
    {
        if (solver == "SemiImplicitEuler") return 40.0;
        if (solver == "StoermerVerlet") return 0.5;
        return solver == "RungeKutta4" || solver == "Automatic" ? 1e-2 : 1e-4;
    };
    for (const std::string& solver : solvers())
    {
        CAPTURE(solver);
        const double worst =
            worst_of_bounces(solver, "None", "Penalty' response.stiffness='1e5' response.restitution='0.5' response.steps_per_contact='20");
        MESSAGE(solver, " ", worst, " J");
        CHECK(worst <= most(solver));
    }
}

TEST_CASE("a joint that stops what swings books the blow, with springs in the scene too")
{
    for (const char* response : {"Impulse", "Penalty"})
    {
        CAPTURE(response);
        Scene s(gravity() + solver_is("RungeKutta4") + solid("ball", "Sphere' radius='0.1'", 10, {0, 5, 0.1}, "solver='solver'") +
                    body("arm", 2, {0.01, 0.01, 0.01}, {0.5, 0, 5}, "solver='solver'") +
                    joint("joint", "Ball", "", "arm", "anchor='" + text(Vec3{0, 0, 5}) + "'") + ground_and_contact("None", response),
                dt(240));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = true;
        s.step(60);
        const double before = s.simulation().totals().kinetic;
        REQUIRE(before > 5);
        swapped(s, "joint", "Constraint/Fixed");
        s.step();
        CHECK(s.simulation().totals().kinetic < 0.01 * before);
        CHECK(std::fabs(unexplained(s)) <= 1e-6);
    }
}
