// F7 for 1e6 steps, 10^4 s.
#include "reference/shafts.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("F7: a line of 1000 gears has no drift after 1e6 steps")
{
    const GearLine line(1000, "Graph");
    // One evaluation per step is sufficient: whether angles are derived does not depend on the solver
    // (shafts_algorithms_test.cpp).
    Scene s("<component id=\"solver\" type=\"Solver/SemiImplicitEuler\"/>" + line.parts, "dt=\"1/100\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    double worst = 0;
    for (int i = 0; i < 10; ++i)
    {
        s.step(100'000);
        worst = std::fmax(worst, GearLine::drift(s));
    }
    CHECK(worst == 0);
    const double phase = line.phase(s), turns = s.angle(GearLine::id(0)) / 6.283185307179586;
    MESSAGE("turns " << turns << ", angles to " << phase);
    CHECK(phase < 1e-12);
}
