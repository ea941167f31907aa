#include <doctest/doctest.h>

#include "hostile_attack.h"

TEST_CASE("a hundred thousand changed packets of discovery do not touch the run") { plab::test::attack(100000, 2, 400); }
