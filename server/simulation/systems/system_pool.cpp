#include "simulation/systems/system_pool.h"

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
    entries_.clear(), large_.clear();
    members_ = 0;
    scratch_.fit(world);
}

GroupSystem& SystemPool::of(const StepFrame& frame, std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed)
{
    const std::uint64_t key = hash_of(groups, observed);
    const std::size_t members = groups.size() + observed.size();
    if (members >= kLargeSet && kLargeShare * members >= frame.groups->all.size()) return large_of(frame, key, groups, observed);
    const auto [begin, end] = entries_.equal_range(key);
    for (auto it = begin; it != end; ++it)
        if (it->second.is_of(groups, observed))
        {
            it->second.system->set_frame(frame);
            return *it->second.system;
        }
    // A caller holds at most one system at a time and requests it again before each advance, so clearing is safe here.
    const std::size_t groups_of_all = frame.groups->all.size();
    if (entries_.size() >= std::max(kMost, 2 * groups_of_all) || members_ >= kMost + kMostMembers * groups_of_all)
        entries_.clear(), members_ = 0;
    members_ += members;
    Entry fresh{
        {groups.begin(), groups.end()}, {observed.begin(), observed.end()}, std::make_unique<GroupSystem>(scratch_), key, frame.tick};
    fresh.system->configure(frame, groups, observed);
    return *entries_.emplace(key, std::move(fresh))->second.system;
}

/// A system that neither this step nor the last one has used serves again, with its memory.
GroupSystem& SystemPool::large_of(const StepFrame& frame, std::uint64_t key, std::span<const std::uint32_t> groups,
                                  std::span<const std::uint32_t> observed)
{
    for (Entry& e : large_)
    {
        if (e.key != key || !e.is_of(groups, observed)) continue;
        e.used = frame.tick;
        e.system->set_frame(frame);
        return *e.system;
    }
    auto place = std::ranges::min_element(large_, {}, &Entry::used);
    if (place == large_.end() || (large_.size() < kMostLarge && place->used + 1 >= frame.tick))
        place = large_.insert(large_.end(), {{}, {}, std::make_unique<GroupSystem>(scratch_), 0, 0});
    place->groups.assign(groups.begin(), groups.end()), place->observed.assign(observed.begin(), observed.end());
    place->key = key, place->used = frame.tick;
    place->system->hold_rows(false), place->system->set_extra_forces(nullptr);  // as a new one
    place->system->configure(frame, groups, observed);
    return *place->system;
}

}  // namespace plab::simulation
