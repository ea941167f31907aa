/// Group systems that were set up before, by who is in them: a scope that comes back finds its system ready.
#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "simulation/systems/group_system.h"

namespace plab::simulation
{

/// Lookup only: nothing is ever listed in the order of the map.
class SystemPool
{
public:
    /// After any structural change: nothing that was set up holds any more.
    void clear(const world::World& world);
    /// The system of these groups and shadows (see GroupSystem::configure), ready for the present frame.
    GroupSystem& of(const StepFrame& frame, std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed);
    StageScratch& scratch() { return scratch_; }

private:
    /// Scopes come and go with contacts; beyond this many the oldest half of memory is not worth keeping.
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
