// Heavy on light, with every contact algorithm (contact_algorithms.h): D1 of the catalogue. For Direct up to 1e8 : 1 see
// statics_test.cpp.
#include "statics_problems.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("D1: 1 kg on 1 kg, 10 kg on 1 kg, 1000 kg on 1 kg, for a second, with every algorithm")
{
    // Loads and displacement of the top for 1:1; the same for 10:1; displacement of the top for 1000:1, and whether it is
    // reported.
    constexpr Bound<6> table[] = {
        {"None", "Impulse", {2e-11, 2.7e-3, 1.01, 0.17, 0.9, 9}, {0, 5e-4, 0.9, 0.02, 0.1, 1}},
        {"halved", "Impulse", {1.6e-12, 2e-13, 2.4e-6, 5e-7, 0.16, 0}, {0, 0, 0, 0, 0.01, 0}},
        {"certified", "Impulse", {2e-12, 2e-13, 1e-6, 1.1e-6, 0.2, 0}, {0, 0, 0, 0, 0.02, 0}},
        {"halved", "Rows/Direct", {1e-12, 1.7e-14, 1e-12, 8e-15, 3e-14, 0}},
        {"*", "Rows/Direct", {1.3e-12, 7e-14, 1.3e-12, 7e-14, 3e-14, 0}},
        {"None", "Rows/SequentialImpulse", {4.5e-6, 1.5e-5, 0.02, 9e-4, 2, 9}, {0, 0, 0, 0, 0.5, 1}},
        {"Speculative", "Rows/SequentialImpulse", {4.5e-6, 1.5e-5, 9e-4, 1.1e-4, 2, 12}, {0, 0, 0, 0, 0.5, 1}},
        {"*", "Rows/SoftStep", {2.5e-8, 3.6e-4, 8.5e-6, 2e-3, 2.5, 6}, {0, 0, 0, 0, 0.5, 1}},
    };
    check_algorithms(
        rigid_algorithms(), table,
        [](const Algorithm& algorithm)
        {
            const Stood equal = stand(algorithm, {1, 1}, 60), ten = stand(algorithm, {1, 10}, 60), heavy = stand(algorithm, {1, 1000}, 60);
            return std::array{equal.load, equal.sunk, ten.load, ten.sunk, heavy.sunk, heavy.reported};
        });
}
