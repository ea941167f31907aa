// The time at which a series of bounces ends.
#include <doctest/doctest.h>

#include <cmath>

#include "simulation/events/zeno.h"

using namespace plab;
using namespace plab::simulation;

TEST_CASE("a geometric sequence of intervals ends at its sum")
{
    for (const double e : {0.1, 0.5, 0.9, 0.99, 0.999})
    {
        CAPTURE(e);
        BounceHistory h;
        double time = 3, interval = 1e-3;
        for (int i = 0; i < 3; ++i) note_impact(h, time), time += interval, interval *= e;
        const auto rest = rest_of_bounces(h, interval / e, e);
        REQUIRE(rest);
        CHECK(std::fabs(*rest - interval / e / (1 - e)) < 1e-15);
    }
}

TEST_CASE("intervals that do not shrink by the ratio are not such a sequence")
{
    BounceHistory h;
    CHECK(!rest_of_bounces(h, 1e-3, 0.5));
    for (const double t : {1.0, 1.1, 1.15}) note_impact(h, t);
    CHECK(rest_of_bounces(h, 0.025, 0.5));
    CHECK(!rest_of_bounces(h, 0.025, 0.6));
    CHECK(!rest_of_bounces(h, 0.04, 0.5));
    CHECK(!rest_of_bounces(h, 0.025, 1));
    note_impact(h, 1.3);  // the body was pushed in between
    CHECK(!rest_of_bounces(h, 0.025, 0.5));
}
