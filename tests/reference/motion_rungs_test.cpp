// A1 and A2 by every rung of the ladder of solvers. References: closed forms; A2 by Jacobi's elliptic functions in 30 digits, checked
// against an extrapolation method in 113-bit arithmetic.
//
// A1 projectile, 2 s            Semi-implicit Euler g dt T / 2, all others 1e-13 relative, at 1/60 and 1/960
// A2 free box, attitude at 5 s  at 1/100 and 1/1000, and the observed order between 1/100 and 1/400: the table below. Aims: 1e-7 at
//                               1/100 and 1e-11 at 1/1000, which RungeKutta4 and what is better reach; momentum to the last bit by all
#include "reference/motion.h"

using namespace plab;
using namespace plab::test;

namespace
{

const SolverRung kExactForConstant[] = {{"StoermerVerlet"},    {"RungeKutta4"},      {"RotationSplitting", "order=\"2\""},
                                        {"RotationSplitting"}, {"ImplicitMidpoint"}, {"Exact"},
                                        {"Automatic"},         {"DormandPrince54"},  {"Radau5"},
                                        {"Exponential"}};

/// m, after 2 s of flight from (0, 10, 0) with (5, 10, 0).
double projectile_error(const SolverRung& rung, int steps)
{
    Scene s(
        solver(rung) +
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

BoxError box_error(const SolverRung& rung, int steps)
{
    Scene s(solver(rung) +
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

TEST_CASE("A1: a projectile is exact for every rung but semi-implicit Euler, which is off by g dt T / 2")
{
    for (const SolverRung& rung : kExactForConstant)
        for (const int steps : {60, 960})
        {
            CAPTURE(rung.type);
            CHECK(projectile_error(rung, steps) < 1e-13 * 20);
        }
    for (const int steps : {60, 120, 960})
        CHECK(projectile_error({"SemiImplicitEuler"}, steps) == doctest::Approx(9.81 / steps).epsilon(1e-9));
}

TEST_CASE("A2: a free box by every rung, with its order")
{
    struct Row
    {
        SolverRung rung;
        double at_100, at_1000;   ///< rad
        double order;             ///< 0: error control or rounding decides
        double energy, momentum;  ///< relative, at 1/100
    };
    const Row table[] = {
        {{"SemiImplicitEuler"}, 1, 0.1, 1, 0.1, 0},
        {{"StoermerVerlet"}, 2e-3, 2e-5, 2, 2e-5, 0},
        {{"RungeKutta4"}, 1e-7, 1e-11, 4, 1e-9, 0},
        {{"RotationSplitting", "order=\"2\""}, 1e-4, 1e-6, 2, 1e-5, 0},
        {{"RotationSplitting"}, 2e-9, 1e-12, 4, 2e-10, 0},
        {{"ImplicitMidpoint"}, 1e-3, 1e-5, 2, 1e-5, 0},
        {{"Exact"}, 1e-13, 1e-12, 0, 1e-14, 0},
        {{"Automatic"}, 1e-13, 1e-12, 0, 1e-14, 0},
        {{"DormandPrince54"}, 1e-10, 1e-13, 0, 1e-10, 0},
        {{"Radau5"}, 1e-10, 1e-10, 0, 1e-10, 0},
        {{"Exponential"}, 1e-7, 1e-11, 4, 1e-9, 0},
    };
    for (const Row& row : table)
    {
        CAPTURE(row.rung.type);
        CAPTURE(row.rung.attributes);
        const BoxError coarse = box_error(row.rung, 100), fine = box_error(row.rung, 1000);
        MESSAGE(row.rung.type << " " << row.rung.attributes << ": " << coarse.attitude << " " << fine.attitude << " energy "
                              << coarse.energy << " momentum " << coarse.momentum);
        CHECK(coarse.attitude < row.at_100);
        CHECK(fine.attitude < row.at_1000);
        CHECK(coarse.energy < row.energy);
        CHECK(coarse.momentum <= row.momentum);
        if (row.order == 0) continue;
        const double middle = box_error(row.rung, 200).attitude, third = box_error(row.rung, 400).attitude;
        CHECK(observed_order(coarse.attitude, middle) == doctest::Approx(row.order).epsilon(0.1));
        CHECK(observed_order(middle, third) == doctest::Approx(row.order).epsilon(0.05));
    }
}
