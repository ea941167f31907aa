// E2 with every solver: two four-bar linkages that pass their singular configurations twice per turn. The scene is in
// linkages.h.
#include "reference/algorithms.h"
#include "support/linkages.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// E2's bars move as one pendulum of w^2 = g ((N+1)/2 + N) / ((N+1)/3 + N): the top of the first one, from upright at 1 rad/s.
Vec3 four_bars_top(int bars, double t)
{
    const double square = 9.81 * (1.5 * bars + .5) / (4. / 3 * bars + 1. / 3);
    constexpr int n = 40000;
    const double h = t / n;
    double angle = 0, speed = 1;
    for (int i = 0; i < n; ++i)  // the classical method, to rounding
    {
        const double a1 = square * std::sin(angle), v2 = speed + h / 2 * a1, a2 = square * std::sin(angle + h / 2 * speed),
                     v3 = speed + h / 2 * a2, a3 = square * std::sin(angle + h / 2 * v2), v4 = speed + h * a3,
                     a4 = square * std::sin(angle + h * v3);
        angle += h / 6 * (speed + 2 * v2 + 2 * v3 + v4), speed += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    return {std::sin(angle), 0, std::cos(angle)};
}

/// m, error of the top after 3.6 s: more than one turn, two singular configurations.
double four_bars_error(const SolverAlgorithm& algorithm, int steps)
{
    Scene s(four_bars(2, solver(algorithm)), per_second(steps));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(3.6);
    for (int i = 0; i < 2; ++i) CHECK(s.real("r" + number(i), "position_error") < 1e-12);
    static const Vec3 expected = four_bars_top(2, 3.6);
    return distance(top_of(s), expected);
}

}  // namespace

TEST_CASE("E2: two four-bars pass their singular configurations, with every solver")
{
    CHECK(distance(four_bars_top(2, 10), {.328458111540815379, 0, .944518538178600962}) < 1e-11);
    CHECK(distance(four_bars_top(40, 10), {.18051222668672839, 0, .983572740582311575}) < 1e-11);
    // Observed orders above 2: the passage through singular configurations leaves an error of order 3, which dominates.
    const AlgorithmRow table[] = {
        {{"SemiImplicitEuler"}, 500, 0.86, 1},
        {{"StoermerVerlet"}, 200, 2.6e-4, 2.75},
        {{"RotationSplitting", "order=\"2\""}, 250, 2.9e-5, 2},
        {{"ImplicitMidpoint"}, 50, 1.7e-3, 2.9},
        {{"RungeKutta4"}, 125, 6.2e-8, 4},
        {{"Exponential"}, 20, 1.4e-8, 0},
        {{"DormandPrince54"}, 50, 1.0e-9, 0},
        {{"Radau5"}, 5, 6.1e-10, 0},
    };
    for (const AlgorithmRow& row : table) check_algorithm(row, four_bars_error);
    // RotationSplitting of order 4 moves forward and back within a step, off the rows. It comes closer to singular
    // configurations than other solvers do, and its result depends on where its kicks fall. At 1/100 it continues as a different
    // linkage. Nothing reports that.
    CHECK(four_bars_error({"RotationSplitting"}, 80) < 1e-4);
    CHECK(four_bars_error({"RotationSplitting"}, 100) > 1);
    check_same({"Exact"}, {"RungeKutta4"}, 50, four_bars_error);
    check_same({"Automatic"}, {"RungeKutta4"}, 50, four_bars_error);
}
