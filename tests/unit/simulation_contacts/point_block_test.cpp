// Blocks of contact points grow by powers of two, keep what is in them, and come back from the pool.
#include "simulation/contacts/point_block.h"

#include <doctest/doctest.h>

#include <utility>

#include "simulation/contacts/contacts.h"

using namespace plab;
using namespace plab::simulation;

TEST_CASE("a block has room for 1, 2, 4, 8 or 16 points and keeps those in use as it grows")
{
    PointBlock block;
    CHECK(block.capacity() == 0);
    const std::uint32_t room[] = {1, 2, 4, 4, 8, 8, 8, 8, 16};
    for (std::uint32_t n = 0; n < 9; ++n)
    {
        block.reserve(n + 1, n);
        CHECK(block.capacity() == room[n]);
        block[n].feature = 10 + n;
        for (std::uint32_t k = 0; k <= n; ++k) CHECK(block[k].feature == 10 + k);
    }
    block.reserve(3, 9);
    CHECK(block.capacity() == 16);
}

TEST_CASE("a pool gives back the block that it took, also where less room is needed")
{
    PointPool pool;
    PointBlock first, second;
    pool.reserve(first, 7, 0);
    const KnownContact* const where = first.begin();
    pool.recycle(first);
    CHECK(first.capacity() == 0);
    pool.reserve(second, 1, 0);
    CHECK(second.begin() == where);
    CHECK(second.capacity() == 8);
}

TEST_CASE("a block that outgrows its room leaves it in the pool")
{
    PointPool pool;
    PointBlock grows, next;
    pool.reserve(grows, 1, 0);
    grows[0].id = 7;
    const KnownContact* const where = grows.begin();
    pool.reserve(grows, 2, 1);
    CHECK(grows[0].id == 7);
    pool.reserve(next, 1, 0);
    CHECK(next.begin() == where);
}

TEST_CASE("a copy of a pair has points of its own, and assignment needs no more room than before")
{
    PairState pair;
    for (std::uint32_t k = 0; k < 3; ++k) pair.add().feature = k;
    PairState copy = pair;
    copy.contacts[1].feature = 9;
    CHECK(pair.contacts[1].feature == 1);
    CHECK(copy.all().size() == 3);
    const KnownContact* const where = copy.contacts.begin();
    copy = pair;
    CHECK(copy.contacts.begin() == where);
    CHECK(copy.contacts[1].feature == 1);
}
