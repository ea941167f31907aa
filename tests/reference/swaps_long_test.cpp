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
    Scene s(gravity("4.905 0 -8.495709211125344") + solid("a", "Box' half_extents='0.2 0.2 0.1'", 1, {0, 0, 0.1}) +
                ground_and_contact("None", "Penalty",
                                   "response.stiffness='2e3' response.damping_ratio='1' response.tangential_damping_ratio='1' "
                                   "response.friction='0.6' response.steps_per_contact='20'"),
            dt(60));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = true;
    s.run(5);
    const Vec3 settled = s.vec("a", "position");
    s.run(3605);
    CHECK(distance(s.vec("a", "position"), settled) <= 1e-9);
    CHECK(attitude_error(s.quat("a", "orientation"), {}) <= 1e-2);  // it leans into its springs, and no further
}
