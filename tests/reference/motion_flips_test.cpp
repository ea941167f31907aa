// A3 flips of a wing nut, and A5 degenerate inertias, by the algorithms.
//
// A3: I = (3, 2, 1), w = (e, 10, e). The spin about the middle axis passes 0 first at (K - v) / p and then every 2 K / p, with
//     p^2 = (200 + 6 e^2) / 6, k'^2 = 4 e^2 / (200 + 6 e^2) and sd(v) k' = e / sqrt(100 + e^2) (Landau, Lifshitz, Mechanics, 37);
//     60 digits by the arithmetic-geometric mean and 30-point Gauss quadrature.
//     Error of the first flip for e = 1e-3, 1e-6, 1e-9, 1e-12, and of the interval to the second one for e = 1e-3, at 1/100:
//       Exact, Automatic    1e-9, 1e-8, 1e-5, 1e-2 s    1e-7 s
//       RotationSplitting   1e-6 s                      1e-6 s
//       RungeKutta4         1e-5 s                      1 s
//       DormandPrince54     1e-8 s                      1e-3 s
//       Radau5              1e-4 s                      1e-2 s
//     The state is the momentum in the world, whose rounding (2e-15 of 20 N m s) is a disturbance like e: below e = 1e-9 it
//     determines the second flip; for methods that do not conserve energy, their energy errors determine it.
// A5: symmetric tops precess in the body at (I3 - I1) / I1 w3; eigen-gaps of 1e-14 and balls keep their spin. The table below.
#include "reference/algorithms.h"

using namespace plab;
using namespace plab::test;

namespace
{

struct Flips
{
    double first = 0, second = 0;  ///< s
};

/// Zeros of the spin about the middle axis, by cubic Hermite interpolation in the step: its rate is known from Euler's equations.
Flips flips_of(const SolverAlgorithm& algorithm, double offset, int steps, double until)
{
    char spin[64];
    std::snprintf(spin, sizeof spin, "%.17g 10 %.17g", offset, offset);
    Scene s(solver(algorithm) + "<component id=\"nut\" type=\"State/RigidBody\" mass=\"1\" inertia=\"3 2 1\" angular_velocity=\"" + spin +
                "\"/>",
            per_second(steps));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const auto rate = [](const Vec3& w) { return (1 - 3) * w.x * w.z / 2; };
    Flips out;
    Vec3 before = body_spin(s, "nut");
    while (s.simulation().time() < until && out.second == 0)
    {
        s.step();
        const Vec3 now = body_spin(s, "nut");
        const double h = s.simulation().dt();
        if ((before.y > 0) != (now.y > 0))
        {
            double low = 0, high = 1;
            const auto at = [&](double x)
            {
                const double y = 1 - x;
                return before.y * (1 + 2 * x) * y * y + h * rate(before) * x * y * y + now.y * (3 - 2 * x) * x * x -
                       h * rate(now) * x * x * y;
            };
            for (int i = 0; i < 60; ++i) ((at(0.5 * (low + high)) > 0) == (before.y > 0) ? low : high) = 0.5 * (low + high);
            (out.first == 0 ? out.first : out.second) = s.simulation().time() - h * (1 - low);
        }
        before = now;
    }
    return out;
}

/// s, of the first flip at e = 1e-3.
double flip_error(const SolverAlgorithm& algorithm, int steps)
{
    return std::fabs(flips_of(algorithm, 1e-3, steps, 3).first - 1.66131075292830108);
}

struct Reference
{
    double offset, first, interval;  ///< rad/s, s
};
constexpr Reference kReferences[] = {{1e-3, 1.66131075292830108, 3.55072530396584808},
                                     {1e-6, 2.85776907950424868, 5.94364195789878048},
                                     {1e-9, 4.05422739044919485, 8.33655857978867360},
                                     {1e-12, 5.25068570139411342, 10.7294752016785107}};

Vec3 spin_after(const SolverAlgorithm& algorithm, const std::string& inertia, const std::string& spin, int steps, double until)
{
    Scene s(solver(algorithm) + "<component id=\"b\" type=\"State/RigidBody\" mass=\"1\" inertia=\"" + inertia + "\" angular_velocity=\"" +
                spin + "\"/>",
            per_second(steps));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(until);
    return body_spin(s, "b");
}

}  // namespace

