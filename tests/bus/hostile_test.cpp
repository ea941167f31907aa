#include <doctest/doctest.h>

#include "hostile_attack.h"

TEST_CASE("some thousand changed discovery packets do not affect the run") { plab::test::attack(5000, 1, 200); }
