/// A cache of configured group systems by their members: if the same set of groups is advanced again, its system is ready. What it keeps
/// is bounded by a multiple of the number of groups: the island of a heap has other members in each step, so its system, which is large,
/// takes the place of an earlier one.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "simulation/systems/group_system.h"

namespace plab::simulation
{

/// Used for lookup only; nothing iterates in the order of the map.
class SystemPool
{
public:
    /// To be called after any structural change: it invalidates all configured systems.
    void clear(const world::World& world);
    /// The system of these groups and observed groups (see GroupSystem::configure), ready for the present frame.
    GroupSystem& of(const StepFrame& frame, std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed);
    StageScratch& scratch() { return scratch_; }

private:
    /// Sets of groups change with contacts; beyond this number, or twice as many as there are groups, the cache is cleared. So each group
    /// of a large scene may have a system of its own: one impact each rewinds them one by one.
    static constexpr std::size_t kMost = 4096;
    /// The same for the members of all cached sets together, as a multiple of the number of groups.
    static constexpr std::size_t kMostMembers = 4;
    /// A set is large if it has this many groups and this share of all groups. Few of these are kept, in a list of their own.
    static constexpr std::size_t kLargeSet = 256, kLargeShare = 8, kMostLarge = 16;

    struct Entry
    {
        std::vector<std::uint32_t> groups, observed;
        std::unique_ptr<GroupSystem> system;
        std::uint64_t key = 0;
        Tick used = 0;  ///< the step in which it was last asked for

        bool is_of(std::span<const std::uint32_t> of_groups, std::span<const std::uint32_t> of_observed) const
        {
            return std::ranges::equal(groups, of_groups) && std::ranges::equal(observed, of_observed);
        }
    };
    GroupSystem& large_of(const StepFrame& frame, std::uint64_t key, std::span<const std::uint32_t> groups,
                          std::span<const std::uint32_t> observed);

    std::unordered_multimap<std::uint64_t, Entry> entries_;
    std::size_t members_ = 0;  ///< groups of all entries_, counted as often as they occur
    std::vector<Entry> large_;
    StageScratch scratch_;
};

}  // namespace plab::simulation
