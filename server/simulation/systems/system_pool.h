/// A cache of configured group systems by their members: if the same set of groups is advanced again, its system is ready.
#pragma once

#include <memory>
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

    struct Entry
    {
        std::vector<std::uint32_t> groups, observed;
        std::unique_ptr<GroupSystem> system;
    };
    std::unordered_multimap<std::uint64_t, Entry> entries_;
    StageScratch scratch_;
};

}  // namespace plab::simulation
