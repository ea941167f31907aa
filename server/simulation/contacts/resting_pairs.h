/// Which persistent pairs a group takes part in. An impact rewinds and solves the groups that it touches and whatever rests on them; with
/// this index it finds their pairs without going through all pairs of the scene. Kinematic bodies take part in none: nothing that touches
/// them reaches others through them.
#pragma once

#include <span>
#include <vector>

#include "simulation/contacts/contacts.h"

namespace plab::simulation
{

class RestingPairs
{
public:
    /// `visited`: counts the pairs that are visited.
    RestingPairs(const world::World& world, const Groups& groups, const ContactCache& cache, std::uint64_t& visited)
        : world_(world), groups_(groups), cache_(cache), visited_(visited)
    {
    }

    /// To be called at the start of a step, and whenever pairs have become persistent otherwise than by add(). The index is made again when
    /// it is needed. Pairs that end need no notice.
    void forget() { ready_ = false; }
    /// A pair has come to rest.
    void add(const PairState& pair);
    /// Sets `places` to the places in ContactCache::pairs(), ascending, of all persistent pairs with a member in `groups`.
    void find(std::span<const std::uint32_t> groups, std::vector<std::uint32_t>& places);
    /// Adds to `groups` all groups that rest on one of its members, directly or through others, and sets `places` to the places of all
    /// persistent pairs with a member in the result, ascending.
    void close_over(IndexSet& groups, std::vector<std::uint32_t>& places);

private:
    /// A pair in the list of one of its groups. `place`: where it was in the cache; pairs that are added since then have moved it.
    struct Node
    {
        std::uint32_t detector = kNoIndex;
        Ref a, b;
        std::size_t place = 0;
        std::uint32_t next = kNoIndex;
    };
    void build();
    /// kNoIndex: static or kinematic.
    std::uint32_t moving_group_of(Ref body) const;
    void put(const PairState& pair, std::size_t place);
    bool close_in_passes(IndexSet& groups, std::vector<std::uint32_t>& places);
    /// Calls found(pair, place) for each persistent pair of a group.
    template <class Found>
    void each_of(std::uint32_t group, Found&& found);
    bool is_most_of_all(std::span<const std::uint32_t> groups) const { return 4 * groups.size() > groups_.all.size(); }

    const world::World& world_;
    const Groups& groups_;
    const ContactCache& cache_;
    std::uint64_t& visited_;
    std::vector<std::uint32_t> first_;  ///< by group: index of its first node
    std::vector<Node> nodes_;
    IndexSet wanted_;  ///< scratch
    bool ready_ = false;
};

}  // namespace plab::simulation
