#include "control/topics/spread.h"

#include <doctest/doctest.h>

using plab::cli::Spread;

TEST_CASE("the spread of a few numbers")
{
    Spread s;
    CHECK(s.deviation() == 0);
    for (const double x : {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}) s.add(1e9 + x);
    CHECK(s.count() == 8);
    CHECK(s.mean() == doctest::Approx(1e9 + 5).epsilon(1e-15));
    CHECK(s.least() == 1e9 + 2);
    CHECK(s.most() == 1e9 + 9);
    CHECK(s.deviation() == doctest::Approx(2.13808993529939).epsilon(1e-6));  // sqrt(32 / 7)
}
