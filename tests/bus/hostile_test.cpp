#include <doctest/doctest.h>

#include "hostile_attack.h"

TEST_CASE("some thousand changed packets of discovery do not touch the run") { plab::test::attack(5000, 1, 200); }
