// Pendulums, tops and hanging chains by every solver (catalogue: A4, A9, E1, E6). Digits and scenes: pendulums.h.
//
// Rows are satisfied at acceleration level in every evaluation of a solver, and projected after its step, so that each solver
// keeps its order. Exact has no closed form for constrained bodies and falls back to RungeKutta4, as does Automatic for soft,
// slow problems.
#include "reference/algorithms.h"
#include "reference/pendulums.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// Of the axis of A4's top, a length of 1.
double top_error(const SolverAlgorithm& algorithm, int steps, double until)
{
    Scene s(top(solver(algorithm)), per_second(steps));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(until);
    CHECK(s.real("j", "position_error") < 1e-13);
    return distance(top_axis(s), until == 1 ? kTopAt1 : kTopAtTenth);
}
double top_error_early(const SolverAlgorithm& algorithm, int steps) { return top_error(algorithm, steps, .1); }

/// rad, of the worse angle at 5 s.
double double_pendulum_error(const SolverAlgorithm& algorithm, int steps)
{
    Scene s(double_pendulum(solver(algorithm)), per_second(steps));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(5);
    CHECK(s.real("j2", "position_error") < 1e-13);
    const auto angles = double_pendulum_angles(s);
    return std::fmax(std::fabs(angles[0] - kDoublePendulumAt5[0]), std::fabs(angles[1] - kDoublePendulumAt5[1]));
}

/// rad, at 10 s.
double pendulum_error(const std::string& joint, const SolverAlgorithm& algorithm, int steps)
{
    Scene s(pendulum(solver(algorithm), joint), per_second(steps));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    double drift = 0;
    for (int i = 0; i < 10 * steps; ++i)
    {
        s.step();
        drift = std::fmax(drift, s.real("j", "position_error"));
    }
    CHECK(drift < 1e-14);
    return angle_error(s.vec("bob", "position"), kPendulumAt10);
}

/// State after 5/4 of the period, with `steps` per period: (x, v / w), relative to the amplitude. After a whole period some
/// errors would vanish by symmetry.
double mode_error(double w, const SolverAlgorithm& algorithm, int steps)
{
    Scene s(mode_chain(solver(algorithm), w), "dt='" + text(2 * M_PI / w / steps) + "'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(5 * steps / 4);
    const auto shape = mode_shape(w);
    double worst = 0;
    for (int k = 0; k < kModeLinks; ++k)
    {
        const double x = s.vec(mode_id(k), "position").x / kModeAmplitude, v = s.vec(mode_id(k), "linear_velocity").x / kModeAmplitude / w;
        worst = std::fmax(worst, std::hypot(x, v + shape[static_cast<std::size_t>(k)]));
    }
    return worst;
}

}  // namespace

TEST_CASE("A4: Lagrange's top at 200 rad/s with every solver, after 0.1 s and 1 s")
{
    // h |w| = 0.2 at 1/1000. Late: the nutation's phase at 1 s.
    struct Row
    {
        AlgorithmRow early;
        double late;
    };
    const Row table[] = {
        {{{"SemiImplicitEuler"}, 16000, 3.0e-4, 1}, 3.1e-3},
        {{{"StoermerVerlet"}, 1000, 7.2e-5, 2}, 6.2e-4},
        {{{"RotationSplitting", "order=\"2\""}, 1000, 1.1e-5, 2}, 1.5e-4},
        {{{"ImplicitMidpoint"}, 1000, 1.1e-5, 2}, 8.9e-5},
        {{{"RungeKutta4"}, 1000, 4.8e-8, 4}, 3.9e-7},
        {{{"RotationSplitting"}, 1000, 2.5e-9, 4}, 3.3e-8},
        {{{"Exponential"}, 1000, 1.2e-7, 4}, 9.2e-7},
        {{{"DormandPrince54"}, 1000, 6.4e-13, 0}, 6.8e-12},
        {{{"Radau5"}, 1000, 1.6e-10, 0}, 1.0e-9},
    };
    for (const Row& row : table)
    {
        check_algorithm(row.early, top_error_early);
        const std::string name = name_of(row.early.algorithm);
        CAPTURE(name);
        const double late = top_error(row.early.algorithm, row.early.steps, 1);
        MESSAGE(name << " late " << late);
        CHECK(late < 2 * row.late);
        if (row.early.order > 0) CHECK(late > row.late / 2);
    }
    check_same({"Exact"}, {"RungeKutta4"}, 1000, top_error_early);
    check_same({"Automatic"}, {"RungeKutta4"}, 2000, top_error_early);
    // From h |w| = 0.2 on it makes parts of the step.
    CHECK(top_error_early({"Automatic"}, 1000) < 0.1 * top_error_early({"RungeKutta4"}, 1000));
}

