#include "simulation/contacts/resting_pairs.h"

#include <algorithm>

namespace plab::simulation
{
namespace
{

void sort_places(std::vector<std::uint32_t>& places)
{
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
}

}  // namespace

std::uint32_t RestingPairs::moving_group_of(Ref body) const
{
    return world_.host().bodies.dynamic(body.index) ? groups_.of(body) : kNoIndex;
}

void RestingPairs::put(const PairState& pair, std::size_t place)
{
    const std::uint32_t ga = moving_group_of(pair.a), gb = moving_group_of(pair.b);
    const auto put_in = [&](std::uint32_t group)
    {
        nodes_.push_back({pair.detector, pair.a, pair.b, place, first_[group]});
        first_[group] = static_cast<std::uint32_t>(nodes_.size() - 1);
    };
    if (ga != kNoIndex) put_in(ga);
    if (gb != kNoIndex && gb != ga) put_in(gb);
}

void RestingPairs::build()
{
    ready_ = true;
    first_.assign(groups_.all.size(), kNoIndex);
    nodes_.clear();
    const std::vector<PairState>& pairs = cache_.pairs();
    visited_ += pairs.size();
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (pairs[i].resting) put(pairs[i], i);
}

void RestingPairs::add(const PairState& pair)
{
    if (ready_) put(pair, static_cast<std::size_t>(&pair - cache_.pairs().data()));
}

template <class Found>
void RestingPairs::each_of(std::uint32_t group, Found&& found)
{
    if (!ready_) build();
    for (std::uint32_t i = first_[group]; i != kNoIndex; i = nodes_[i].next)
    {
        Node& node = nodes_[i];
        ++visited_;
        const PairState* pair = cache_.find(node.detector, node.a, node.b, world_, node.place);
        if (pair && pair->resting) found(*pair, static_cast<std::uint32_t>(node.place));
    }
}

void RestingPairs::find(std::span<const std::uint32_t> groups, std::vector<std::uint32_t>& places)
{
    places.clear();
    if (!is_most_of_all(groups))
    {
        for (const std::uint32_t g : groups) each_of(g, [&](const PairState&, std::uint32_t place) { places.push_back(place); });
        return sort_places(places);
    }
    wanted_.begin(groups_.all.size());
    for (const std::uint32_t g : groups) wanted_.add(g);
    const auto is_wanted = [&](Ref r) { return moving_group_of(r) != kNoIndex && wanted_.has(moving_group_of(r)); };
    const std::vector<PairState>& pairs = cache_.pairs();
    visited_ += pairs.size();
    for (std::uint32_t i = 0; i < pairs.size(); ++i)
        if (pairs[i].resting && (is_wanted(pairs[i].a) || is_wanted(pairs[i].b))) places.push_back(i);
}

/// close_over() by passes over all pairs, which need no index and give sorted places. False if the set has grown in all passes.
bool RestingPairs::close_in_passes(IndexSet& groups, std::vector<std::uint32_t>& places)
{
    constexpr int kMostPasses = 3;
    const std::vector<PairState>& pairs = cache_.pairs();
    for (int pass = 0; pass < kMostPasses; ++pass)
    {
        bool grows = false;
        places.clear();
        visited_ += pairs.size();
        for (std::uint32_t i = 0; i < pairs.size(); ++i)
        {
            const PairState& p = pairs[i];
            if (!p.resting) continue;
            const std::uint32_t ga = moving_group_of(p.a), gb = moving_group_of(p.b);
            const bool has_a = ga != kNoIndex && groups.has(ga), has_b = gb != kNoIndex && groups.has(gb);
            if (has_a || has_b) places.push_back(i);
            if (has_a == has_b || ga == kNoIndex || gb == kNoIndex) continue;
            groups.add(has_a ? gb : ga);
            grows = true;
        }
        if (!grows) return true;
    }
    return false;
}

void RestingPairs::close_over(IndexSet& groups, std::vector<std::uint32_t>& places)
{
    if (is_most_of_all(groups.members()) && close_in_passes(groups, places)) return;
    places.clear();
    // A group is never left again once it is a member, so each is visited once.
    for (std::size_t i = 0; i < groups.members().size(); ++i)
        each_of(groups.members()[i],
                [&](const PairState& p, std::uint32_t place)
                {
                    places.push_back(place);
                    for (const Ref r : {p.a, p.b})
                        if (const std::uint32_t g = moving_group_of(r); g != kNoIndex) groups.add(g);
                });
    sort_places(places);
}

}  // namespace plab::simulation
