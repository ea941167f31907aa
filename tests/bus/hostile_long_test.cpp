#include <doctest/doctest.h>

#include "hostile_attack.h"

TEST_CASE("a hundred thousand changed discovery packets do not affect the run") { plab::test::attack(100000, 2, 400); }
