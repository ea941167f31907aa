// B1, B3 and B4 for the algorithms that springs_test.cpp leaves out, and the limits of the algorithms.
//
// B1, 30 steps of 10 ms:
//   ImplicitMidpoint        any k: the recursion of its closed form, R(z) = (1 + z/2) / (1 - z/2) for each z = h lambda
//   SemiImplicitEuler .. RotationSplitting
//                           h w = 1 (k = 1e4): stable; h w = 10 and more: they diverge, which is reported when values overflow
//   Exact                   is RotationSplitting of order 4 here, as its forces are not uniform
//   DormandPrince54         k = 1e10, 1e12: gives up after max_substeps, which is reported
// B3, the drag in a script (airflow): all solvers, the table below
// B4, the transient in steps of 1e-7 s: all solvers, (R(-0.1))^20 of each
#include <complex>

#include "reference/algorithms.h"

using namespace plab;
using namespace plab::test;

namespace
{

using Complex = std::complex<double>;

const SolverAlgorithm kExplicit[] = {{"SemiImplicitEuler"}, {"StoermerVerlet"}, {"RungeKutta4"}, {"RotationSplitting", "order=\"2\""},
                                     {"RotationSplitting"}, {"Exact"}};

std::string damped(const SolverAlgorithm& algorithm, double k) { return spring_scene(algorithm, k, 0.1 * std::sqrt(k)); }

/// Position, and speed divided by w, of the spring released at 1 m, if each step multiplies by `factor`.
Complex swing_by(double k, const Complex& factor, int steps)
{
    const double zeta = 0.05, root = std::sqrt(1 - zeta * zeta);
    const Complex lambda = std::sqrt(k) * Complex{-zeta, root}, turned = Complex{1, -zeta / root} * std::pow(factor, steps);
    return {turned.real(), (lambda / std::sqrt(k) * turned).real()};
}

/// m/s after 2e-6 s of drag with c/m = 1e6 1/s against a wind of 10 m/s, 20 steps.
double windy_speed(const SolverAlgorithm& algorithm)
{
    Scene s(solver(algorithm) + R"(<component id="ball" type="State/RigidBody" mass="1" inertia="1 1 1"/>
                              <component id="drag" type="Field/Drag" between="ball" linear="1e6" medium_velocity="10 0 0"/>)",
            "dt=\"1e-7\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(20);
    return s.vec("ball", "linear_velocity").x;
}

/// Relative, of the position after 5 s and of the final speed after 65 s.
double script_fall_error(const SolverAlgorithm& algorithm, int steps)
{
    Scene s(solver(algorithm) + R"(<component id="ball" type="State/RigidBody" mass="1" inertia="1 1 1"/>
                              <component id="g" type="Field/Gravity" between="ball"/>
                              <component id="drag" type="Script/Lua" driven="ball"><param name="code">
                              function force(t, state)
                                  local v = driven.velocity
                                  driven:add_force(v * (-0.01 * v:length()))
                              end</param></component>)",
            per_second(steps));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(5);
    const double place = std::fabs(s.vec("ball", "position").z / -91.5600402510837169 - 1);
    s.run(65);
    CHECK(std::fabs(s.vec("ball", "linear_velocity").z / -31.3209195267316505 - 1) < 1e-12);
    return place;
}

}  // namespace

TEST_CASE("B1: ImplicitMidpoint follows the recursion of its closed form at any stiffness: it oscillates, and does not diverge")
{
    for (const double k : {1e2, 1e4, 1e6, 1e8, 1e10, 1e12})
    {
        CAPTURE(k);
        Scene s(damped({"ImplicitMidpoint"}, k), per_second(100));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(0.3);
        const Complex z = 0.01 * std::sqrt(k) * Complex{-0.05, std::sqrt(1 - 0.0025)}, one = 1;
        const Complex expected = swing_by(k, (one + 0.5 * z) / (one - 0.5 * z), 30);
        const Complex found{s.vec("mass", "position").x, s.vec("mass", "linear_velocity").x / std::sqrt(k)};
        MESSAGE("k " << k << ": off its recursion by " << std::abs(found - expected) << ", off the truth by "
                     << std::abs(found - swing_by(k, std::exp(z), 30)));
        CHECK(std::abs(found - expected) < 7e-12);  // its iteration ends at 1e-12 of a step
    }
}

