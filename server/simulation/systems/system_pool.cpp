#include "simulation/systems/system_pool.h"

#include <algorithm>

namespace plab::simulation
{
namespace
{

std::uint64_t hash_of(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed)
{
    std::uint64_t h = 0xcbf29ce484222325ull;
    for (const auto list : {groups, observed})
    {
        for (const std::uint32_t g : list) h = (h ^ g) * 0x100000001b3ull;
        h = (h ^ 0xffffffffull) * 0x100000001b3ull;
    }
    return h;
}

}  // namespace

void SystemPool::clear(const world::World& world)
{
    entries_.clear();
    scratch_.fit(world);
}

GroupSystem& SystemPool::of(const StepFrame& frame, std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed)
{
    const std::uint64_t key = hash_of(groups, observed);
    const auto [begin, end] = entries_.equal_range(key);
    for (auto it = begin; it != end; ++it)
        if (std::ranges::equal(it->second.groups, groups) && std::ranges::equal(it->second.observed, observed))
        {
            it->second.system->set_frame(frame);
            return *it->second.system;
        }
    // A caller holds at most one system at a time and requests it again before each advance, so clearing is safe here.
    if (entries_.size() >= std::max(kMost, 2 * frame.groups->all.size())) entries_.clear();
    Entry fresh{{groups.begin(), groups.end()}, {observed.begin(), observed.end()}, std::make_unique<GroupSystem>(scratch_)};
    fresh.system->configure(frame, groups, observed);
    return *entries_.emplace(key, std::move(fresh))->second.system;
}

}  // namespace plab::simulation
