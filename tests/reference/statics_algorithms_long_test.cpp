// Stacks with every contact algorithm (contact_algorithms.h): D2 of the catalogue. For Direct up to 100 cubes see
// statics_test.cpp.
#include "statics_problems.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("D2: three and ten cubes for two seconds, with every algorithm")
{
    // Loads and displacement of the top for three; the same for ten (loads as means over the last second), and whether it is
    // reported.
    constexpr Bound<5> table[] = {
        {"None", "Impulse", {8e-6, 0.019, 1.01, 9, 2}, {0, 4e-3, 0.9, 1, 1}},
        {"halved", "Impulse", {1e-12, 4e-9, 0.01, 4.5e-3, 0}, {0, 0, 5e-4, 2e-4, 0}},
        {"located", "Impulse", {1e-12, 4e-9, 0.09, 4.5e-3, 0}, {0, 0, 5e-3, 2e-4, 0}},
        {"*", "Rows/Direct", {2.5e-12, 1.1e-13, 1.2e-12, 4.5e-13, 0}},
        {"None", "Rows/SequentialImpulse", {8e-7, 1.2e-4, 0.06, 0.045, 1}, {0, 1e-5, 0, 4e-3, 1}},
        {"Speculative", "Rows/SequentialImpulse", {8e-7, 1.2e-4, 0.14, 0.1, 1}, {0, 1e-5, 0.015, 0.01, 1}},
        {"*", "Rows/SoftStep", {3e-11, 1e-3, 0.04, 0.012, 1}, {0, 1e-4, 4e-3, 1e-3, 1}},
    };
    check_algorithms(rigid_algorithms(), table,
                     [](const Algorithm& algorithm)
                     {
                         const Stood three = stand(algorithm, std::vector<double>(3, 1.0), 120),
                                     ten = stand(algorithm, std::vector<double>(10, 1.0), 120, 60);
                         return std::array{three.load, three.sunk, ten.load, ten.sunk, ten.reported};
                     });
}
