// Statics with Response/Rows and Manager/Direct: the loads on contacts in closed form. D1, D2 as in the catalogue; for the other
// algorithms and problems see statics_algorithms_test.cpp.
#include <algorithm>

#include "statics_problems.h"

using namespace plab;
using namespace plab::test;

namespace
{

struct Loads
{
    double first = 0;          ///< largest relative error of the load on a face, in the first step
    double worst = 0;          ///< the same, of each step
    double moved = 0;          ///< m, the top
    std::size_t reported = 0;  ///< events that contacts did not converge
};

/// Direct must be accurate in every step.
Loads loads_of(const std::vector<double>& masses, std::int64_t steps)
{
    Scene s(stack(masses, {"None", "Rows"}), "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    Loads out;
    for (std::int64_t i = 0; i < steps; ++i)
    {
        s.step();
        out.worst = std::max(out.worst, worst_load(s, masses));
        if (i == 0) out.first = out.worst;
    }
    out.reported = s.count("manager.not_converged");
    const std::size_t top = masses.size() - 1;
    out.moved = distance(s.vec(name_of_box(top), "position"), {0, 0, static_cast<double>(top) + 0.5});
    return out;
}

}  // namespace

TEST_CASE("D1: r kg on 1 kg, r = 1 to 1e8: reactions (1 + r) m g and r m g to rounding in one solve of Direct, and nothing moves in 600")
{
    for (const double r : {1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8})
    {
        CAPTURE(r);
        const Loads loads = loads_of({1, r}, 600);
        CHECK(loads.first < 1e-15);
        // Two impulses of r g h leave an error of r g h eps in the light body's speed, and r g h^2 eps in its position: the heavy
        // one follows, with r eps of its own load. In addition there is the tolerance, some 1e-13 m/s of g h = 0.16 m/s. Reached:
        // 2.3e-12, and 4.1e-16 r.
        CHECK(loads.worst < 4e-12 + 6e-16 * r);
        CHECK(loads.moved < 5e-13 + 1e-17 * r);
        CHECK(loads.reported == 0);
    }
}

TEST_CASE("D2: n cubes: (n - k + 1) m g between them to 6e-12 with Direct, and twice that in later steps")
{
    // Newton's method ends within 1e-12 m/s of the law: of the load of one cube, g dt, that is a fraction of 6.1e-12. Reached
    // 2.6e-14 at first, and 8.4e-12 in one of 30 steps (50 cubes). Positions are rounded to 1.4e-14 m at the top.
    constexpr double kTolerance = 1e-12 / (kG / 60);
    for (const std::size_t n : {10u, 20u, 50u, 100u})
    {
        CAPTURE(n);
        const Loads loads = loads_of(std::vector<double>(n, 1.0), 30);
        CHECK(loads.first < kTolerance);
        CHECK(loads.worst < 2 * kTolerance);
        CHECK(loads.moved < 1.5e-13);
    }
}
