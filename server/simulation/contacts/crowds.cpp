#include "simulation/contacts/crowds.h"

#include <algorithm>

#include "simulation/contacts/sleeping_pairs.h"

namespace plab::simulation
{

void Crowds::find(std::span<const PairState> pairs, const RestState& rest, const Limits& limits, std::vector<double>& until)
{
    find_in(pairs, rest, limits, until);
}

void Crowds::find(std::span<const FirstTouch> pairs, const RestState& rest, const Limits& limits, std::vector<double>& until)
{
    find_in(pairs, rest, limits, until);
}

template <class Pair>
void Crowds::find_in(std::span<const Pair> pairs, const RestState& rest, const Limits& limits, std::vector<double>& until)
{
    const Bodies& bodies = step_.world.host().bodies;
    until.resize(until.empty() ? 0 : bodies.size(), -HUGE_VAL);
    join_islands(pairs);
    count();
    for (const auto& island : rest.islands)
    {
        island_bodies_ = std::max(island_bodies_, static_cast<std::uint32_t>(island->bodies.size()));
        island_points_ = std::max(island_points_, island->points);
    }
    if (island_bodies_ > limits.bodies || island_points_ > limits.points) note_large(rest, limits, until);
    flags_.assign(bodies.size(), 0);
    // The end of a dwell may fall on a step but for rounding.
    const double dwell = limits.dwell * (1 - 1e-9);
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
        if (bodies.dynamic(b) && (rest.asleep(b) || (!until.empty() && step_.frame.start_time < until[b] + dwell))) flags_[b] = 1;
    spread(pairs);
}

/// Islands over all detections: a body may rest on what another detection holds, and an impact on one link of a chain is an impact on all
/// of them.
template <class Pair>
void Crowds::join_islands(std::span<const Pair> pairs)
{
    const Bodies& bodies = step_.world.host().bodies;
    islands_.reset(bodies.size());
    counts_.assign(bodies.size(), {});
    // Before contacts join anything, so that the first and the last member tell whether a group has been joined already.
    const auto join_held = [&](Ref body)
    {
        const std::uint32_t g = bodies.dynamic(body.index) ? step_.groups.of(body) : kNoIndex;
        if (g == kNoIndex || step_.groups.all[g].rows.empty()) return;
        const std::vector<std::uint32_t>& members = step_.groups.all[g].bodies;
        if (islands_.find(members.back()) == islands_.find(members.front())) return;
        for (const std::uint32_t b : members) islands_.join(members.front(), b);
    };
    for (const Pair& p : pairs) join_held(p.a), join_held(p.b);
    // Points are counted at one body of each pair first, so that the pairs are gone through once.
    for (const Pair& p : pairs)
    {
        if (!p.resting || p.ahead) continue;
        if (bodies.dynamic(p.a.index) && bodies.dynamic(p.b.index)) islands_.join(p.a.index, p.b.index);
        counts_[bodies.dynamic(p.a.index) ? p.a.index : p.b.index].points += p.count;
    }
}

void Crowds::count()
{
    const Bodies& bodies = step_.world.host().bodies;
    bodies_ = island_bodies_ = island_points_ = 0;
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
    {
        const std::uint32_t root = islands_.find(b);
        Count& island = counts_[root];
        if (root != b) island.points += counts_[b].points;
        island_points_ = std::max(island_points_, island.points);
        if (bodies.dynamic(b)) ++bodies_, island_bodies_ = std::max(island_bodies_, ++island.bodies);
    }
}

/// Not of bodies that sleep, whose pairs may be with the others or not.
void Crowds::note_large(const RestState& rest, const Limits& limits, std::vector<double>& until)
{
    const Bodies& bodies = step_.world.host().bodies;
    until.resize(bodies.size(), -HUGE_VAL);
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
    {
        const Count& island = counts_[islands_.find(b)];
        if (bodies.dynamic(b) && !rest.asleep(b) && (island.bodies > limits.bodies || island.points > limits.points))
            until[b] = step_.frame.start_time + step_.frame.step;
    }
}

/// Crowded are also those that would be rewound with one that is: by gaps that a manager holds, too, and by forces, which pass on no impact
/// and did not count.
template <class Pair>
void Crowds::spread(std::span<const Pair> pairs)
{
    crowded_ = 0;
    if (std::ranges::none_of(flags_, [](std::uint8_t f) { return f != 0; })) return;
    const Bodies& bodies = step_.world.host().bodies;
    for (const Pair& p : pairs)
        if (p.resting && p.ahead && bodies.dynamic(p.a.index) && bodies.dynamic(p.b.index)) islands_.join(p.a.index, p.b.index);
    for (const Group& group : step_.groups.all)
        for (const std::uint32_t b : group.bodies) islands_.join(group.bodies.front(), b);
    for (std::uint32_t b = 0; b < flags_.size(); ++b)
        if (flags_[b] != 0) flags_[islands_.find(b)] = 1;
    for (std::uint32_t b = 0; b < flags_.size(); ++b)
        if (bodies.dynamic(b)) crowded_ += flags_[b] = flags_[islands_.find(b)];
}

}  // namespace plab::simulation