TEST_CASE("A9: a double pendulum with every solver, after 5 s")
{
    const AlgorithmRow table[] = {
        {{"SemiImplicitEuler"}, 1000, 0.17, 1},
        {{"StoermerVerlet"}, 1000, 1.15e-5, 2},
        {{"RotationSplitting", "order=\"2\""}, 1000, 1.4e-5, 2},
        {{"ImplicitMidpoint"}, 1000, 3.0e-5, 2},
        {{"RungeKutta4"}, 500, 5.9e-9, 4},
        {{"RotationSplitting"}, 250, 1.8e-10, 4},
        {{"Exponential"}, 100, 2.7e-6, 4},
        {{"DormandPrince54"}, 50, 1.4e-10, 0},
        {{"Radau5"}, 20, 2.4e-10, 0},
    };
    for (const AlgorithmRow& row : table) check_algorithm(row, double_pendulum_error);
    check_same({"Exact"}, {"RungeKutta4"}, 500, double_pendulum_error);
    check_same({"Automatic"}, {"RungeKutta4"}, 500, double_pendulum_error);
}

TEST_CASE("E1: a pendulum with every solver, after 10 s, on each kind of joint")
{
    // One motion, three sets of rows: the same error except for that of a body's rotation (a point on a rod has none).
    struct Row
    {
        AlgorithmRow at_hinge;
        double at_distance;
    };
    const Row table[] = {
        {{{"SemiImplicitEuler"}, 1000, 0.17, 1}, 0.35},
        {{{"StoermerVerlet"}, 200, 3.4e-4, 2}, 5.6e-4},
        {{{"RotationSplitting", "order=\"2\""}, 200, 1.7e-4, 2}, 5.2e-4},
        {{{"ImplicitMidpoint"}, 200, 4.4e-4, 2}, 5.8e-4},
        {{{"RungeKutta4"}, 200, 1.4e-8, 4}, 5.1e-8},
        {{{"RotationSplitting"}, 100, 4.0e-9, 4}, 2.4e-10},
        {{{"Exponential"}, 50, 3.2e-6, 4}, 5.2e-5},
        {{{"DormandPrince54"}, 20, 1.8e-10, 0}, 2.6e-9},
        {{{"Radau5"}, 10, 1.6e-10, 0}, 3.1e-9},
    };
    const auto on = [](const std::string& joint)
    { return [joint](const SolverAlgorithm& algorithm, int steps) { return pendulum_error(joint, algorithm, steps); }; };
    for (const Row& row : table)
    {
        check_algorithm(row.at_hinge, on("Hinge"));
        AlgorithmRow other = row.at_hinge;
        other.order = 0;
        check_algorithm(other, on("Ball"));
        other.reached = row.at_distance;
        check_algorithm(other, on("Distance"));
    }
    check_same({"Exact"}, {"RungeKutta4"}, 200, on("Hinge"));
    check_same({"Automatic"}, {"RungeKutta4"}, 200, on("Hinge"));
}

TEST_CASE("E6: modes of a hanging chain with every solver")
{
    // Phase errors by theory, w' = w (1 + c (h w)^2): c = 1/24 for StoermerVerlet and similar methods, -1/12 for ImplicitMidpoint;
    // over 5/4 periods that is 5/2 pi c (2 pi / steps)^2. SemiImplicitEuler: its ellipse in phase space is sheared by h w / 2. The
    // amplitude shifts the frequencies as well, by its square: the remaining error, 2e-8 in the first mode and 7e-8 in the third,
    // hides the order 4 there.
    const double turn = 2 * M_PI / 400, second = 2.5 * M_PI * turn * turn;
    const AlgorithmRow table[] = {
        {{"SemiImplicitEuler"}, 400, turn / 2, 1},
        {{"StoermerVerlet"}, 400, second / 24, 2},
        {{"RotationSplitting", "order=\"2\""}, 400, second / 24, 2},
        {{"ImplicitMidpoint"}, 400, second / 12, 2},
        {{"RungeKutta4"}, 200, 6.4e-8, 4},
        {{"RotationSplitting"}, 40, 1.07e-7, 4},
        {{"Exponential"}, 20, 2.8e-8, 0},
        {{"DormandPrince54"}, 20, 8.6e-9, 0},
        {{"Radau5"}, 8, 7.5e-8, 0},
    };
    for (const double w : kModes)
    {
        CAPTURE(w);
        const auto error = [w](const SolverAlgorithm& algorithm, int steps) { return mode_error(w, algorithm, steps); };
        for (const AlgorithmRow& row : table)
            if (w == kModes[0] || row.order == 1 || row.order == 2) check_algorithm(row, error);
        for (const int steps : {20, 40}) CHECK(error({"DormandPrince54"}, steps) < 1.5e-7);
        check_same({"Exact"}, {"RungeKutta4"}, 100, error);
        check_same({"Automatic"}, {"RungeKutta4"}, 100, error);
    }
}
