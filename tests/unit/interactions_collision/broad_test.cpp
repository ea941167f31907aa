// The broad phase against a search by brute force: every pair of boxes that overlaps, whatever the kind of search, also
// after some, many or all have moved. Equal boxes in piles are where ODE's hash space lost pairs.
#include "broad_scenes.h"

using namespace plab::test;

TEST_CASE("a hundred random scenes: every kind of search finds what brute force finds") { compare_scenes(100, 1000); }

TEST_CASE("among a thousand piled cubes, and five thousand, the default search loses no pair")
{
    const char* const tree[] = {"tree"};
    compare(Crowd::pile(3, 1000), tree);
    compare(Crowd::pile(5, 5000), tree);
}
