// H8 with more swaps, and stiction over one hour.
#include "swaps_storm.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("H8: twenty thousand random swaps")
{
    const StormResult one = storm(20000, 7);
    MESSAGE("refused ", one.refused, ", ledger ", one.worst_ledger, " J, with springs ", one.worst_springs, " J, of order 1 ",
            one.worst_kicks, " of its kicks, highest ", one.highest, " m, gears ", one.gear_error, " rad/s, chain ", one.chain_error,
            " m, sunk ", one.sunk, " m");
    check_result(one, 5e-3);
}

TEST_CASE("stiction has a memory: a block on a slope of 30 degrees does not creep in an hour")
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
