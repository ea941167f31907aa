// A thousand bodies that tumble onto a plane, with every algorithm that answers contacts at the ends of steps: none gains
// energy.
// energy.
#include "drops.h"

using namespace plab::test;

TEST_CASE("a thousand random drops gain no energy") { check_drops(12, 1000); }
