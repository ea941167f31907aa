/// The pairs of islands that sleep, which ContactCache::pairs() does not contain.
#pragma once

#include <vector>

#include "simulation/contacts/contacts.h"

namespace plab::simulation
{

/// An island that sleeps: bodies at rest, and the pairs that hold them together and to what does not move.
struct SleepingIsland
{
    std::vector<std::uint32_t> bodies;  ///< host rows, by rank
    std::vector<PairState> pairs;       ///< in the order of ContactCache::pairs()
    std::uint32_t points = 0;           ///< contact points of all pairs
};

void ContactCache::each_pair(const auto& job) const
{
    for (const PairState& p : pairs_) job(p);
    for (const auto& island : rest_.islands)
        for (const PairState& p : island->pairs) job(p);
}

}  // namespace plab::simulation
