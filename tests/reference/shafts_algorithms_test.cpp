// F1, F2, F3, F7 and F8 with every solver and every kind of gear.
//
// kind      F1 pair   F2 six meshes 10:1, down, up   F3 engaged at run time   F7 line
// Graph     1e-13     2e-14, torques too             1e-14                    no drift: angles are derived
// Gear      1e-13     2e-15, 3e-7                    1e-14                    1e-13 of 100
// Impulse   1e-13     2e-15, 8e-8                    1e-14                    3e-15 of 10; 1000: it reports that it does not hold
// Assign    one way: the driver feels nothing; ratios to 2e-15
//
// Speeds under a constant torque are exact for every solver, angles for all but SemiImplicitEuler, which is ahead by h alpha t / 2.
#include <numbers>

#include "reference/algorithms.h"
#include "reference/shafts.h"
#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// The error that a solver of order 1 adds to the angle under a constant angular acceleration.
double ahead(const SolverAlgorithm& algorithm, double acceleration, double t, double h)
{
    return algorithm.type == "SemiImplicitEuler" ? 0.5 * h * acceleration * t : 0;
}

/// F8: released horizontally, with `steps` steps per period: m + m/s.
double geared_pendulum_error(const SolverAlgorithm& algorithm, int steps)
{
    // About the pivot: inertia .5, m g l = 4.905; flywheel .005 at ratio 10.
    const double period = 4 * 1.8540746773013719 / std::sqrt(4.905 / (.5 + 100 * .005));
    Scene s(solver(algorithm) + gravity() + body("bob", 1, {.25, .25, .25}, {.5, 0, 0}) +
                joint("pivot", "Hinge", "", "bob", "anchor='0 0 0' axis='0 1 0'") + shaft("wheel", .005) +
                "<component id='gear' type='Constraint/Gear' driver='bob' driven='wheel' velocity_factor='10' driver_axis='0 1 0'/>",
            "dt='" + text(period / steps) + "'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(steps);
    CHECK(std::fabs(s.real("gear", "phase_error")) < 1e-12);
    return distance(s.vec("bob", "position"), {.5, 0, 0}) + length(s.vec("bob", "linear_velocity"));
}

}  // namespace

TEST_CASE("F1: a pair with every kind of gear, every solver, steps of 1/10 to 1/1000")
{
    for (const char* type : {"Graph", "Impulse", "Gear", "Assign"})
        for (const SolverAlgorithm& algorithm : kEverySolver)
            for (const int steps : {10, 100, 1000})
            {
                const std::string name = name_of(algorithm);
                CAPTURE(type);
                CAPTURE(name);
                CAPTURE(steps);
                Scene s(solver(algorithm) + shaft("a", 10) + shaft("b", 100) + gear("g", type, "a", "b", "-0.1") + torque("a", "6"),
                        per_second(steps));
                REQUIRE_MESSAGE(s.loaded(), s.error());
                s.run(1);
                const double alpha = std::string(type) == "Assign" ? 0.6 : 6.0 / 11;
                const double angle = 0.5 * alpha + ahead(algorithm, alpha, 1, 1.0 / steps);
                CHECK(near(s.spin("a"), alpha, 1e-13));
                CHECK(near(s.spin("b"), -0.1 * alpha, 1e-13));
                CHECK(near(s.angle("a"), angle, 1e-13));
                CHECK(near(s.angle("b"), -0.1 * angle, 1e-13));
                if (alpha < 0.6) CHECK(near(s.real("g", "torque"), -100 * 0.6 / 11, 1e-13));
            }
}

TEST_CASE("F2: six meshes both ways with every solver and step, with the torque of each mesh")
{
    for (const double factor : {0.1, 10.})
        for (const SolverAlgorithm& algorithm : kEverySolver)
            for (const int steps : {10, 100, 1000})
            {
                const std::string name = name_of(algorithm);
                CAPTURE(name);
                CAPTURE(factor);
                CAPTURE(steps);
                Scene s(solver(algorithm) + six_meshes("Graph", text(factor)), per_second(steps));
                REQUIRE_MESSAGE(s.loaded(), s.error());
                s.run(1);
                const double alpha = 1 / inertia_from(0, factor);
                const double kicks = algorithm.type == "Exact" || name == "RotationSplitting" ? 6 * steps : steps;
                CHECK(std::fabs(s.spin("s0") / alpha - 1) < 2e-14 * std::sqrt(kicks / 100));  // rounding, kick by kick
                for (int i = 0; i < 6; ++i)
                {
                    const double torque = inertia_from(i + 1, factor) * alpha * std::pow(factor, i + 1);
                    CHECK(std::fabs(s.real("g" + std::to_string(i), "torque") / torque - 1) < 2e-14);
                }
                CHECK(std::fabs(s.spin("s6") / s.spin("s0") / std::pow(factor, 6) - 1) < 1e-14);
            }
}

