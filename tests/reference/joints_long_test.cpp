// Linkages over many steps (catalogue: E2, E3).
#include "support/linkages.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("E2: forty four-bars")
{
    Scene s(four_bars(40), dt(1000));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(10);
    MESSAGE("N=40 t=10: ", top_of(s).x - .18051222668672839, " ", top_of(s).z - .983572740582311575);
    CHECK(distance(top_of(s), {.18051222668672839, 0, .983572740582311575}) < 1e-8);
    s.run(20);
    // A step that begins 8e-6 rad from the singular configuration (at t = 18.41 s) cannot determine all its accelerations: 5e-8
    // m.
    MESSAGE("N=40 t=20: ", distance(top_of(s), {.410901153762945222, 0, .911679900971980652}));
    CHECK(distance(top_of(s), {.410901153762945222, 0, .911679900971980652}) < 1e-7);
}

TEST_CASE("E2: no jump to another branch in 10^4 turns, singular twice in each")
{
    Scene s(four_bars(2), dt(100));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    double turns = 0, worst = 0;
    for (long i = 0; turns < 1e4 && i < 3000000; ++i)
    {
        s.step();
        if (i % 64 != 0) continue;
        turns = std::fabs(s.real("f100", "angle")) / 6.283185307179586;
        // On the correct branch the uprights stay parallel, and the bars between them level.
        worst = std::fmax(worst, distance(s.vec("v101", "position") - s.vec("v100", "position"), {1, 0, 0}));
        REQUIRE(worst < 1e-3);
    }
    MESSAGE("turns ", turns, ", uprights parallel to ", worst);
    CHECK(turns >= 1e4);
    CHECK(worst < 1e-6);
}

TEST_CASE("E3: the energy of Bricard's linkage")
{
    const BricardRun run = run_bricard(20000, 10);
    MESSAGE("drift of energy ", run.drift, " of ", run.kinetic, " J");
    CHECK(run.drift < 1e-9 * run.kinetic);
}
