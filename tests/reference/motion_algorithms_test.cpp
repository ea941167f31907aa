// A1 and A2 with every solver algorithm. References: closed forms; for A2 Jacobi's elliptic functions in 30 digits, checked
// against an extrapolation method in 113-bit arithmetic.
//
// A1 projectile, 2 s            Semi-implicit Euler g dt T / 2, all others 1e-13 relative, at 1/60 and 1/960
// A2 free box, attitude at 5 s  at 1/100 and 1/1000, and the observed order between 1/100 and 1/400: the table below. Aims: 1e-7 at
//                               1/100 and 1e-11 at 1/1000, which RungeKutta4 and the better ones reach; momentum to the last bit with all
#include "reference/algorithms.h"

using namespace plab;
using namespace plab::test;

namespace
{

const SolverAlgorithm kExactForConstant[] = {{"StoermerVerlet"},    {"RungeKutta4"},      {"RotationSplitting", "order=\"2\""},
                                             {"RotationSplitting"}, {"ImplicitMidpoint"}, {"Exact"},
                                             {"Automatic"},         {"DormandPrince54"},  {"Radau5"},
                                             {"Exponential"}};

/// m, after 2 s of flight from (0, 10, 0) with (5, 10, 0).
double projectile_error(const SolverAlgorithm& algorithm, int steps)
{
    Scene s(
        solver(algorithm) +
            "<component id=\"ball\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 1 1\" position=\"0 10 0\" linear_velocity=\"5 10 0\"/>"
            "<component id=\"g\" type=\"Field/Gravity\" between=\"*\" acceleration=\"0 -9.81 0\"/>",
        per_second(steps));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(2);
    return distance(s.vec("ball", "position"), {10, 10 + 20 - 0.5 * 9.81 * 4, 0});
}

struct BoxError
{
    double attitude = 0, energy = 0, momentum = 0;  ///< rad; relative
};

/// rad, at t = 100 s: 27 periods.
double late_error(const SolverAlgorithm& algorithm, int steps)
{
    Scene s(solver(algorithm) +
                "<component id=\"shape\" type=\"Shape/Box\" half_extents=\"0.1 0.2 0.3\"/>"
                "<component id=\"box\" type=\"State/RigidBody\" mass=\"1\" shape=\"shape\" angular_velocity=\"1 2 3\"/>",
            per_second(steps));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(100);
    CHECK(length(s.vec("box", "angular_velocity")) > 3.7);
    return attitude_error({-.25530488095953154536, -.51834919319232768729, -.09806435894574611863, -.81025731294426601932},
                          s.quat("box", "orientation"));
}

BoxError box_error(const SolverAlgorithm& algorithm, int steps)
{
    Scene s(solver(algorithm) +
                "<component id=\"shape\" type=\"Shape/Box\" half_extents=\"0.1 0.2 0.3\"/>"
                "<component id=\"box\" type=\"State/RigidBody\" mass=\"1\" shape=\"shape\" angular_velocity=\"1 2 3\"/>",
            per_second(steps));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const auto before = s.simulation().totals();
    s.run(5);
    const auto after = s.simulation().totals();
    const Quat expected{-0.36486374298686260041, 0.02356335734258868336, 0.02126200105200739735, -0.93051982491273477482};
    return {attitude_error(expected, s.quat("box", "orientation")), std::fabs(after.kinetic / before.kinetic - 1),
            distance(after.angular_momentum, before.angular_momentum) / length(before.angular_momentum)};
}

}  // namespace

TEST_CASE("A1: a projectile is exact for every algorithm but semi-implicit Euler, which is off by g dt T / 2")
{
    for (const SolverAlgorithm& algorithm : kExactForConstant)
        for (const int steps : {60, 960})
        {
            CAPTURE(algorithm.type);
            CHECK(projectile_error(algorithm, steps) < 1e-13 * 20);
        }
    for (const int steps : {60, 120, 960})
        CHECK(projectile_error({"SemiImplicitEuler"}, steps) == doctest::Approx(9.81 / steps).epsilon(1e-9));
}

TEST_CASE("A2: a free box with every algorithm, and the order of each")
{
    struct Row
    {
        SolverAlgorithm algorithm;
        double at_100, at_1000;  ///< rad, reached
        double order;            ///< 0: error control or rounding decides
        double energy;           ///< relative, at 1/100, reached
    };
    const Row table[] = {
        {{"SemiImplicitEuler"}, 0.62, 0.060, 1, 0.083},
        {{"StoermerVerlet"}, 8.9e-4, 8.3e-6, 2, 8.3e-6},
        {{"RungeKutta4"}, 4.2e-8, 4.1e-12, 4, 5.1e-10},
        {{"RotationSplitting", "order=\"2\""}, 4.3e-5, 4.3e-7, 2, 3.3e-6},
        {{"RotationSplitting"}, 8.2e-10, 1.4e-13, 4, 6.2e-11},
        {{"ImplicitMidpoint"}, 6.5e-4, 6.5e-6, 2, 5.5e-6},
        {{"Exact"}, 5e-15, 1e-13, 0, 2e-15},
        {{"Automatic"}, 5e-15, 1e-13, 0, 2e-15},
        {{"DormandPrince54"}, 4.4e-11, 1e-14, 0, 5.8e-12},
        {{"Radau5"}, 2.5e-11, 4.6e-12, 0, 3.1e-12},
        {{"Exponential"}, 4.8e-8, 4.7e-12, 4, 5.2e-10},
    };
    for (const Row& row : table)
    {
        CAPTURE(row.algorithm.type);
        CAPTURE(row.algorithm.attributes);
        const BoxError coarse = box_error(row.algorithm, 100), fine = box_error(row.algorithm, 1000);
        MESSAGE(row.algorithm.type << " " << row.algorithm.attributes << ": " << coarse.attitude << " " << fine.attitude << " energy "
                                   << coarse.energy << " momentum " << coarse.momentum);
        CHECK(coarse.attitude < 2 * row.at_100);
        CHECK(fine.attitude < 2 * row.at_1000);
        CHECK(coarse.energy < 2 * row.energy);
        CHECK(coarse.momentum == 0);
        if (row.order == 0) continue;
        CHECK(coarse.attitude > 0.5 * row.at_100);
        const double middle = box_error(row.algorithm, 200).attitude, third = box_error(row.algorithm, 400).attitude;
        CHECK(observed_order(coarse.attitude, middle) == doctest::Approx(row.order).epsilon(0.1));
        CHECK(observed_order(middle, third) == doctest::Approx(row.order).epsilon(0.05));
    }
}

TEST_CASE("A2: the same box after 100 s")
{
    const AlgorithmRow table[] = {
        {{"SemiImplicitEuler"}, 2000, 0.28, 0},
        {{"StoermerVerlet"}, 400, 1.6e-3, 2},
        {{"RotationSplitting", "order=\"2\""}, 100, 1.3e-3, 2},
        {{"ImplicitMidpoint"}, 400, 9.4e-4, 2},
        {{"RungeKutta4"}, 100, 1.4e-6, 4},
        {{"RotationSplitting"}, 50, 4.0e-7, 4},
        {{"Exponential"}, 20, 9.2e-4, 4},
        {{"DormandPrince54"}, 10, 8.4e-8, 0},
        {{"Radau5"}, 10, 1.1e-7, 0},
        {{"Exact"}, 10, 4.5e-13, 0},
    };
    for (const AlgorithmRow& row : table) check_algorithm(row, late_error);
    check_same({"Automatic"}, {"Exact"}, 10, late_error);
}