TEST_CASE("F2: with the other kinds of gears")
{
    struct Row
    {
        std::string type;
        double factor, speed, ratio;  ///< relative errors of the first shaft's speed and of the last one's to it
    };
    // Step-up: the torque alone would give the first shaft 1e3 rad/s^2, of which 1e-9 remain. Rows and pairwise impulses compute
    // this as a difference: at most 1e12 roundings of 1e-16, actually 1e-7.
    const Row table[] = {{"Gear", 0.1, 1e-15, 1e-15},     {"Gear", 10, 1.4e-7, 1.4e-7},  {"Impulse", 0.1, 1e-15, 1e-15},
                         {"Impulse", 10, 3.8e-8, 3.8e-8}, {"Assign", 0.1, 1e-15, 1e-15}, {"Assign", 10, 1e-15, 1e-15}};
    for (const Row& row : table)
    {
        CAPTURE(row.type);
        CAPTURE(row.factor);
        Scene s(six_meshes(row.type, text(row.factor)), per_second(100));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(1);
        const double alpha = row.type == "Assign" ? 1e3 : 1 / inertia_from(0, row.factor);
        const double speed = std::fabs(s.spin("s0") / alpha - 1),
                     ratio = std::fabs(s.spin("s6") / s.spin("s0") / std::pow(row.factor, 6) - 1);
        MESSAGE(row.type << " " << row.factor << ": " << speed << " " << ratio);
        CHECK(speed <= 2 * row.speed);
        CHECK(ratio <= 2 * row.ratio);
    }
}

TEST_CASE("F3: engaged at run time, with every kind of gear and every solver")
{
    for (const std::string type : {"Graph", "Impulse", "Gear", "Assign"})
        for (const SolverAlgorithm& algorithm : kEverySolver)
        {
            const std::string name = name_of(algorithm);
            CAPTURE(type);
            CAPTURE(name);
            Scene s(solver(algorithm) + shaft("a", 1, 100) + shaft("b", 2), per_second(100));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.step();
            const auto compiled = compile_text(whole_scene(gear("g", type, "a", "b", "-0.5")), "add.xml", &s.simulation().world().scene());
            REQUIRE_MESSAGE(compiled.ok(), reasons(compiled));
            const auto reply = s.ask(simulation::AddOperation{*compiled});
            REQUIRE_MESSAGE(reply.done, first_error(reply.errors));
            s.step();
            const bool one_way = type == "Assign";  // 100 rad/s continue; the driven shaft's energy is added without a source, and booked
            CHECK(near(s.spin("a"), one_way ? 100 : 200.0 / 3, 1e-14));
            CHECK(near(s.spin("b"), one_way ? -50 : -100.0 / 3, 1e-14));
            CHECK(near(s.simulation().totals().kinetic - 5000, one_way ? 2500 : -5000.0 / 3, 1e-12));
        }
}

TEST_CASE("F7: a line of 1000 gears with every solver: angles are derived, so none drifts")
{
    const GearLine line(1000, "Graph");
    for (const SolverAlgorithm& algorithm : kEverySolver)
    {
        const std::string name = name_of(algorithm);
        CAPTURE(name);
        Scene s(solver(algorithm) + line.parts, per_second(100));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.step(50);
        CHECK(GearLine::drift(s) == 0);
        CHECK(line.phase(s) < 1e-12);
    }
}

TEST_CASE("F7: a line of gears of the other kinds")
{
    struct Row
    {
        std::string type;
        int shafts, steps;
        double phase;   ///< relative, of the angles
        bool reported;  ///< whether a failure to hold is reported
    };
    for (const Row& row : {Row{"Assign", 1000, 100, 3e-15, false}, Row{"Gear", 100, 100, 6e-14, false},
                           Row{"Impulse", 10, 100, 1.6e-15, false}, Row{"Impulse", 1000, 5, 1, true}})
    {
        CAPTURE(row.type);
        CAPTURE(row.shafts);
        const GearLine line(row.shafts, row.type);
        Scene s(line.parts, per_second(100));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = s.keep_events = true;
        s.step(row.steps);
        const double phase = line.phase(s);
        MESSAGE(row.type << " " << row.shafts << ": " << phase << " events " << s.events.size());
        CHECK(phase < 2 * row.phase);
        CHECK(s.count("coupling.not_converged") == (row.reported ? 1 : 0));
        if (row.reported) CHECK(phase > 0.5);  // the motion has not reached the far end yet
    }
}

TEST_CASE("F8: a pendulum geared to a flywheel, with every solver: the state after a period at 90 deg")
{
    const AlgorithmRow table[] = {
        {{"SemiImplicitEuler"}, 400, 3.4e-2, 1},
        {{"StoermerVerlet"}, 200, 3.4e-4, 2},
        {{"RotationSplitting", "order=\"2\""}, 200, 9.1e-5, 2},
        {{"ImplicitMidpoint"}, 200, 4.0e-4, 2},
        {{"RungeKutta4"}, 200, 7.4e-8, 4},
        {{"RotationSplitting"}, 50, 1.6e-7, 4},
        {{"Exponential"}, 50, 1.3e-6, 0},  // its order is visible only with shorter steps
        {{"Exponential"}, 200, 5.0e-8, 4},
        {{"DormandPrince54"}, 20, 4.6e-11, 0},
        {{"Radau5"}, 10, 2.2e-11, 0},
    };
    for (const AlgorithmRow& row : table) check_algorithm(row, geared_pendulum_error);
    check_same({"Exact"}, {"RungeKutta4"}, 200, geared_pendulum_error);
    check_same({"Automatic"}, {"RungeKutta4"}, 200, geared_pendulum_error);
}