TEST_CASE("B1: explicit algorithms stay within the amplitude below their limit, and diverge beyond it until that is reported")
{
    for (const SolverAlgorithm& algorithm : kExplicit)
        for (const double k : {1e4, 1e6, 1e8, 1e10, 1e12})
        {
            const std::string name = name_of(algorithm);
            CAPTURE(name);
            CAPTURE(k);
            Scene s(damped(algorithm, k), per_second(100));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.warnings_expected = s.keep_events = true;
            s.step(30);
            const double place = s.vec("mass", "position").x;
            const bool ended = s.count("state.not_finite") > 0;
            MESSAGE(name << " " << k << ": " << place << std::string(ended ? ", reported" : ""));
            if (k < 1e5)
            {
                CHECK(std::fabs(place) < 1);
                continue;
            }
            CHECK((ended || std::fabs(place) > 1e10));
            s.step(400);
            CHECK(s.count("state.not_finite") > 0);
            CHECK(is_finite(s.vec("mass", "position")));
        }
}

TEST_CASE("B1: the method to which Exact falls back, and the limit at which DormandPrince54 gives up")
{
    for (const double k : {1e2, 1e4})
    {
        const auto place = [k](const SolverAlgorithm& algorithm, int steps)
        {
            Scene s(damped(algorithm, k), per_second(steps));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.keep_events = true;
            s.run(0.3);
            CHECK(s.count("solver.fell_back") == (algorithm.type == "Exact" ? 1 : 0));
            return s.vec("mass", "position").x;
        };
        check_same({"Exact"}, {"RotationSplitting"}, 1000, place);
    }
    for (const double k : {1e10, 1e12})
    {
        CAPTURE(k);
        Scene s(damped({"DormandPrince54", "max_substeps=\"1000\""}, k), per_second(100));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = s.keep_events = true;
        s.step();
        REQUIRE(s.count("solver.gave_up") == 1);
        CHECK(s.events.back().message.find("Solver/Radau5") != std::string::npos);
    }
}

TEST_CASE("B3: quadratic drag in a script, with every solver")
{
    const AlgorithmRow table[] = {
        {{"SemiImplicitEuler"}, 60, 3.7e-3, 1},
        {{"StoermerVerlet"}, 60, 1.07e-7, 2},
        {{"RotationSplitting", "order=\"2\""}, 60, 2.1e-6, 2},
        {{"ImplicitMidpoint"}, 60, 5.3e-8, 2},
        {{"RungeKutta4"}, 20, 2.9e-10, 4},
        {{"RotationSplitting"}, 10, 5.4e-10, 4},
        {{"Exponential"}, 40, 1.8e-10, 4},
        {{"DormandPrince54"}, 10, 2.2e-14, 0},
        {{"Radau5"}, 10, 4.5e-9, 0},
    };
    for (const AlgorithmRow& row : table) check_algorithm(row, script_fall_error);
    check_same({"Exact"}, {"RotationSplitting"}, 10, script_fall_error);
    check_same({"Automatic"}, {"RungeKutta4"}, 20, script_fall_error);
}

TEST_CASE("B4: the transient of stiff drag, with every solver: its stability function to the 20th power")
{
    // z = -h c / m = -0.1.
    const double z = -0.1, fourth = 1 + z + z * z / 2 + z * z * z / 6 + z * z * z * z / 24;
    struct Row
    {
        SolverAlgorithm algorithm;
        double factor, within;  ///< per step; m/s
    };
    const Row table[] = {
        {{"SemiImplicitEuler"}, 1 + z, 1e-12},
        // Half a kick, then half a kick evaluated at the predicted final speed.
        {{"StoermerVerlet"}, 1 + z + z * z / 2, 1e-12},
        {{"RungeKutta4"}, fourth, 1e-12},
        {{"RotationSplitting", "order=\"2\""}, fourth, 1e-12},  // one kick over the step, by RungeKutta4
        {{"ImplicitMidpoint"}, (1 + z / 2) / (1 - z / 2), 7e-12},
        {{"Exponential"}, std::exp(z), 1e-12},
        {{"RotationSplitting"}, std::exp(z), 1.5e-7},
        {{"Exact"}, std::exp(z), 1.5e-7},
        {{"Automatic"}, fourth, 1e-12},  // the problem is soft at such a step
        {{"DormandPrince54"}, std::exp(z), 3e-10},
        {{"Radau5"}, std::exp(z), 1.2e-9},
    };
    for (const Row& row : table)
    {
        const std::string name = name_of(row.algorithm);
        CAPTURE(name);
        const double found = windy_speed(row.algorithm);
        MESSAGE(name << ": off its own by " << found - 10 * (1 - std::pow(row.factor, 20)) << ", off the truth by "
                     << found - 10 * (1 - std::exp(-2.0)));
        CHECK(std::fabs(found - 10 * (1 - std::pow(row.factor, 20))) < row.within);
    }
}