TEST_CASE("A3: a wing nut flips at the time given by the elliptic integral, whatever the disturbance")
{
    struct Row
    {
        SolverAlgorithm algorithm;
        double first[4], interval;  ///< s
    };
    const Row table[] = {{{"Exact"}, {1e-9, 1e-8, 1e-5, 1e-2}, 1e-7},
                         {{"Automatic"}, {1e-9, 1e-8, 1e-5, 1e-2}, 1e-7},
                         {{"RotationSplitting"}, {1e-6, 1e-6, 1e-6, 1e-6}, 1e-6},
                         {{"RungeKutta4"}, {1e-5, 1e-5, 1e-5, 1e-5}, 1},
                         {{"DormandPrince54"}, {1e-8, 1e-8, 1e-8, 1e-8}, 1e-3},
                         {{"Radau5"}, {1e-4, 1e-4, 1e-4, 1e-4}, 1e-2}};
    for (const Row& row : table)
        for (std::size_t i = 0; i < 4; ++i)
        {
            const Reference& r = kReferences[i];
            const Flips found = flips_of(row.algorithm, r.offset, 100, r.first + 1.5 * r.interval);
            CAPTURE(row.algorithm.type);
            CAPTURE(r.offset);
            CAPTURE(found.first - r.first);
            CHECK(std::fabs(found.first - r.first) < row.first[i]);
            if (i == 0) CHECK(std::fabs(found.second - found.first - r.interval) < row.interval);
        }
}

TEST_CASE("A3: the first flip with every solver, and the order of each")
{
    const AlgorithmRow table[] = {
        {{"SemiImplicitEuler"}, 1000, 1.9e-4, 1},
        {{"StoermerVerlet"}, 100, 1.9e-3, 2},
        {{"RotationSplitting", "order=\"2\""}, 100, 8.2e-4, 2},
        {{"ImplicitMidpoint"}, 100, 9.6e-4, 2},
        {{"RungeKutta4"}, 100, 9.2e-7, 4},
        {{"RotationSplitting"}, 50, 5.4e-7, 4},
        {{"Exponential"}, 100, 4.3e-6, 4},
        {{"DormandPrince54"}, 100, 2.9e-10, 0},
        {{"Radau5"}, 100, 2.1e-6, 0},
        {{"Exact"}, 100, 5e-10, 0},  // the error of the interpolation between steps
    };
    for (const AlgorithmRow& row : table) check_algorithm(row, flip_error);
    check_same({"Automatic"}, {"Exact"}, 100, flip_error);
}

TEST_CASE("A5: degenerate tops with the algorithms")
{
    struct Top
    {
        std::string inertia, spin;
        double axial, lateral, rate;  ///< rad/s
        int steps;
        double until;
    };
    const Top tops[] = {{"1 1 2", "1 0 2", 2, 1, 2, 100, 3},
                        {"1 1 1e-12", "0.1 0 1000", 1000, 0.1, -1000, 100000, 0.1},
                        {"1 1.00000000000001 1", "1 0 2", 2, 1, 0, 100, 3},
                        {"2 2 2", "1 0 2", 2, 1, 0, 100, 3}};
    struct Row
    {
        SolverAlgorithm algorithm;
        double bound[4];
    };
    const Row table[] = {{{"Exact"}, {1e-12, 1e-9, 1e-13, 1e-13}},           {{"Automatic"}, {1e-12, 1e-9, 1e-13, 1e-13}},
                         {{"RotationSplitting"}, {1e-8, 1e-9, 1e-8, 1e-8}},  {{"RungeKutta4"}, {1e-6, 1e-8, 1e-13, 1e-13}},
                         {{"DormandPrince54"}, {1e-9, 1e-10, 1e-13, 1e-13}}, {{"Radau5"}, {1e-8, 1e-10, 1e-12, 1e-12}},
                         {{"ImplicitMidpoint"}, {1e-2, 1e-3, 1e-13, 1e-13}}, {{"StoermerVerlet"}, {1e-2, 1e-3, 1e-13, 1e-13}},
                         {{"SemiImplicitEuler"}, {0.5, 0.2, 1e-13, 1e-13}}};
    for (const Row& row : table)
        for (std::size_t i = 0; i < 4; ++i)
        {
            const Top& t = tops[i];
            CAPTURE(row.algorithm.type);
            CAPTURE(t.inertia);
            const Vec3 w = spin_after(row.algorithm, t.inertia, t.spin, t.steps, t.until);
            const double turned = t.rate * t.until;
            const double error = distance(w, {t.lateral * std::cos(turned), t.lateral * std::sin(turned), t.axial});
            CHECK(error < row.bound[i]);
        }
}
