// Bodies at rest, with every contact algorithm (contact_algorithms.h): D6, D7 of the catalogue. D1:
// statics_heavy_algorithms_test.cpp; D2: statics_algorithms_long_test.cpp; Direct alone up to its limits: statics_test.cpp. The
// solver does not matter: bodies at rest are advanced by the managers and the host.
#include "statics_problems.h"

using namespace plab;
using namespace plab::test;

// Equilibrium gives three equations for four feet; the distribution (+ - - +) remains undetermined. Of all distributions Direct
// takes the one with the least sum of squares: f_i = W / 4 (1 + x x_i / a^2 + y y_i / b^2), where (x, y) is the point of action of
// the resultant. Without an initial guess it does so to rounding; later steps solve again when rounding has moved the table, and
// the distribution drifts with them.
TEST_CASE("D6: a table with four feet: the sum, the moments and the distribution, with every algorithm")
{
    // Relative: the distribution after one step, and after 300; sum and moments.
    constexpr Bound<3> table[] = {
        // The impulses of its points in one step are not the load.
        {"None", "Impulse", {2, 2.4, 0.53}, {0.1, 0.1, 0.02}},
        {"located", "Impulse", {1.27, 1.27, 3e-14}, {0.1, 0.1, 0}},
        {"halved", "Rows/Direct", {1e-14, 4e-7, 4e-13}},
        {"*", "Rows/Direct", {1e-14, 4e-7, 8e-13}},
        {"*", "Rows/SequentialImpulse", {1.28, 1.28, 4.5e-6}, {0.1, 0.1, 0}},
        {"*", "Rows/SoftStep", {1.1, 3e-4, 4e-5}, {0.05, 0, 0}},
    };
    check_algorithms(rigid_algorithms(), table,
                     [](const Algorithm& algorithm)
                     {
                         Scene s(FourFeet::scene(algorithm), "dt=\"1/60\"");
                         REQUIRE_MESSAGE(s.loaded(), s.error());
                         s.step();
                         const double first = FourFeet::off_least(point_forces(s, "ground", "table"));
                         s.step(299);
                         const auto f = point_forces(s, "ground", "table");
                         return std::array{first, FourFeet::off_least(f), FourFeet::off_balance(f)};
                     });
}

TEST_CASE("D7: a ladder slips iff tan theta < 1 / (2 mu), to 1e-4 rad on either side, with every algorithm")
{
    // m: displacement in a second above the limit; below it: relative to the expected slip.
    // The linearised law of sliding neglects 1.5 %.
    constexpr Bound<2> table[] = {
        {"None", "Impulse", {4.7e-4, 2.1}, {5e-5, 0.2}},
        {"located", "Impulse", {7e-15, 0.0305}},
        {"*", "Rows/Direct", {2.3e-14, 0.0305}},
        {"*", "Rows/SequentialImpulse", {1.4e-7, 0.0306}},
        {"*", "Rows/SoftStep", {8.2e-3, 4.4}, {1e-3, 0.5}},
    };
    check_algorithms(rigid_algorithms(), table,
                     [](const Algorithm& algorithm)
                     {
                         std::array<double, 2> moved{};
                         for (const double off : {1e-4, -1e-4})
                         {
                             Scene s(Ladder::scene(algorithm, Ladder::limit() + off), "dt=\"1/240\"");
                             REQUIRE_MESSAGE(s.loaded(), s.error());
                             s.warnings_expected = true;
                             const Vec3 before = s.vec("ladder", "position");
                             s.run(1);
                             moved[off > 0 ? 0 : 1] = distance(s.vec("ladder", "position"), before);
                         }
                         moved[1] = std::fabs(moved[1] / Ladder::slides(1e-4, 1) - 1);
                         return moved;
                     });
}
