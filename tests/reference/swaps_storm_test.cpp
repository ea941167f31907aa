// H8: a storm of seeded swaps; the long test makes twenty thousand.
#include "swaps_storm.h"

using namespace plab::test;

TEST_CASE("H8: random swaps: nothing is lost, no body gains height, the ledger closes, and the number of threads has no effect")
{
    const StormResult one = storm(300, 2026), two = storm(300, 2026, 2);
    check_result(one, 5e-3);
    CHECK(one.hash == two.hash);
}
