// H8 at length, and an hour of stiction.
#include "swaps_storm.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("H8: twenty thousand random swaps")
{
    const StormResult one = storm(20000, 7);
    MESSAGE("refused ", one.refused, ", ledger ", one.worst_ledger, " J, highest ", one.highest, " m, gears ", one.gear_error,
            " rad/s, chain ", one.chain_error, " m, sunk ", one.sunk, " m");
    // Reached: 31 mm, a random walk of the depth at which springs take over from one another while the stack moves. Nothing but a hard
    // response that lasts takes it out.
    check_result(one, 0.05);
}

TEST_CASE("stiction remembers: a block on a slope of 30 degrees does not creep in an hour")
{
    Scene s = block_on_a_slope();
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = true;
    s.run(5);
    const Vec3 settled = s.vec("a", "position");
    s.run(3605);
    CHECK(distance(s.vec("a", "position"), settled) <= 1e-9);
    CHECK(attitude_error(s.quat("a", "orientation"), {}) <= 1e-2);  // it leans into its springs, and no further
}
