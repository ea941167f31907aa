// The broad phase against a search by brute force, in many and large scenes.
#include "broad_scenes.h"

using namespace plab::test;

TEST_CASE("a thousand random scenes of 10 to 5000 boxes") { compare_scenes(1000, 5000); }
