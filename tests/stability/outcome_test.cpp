// What counts as the same outcome: rounding does, a change of the code that matters does not.
#include <doctest/doctest.h>

#include <string>

#include "stability/outcome.h"

using namespace plab::stability;

namespace
{

bool same(const std::string& expected, const std::string& measured)
{
    const auto a = from_line(expected), b = from_line(measured);
    REQUIRE(a);
    REQUIRE(b);
    CHECK(agree(*a, *b) == agree(*b, *a));
    return agree(*a, *b);
}

}  // namespace

TEST_CASE("lines of the table and back")
{
    for (const char* line :
         {"stable 7.4e-06", "degraded 1.4e-07 solver.failed, slow: 71 % of the time", "degraded 4.0e-15 slow: 61 % of the time",
          "refused 0.0e+00 g1: drives b, whose motion is prescribed; it must be dynamic", "diverged 2.6e+06 contact.missed, contact.stiff"})
        CHECK(to_line(*from_line(line)) == line);
    const auto slow = from_line("degraded 1.4e-07 solver.failed, slow: 71 % of the time");
    CHECK(slow->how == "solver.failed");
    CHECK(slow->reached == 71);
    CHECK_FALSE(from_line("degraded 1.4e-07 solver.failed")->reached.has_value());
}

TEST_CASE("how far a slow cell came: rounding may change it, half the pace may not")
{
    const std::string at71 = "degraded 1.4e-07 solver.failed, slow: 71 % of the time";
    CHECK(same(at71, "degraded 1.8e-07 solver.failed, slow: 66 % of the time"));
    CHECK(same(at71, "degraded 1.8e-07 solver.failed, slow: 84 % of the time"));
    CHECK_FALSE(same(at71, "degraded 1.4e-07 solver.failed, slow: 45 % of the time"));
    CHECK_FALSE(same(at71, "degraded 1.4e-07 solver.failed"));                          // it finishes now
    CHECK_FALSE(same(at71, "degraded 1.4e-07 slow: 71 % of the time"));                 // the solver does not fail now
    CHECK_FALSE(same(at71, "degraded 1.8e-06 solver.failed, slow: 71 % of the time"));  // a digit less
    CHECK_FALSE(same(at71, "stable 1.4e-07"));
    CHECK(same("degraded 2.5e-14 slow: 0 % of the time", "degraded 2.5e-14 slow: 1 % of the time"));
    CHECK(same("degraded 1.5e-11 slow: 22 % of the time", "degraded 1.4e-11 slow: 21 % of the time"));
    CHECK_FALSE(same("degraded 1.5e-11 slow: 22 % of the time", "degraded 1.5e-11 slow: 11 % of the time"));
    CHECK_FALSE(same("degraded 1.5e-11 slow: 2 % of the time", "degraded 1.5e-11 slow: 4 % of the time"));
}

TEST_CASE("figures: a factor of ten, and rounding below 1e-11")
{
    CHECK(same("stable 0.0e+00", "stable 1.0e-13"));
    CHECK_FALSE(same("stable 0.0e+00", "stable 6.0e-08"));
    CHECK(same("stable 2.0e-08", "stable 9.0e-08"));
    CHECK_FALSE(same("stable 2.0e-08", "stable 9.0e-07"));
    CHECK_FALSE(same("degraded 1.6e+00 constraint.contradiction", "diverged 2.1e+01 constraint.contradiction"));
}
