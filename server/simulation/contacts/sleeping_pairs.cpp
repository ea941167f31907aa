// What of the cache concerns sleeping pairs as well: its hash, and what a structural change makes of it.
#include "simulation/contacts/sleeping_pairs.h"

#include <algorithm>
#include <cmath>

#include "world/state_hash.h"

namespace plab::simulation
{

using world::hash_of, world::mix;

namespace
{

std::uint64_t hash_of_contact(const KnownContact& k)
{
    const std::uint64_t h = mix(mix(hash_of(k.impulse), k.id), std::uint64_t{k.feature});
    // The spring state is hashed only if there is one.
    if (k.stretch == Vec3{} && k.rest_depth == 0 && k.preload == 0) return h;
    return mix(mix(mix(h, hash_of(k.stretch)), k.rest_depth), k.preload);
}

std::uint64_t hash_of_pair(const world::World& world, const PairState& p)
{
    const std::uint64_t pair = std::uint64_t{world.rank(p.a)} << 32 | world.rank(p.b);
    const std::uint64_t how = (p.resting ? 1u : 0u) | (p.ahead ? 2u : 0u) | (p.overlapping ? 4u : 0u) | std::uint64_t{p.count} << 3;
    std::uint64_t h = mix(mix(hash_of(p.normal), pair), how);
    for (const KnownContact& k : p.all()) h = mix(h, hash_of_contact(k));
    if (p.bounces == BounceHistory{}) return h;
    return mix(mix(mix(h, p.bounces.time), p.bounces.interval), p.bounces.previous);
}

std::uint64_t hash_of_name(const std::string& id)
{
    return world::hash_bytes(0, {reinterpret_cast<const std::uint8_t*>(id.data()), id.size()});
}

std::uint64_t hash_of_contact(const ForceContact& c)
{
    std::uint64_t h = mix(mix(0, c.id), std::uint64_t{c.feature} << 2 | (c.reported ? 1u : 0u) | (c.dormant ? 2u : 0u));
    for (const Vec3& v : {c.stretch, c.impulse, c.force}) h = mix(h, hash_of(v));
    for (const double x :
         {c.rest_depth, c.preload, c.open_depth, c.approach, c.begin, c.depth, c.peak, c.half_period, c.swing_speed, c.peak_swing_speed})
        h = mix(h, x);
    return h;
}

/// A sum of well mixed terms, so that the order of rows does not matter.
std::uint64_t mix_crowds(std::uint64_t h, const std::vector<double>& until, const world::World& world)
{
    std::uint64_t sum = 0;
    for (std::uint32_t b = 0; b < until.size(); ++b)
        if (std::isfinite(until[b])) sum += mix(mix(0, std::uint64_t{world.rank(Ref{Facet::Body, b})}), until[b]);
    return sum == 0 ? h : mix(h, sum);
}

}  // namespace

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

std::uint64_t ContactCache::state_hash(const world::World& world, std::uint64_t h) const
{
    // Pairs of sleeping islands are summed, as they may be in either list.
    std::uint64_t asleep = 0;
    for (const PairState& p : pairs_)
        if (rest_.asleep(p.a.index) || rest_.asleep(p.b.index))
            asleep += hash_of_pair(world, p);
        else
            h = mix(h, hash_of_pair(world, p));
    for (const ForcePair& p : force_pairs_)
    {
        // By name, so that the hash of these pairs does not depend on what else is in the scene.
        h = mix(mix(h, hash_of_name(world.id_of(p.a))), hash_of_name(world.id_of(p.b)));
        for (const ForceContact& c : p.all()) h = mix(h, hash_of_contact(c));
    }
    h = mix_crowds(h, crowded_until_, world);
    if (rest_.bodies.empty()) return h;
    for (const auto& island : rest_.islands)
        for (const PairState& p : island->pairs) asleep += hash_of_pair(world, p);
    return rest_.hash(world, asleep == 0 ? h : mix(h, asleep));
}

void ContactCache::refresh(const world::World& world, const std::vector<Detector>& detectors)
{
    for (const auto& island : rest_.islands) pairs_.insert(pairs_.end(), island->pairs.begin(), island->pairs.end());
    keys_.resize(pairs_.size());  // sorted below
    rest_.islands.clear(), rest_.note_change();
    const std::size_t count = world.host().bodies.size();
    rest_.bodies.resize(std::min(rest_.bodies.size(), count)), crowded_until_.resize(std::min(crowded_until_.size(), count));
    for (std::uint32_t b = 0; b < count; ++b)
    {
        if (world.host().component_of({Facet::Body, b}) != kNoIndex) continue;
        if (b < rest_.bodies.size()) rest_.bodies[b] = {};
        if (b < crowded_until_.size()) crowded_until_[b] = -HUGE_VAL;
    }
    const auto gone = [&](const PairState& p)
    {
        const bool has_detector =
            std::any_of(detectors.begin(), detectors.end(), [&](const Detector& d) { return d.component == p.detector; });
        const auto lives = [&](Ref r) { return world.host().component_of(r) != kNoIndex; };
        return !has_detector || !lives(p.a) || !lives(p.b);
    };
    const auto has_no_speculating_detector = [&](const PairState& p)
    {
        return p.ahead && std::none_of(detectors.begin(), detectors.end(),
                                       [&](const Detector& d) { return d.component == p.detector && (d.speculates || d.adapts); });
    };
    drop_if([&](const PairState& p) { return gone(p) || has_no_speculating_detector(p); });
    for (PairState& p : pairs_)
    {
        // Without a response nothing rests: a sensor supports no body.
        const bool answered =
            std::any_of(detectors.begin(), detectors.end(),
                        [&](const Detector& d) { return d.component == p.detector && (d.responds || d.by_rows || d.by_force); });
        if (answered) continue;
        p.resting = false;
        p.bounces = {};
        for (KnownContact& k : p.all()) k.impulse = {};
    }
    sort(world);  // a new component changes ranks
    may_have_rest_depth_ = true;
}

}  // namespace plab::simulation
