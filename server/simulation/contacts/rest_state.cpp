#include "simulation/contacts/rest_state.h"

#include <algorithm>

#include "simulation/contacts/sleeping_pairs.h"
#include "world/state_hash.h"

namespace plab::simulation
{

using world::hash_of, world::mix;

std::uint64_t RestState::hash(const world::World& world, std::uint64_t h) const
{
    std::uint64_t sum = 0;  // of well mixed terms, so that the order of rows does not matter
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
    {
        const BodyRest& r = bodies[b];
        if (r == BodyRest{}) continue;
        std::uint64_t own = mix(mix(0, std::uint64_t{world.rank(Ref{Facet::Body, b})}), std::uint64_t{r.quiet} << 1 | (r.asleep ? 1u : 0u));
        for (const Vec3& v : {r.moved, r.moved_before, r.turned, r.turned_before}) own = mix(own, hash_of(v));
        sum += mix(own, r.cause);
    }
    return sum == 0 ? h : mix(mix(h, sum), scene_cause);
}

void RestState::copy(const RestState& from)
{
    const std::vector<std::uint32_t>* some = bodies.size() == from.bodies.size() ? from.changing_since(mark) : nullptr;
    if (!some)
    {
        *this = from;
        return;
    }
    for (const std::uint32_t b : *some) bodies[b] = from.bodies[b];
    lists_awake = true;
}

void ContactCache::bring_back(const world::World& world)
{
    if (rest_.islands.empty()) return;
    const auto key_of = [&](const PairState* p) { return PairKey(world, p->detector, p->a, p->b); };
    std::vector<std::pair<PairKey, const PairState*>> order;
    for (const auto& island : rest_.islands)
        for (const PairState& p : island->pairs) order.emplace_back(key_of(&p), &p);
    std::sort(order.begin(), order.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    std::vector<PairState> fresh;
    fresh.reserve(order.size());
    for (const auto& [key, pair] : order) fresh.push_back(*pair);
    add_sorted(fresh, world);
    rest_.islands.clear(), rest_.note_change();
}

}  // namespace plab::simulation
