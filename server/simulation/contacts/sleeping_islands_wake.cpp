// What wakes islands.
#include <algorithm>
#include <utility>

#include "simulation/contacts/sleeping_islands.h"

namespace plab::simulation
{

bool SleepingIslands::begin_step()
{
    RestState& r = rest();
    now_ = step_.frame.start_time;
    const bool was_on = on_;
    read_rules();
    if (on_)
        r.bodies.resize(step_.world.host().bodies.size());
    else if (r.bodies.empty())
    {
        if (r.mark != refused_) refused_ = r.mark, publish();
        return false;
    }
    // The state may have been replaced as well, by a restored one.
    if (on_ && was_on && r.mark && r.mark == listed_) return false;
    if (!r.mark) r.note_change();
    contacts_.detect_all_once();
    const bool asleep = std::any_of(r.bodies.begin(), r.bodies.end(), [](const BodyRest& b) { return b.asleep; });
    if (asleep && r.islands.empty()) put_pairs_away();
    if (!asleep) r.scene_cause = 0;
    list_awake();
    const std::size_t before = r.islands.size();
    if (!on_)
        wake_all("sleeping is switched off"), r.bodies.clear();
    else if (asleep)
        wake_changed();
    if (r.mark != listed_) list_awake();
    return r.islands.size() != before;
}

/// Wakes islands (places in RestState::islands, in any order).
void SleepingIslands::wake(std::vector<std::uint32_t> places, const char* why, Ref by)
{
    if (places.empty()) return;
    RestState& r = rest();
    const auto rank = [&](std::uint32_t i) { return step_.world.rank(Ref{Facet::Body, r.islands[i]->bodies.front()}); };
    std::sort(places.begin(), places.end(), [&](std::uint32_t x, std::uint32_t y) { return rank(x) < rank(y); });
    std::vector<std::pair<PairKey, const PairState*>> order;
    for (const std::uint32_t i : places)
    {
        const SleepingIsland& island = *r.islands[i];
        for (const std::uint32_t b : island.bodies) r.bodies[b] = {};
        for (const PairState& p : island.pairs) order.emplace_back(PairKey(step_.world, p.detector, p.a, p.b), &p);
        report("island.awake", island, why, by, 0);
    }
    std::sort(order.begin(), order.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    std::vector<PairState> back;
    back.reserve(order.size());
    for (const auto& [key, pair] : order) back.push_back(*pair);
    contacts_.cache().add_sorted(back, step_.world);
    contacts_.resting().forget();
    std::sort(places.begin(), places.end());
    std::size_t kept = 0, next = 0;
    for (std::uint32_t i = 0; i < r.islands.size(); ++i)
        if (next < places.size() && places[next] == i)
            ++next;
        else
            r.islands[kept++] = std::move(r.islands[i]);
    r.islands.resize(kept);
    if (r.islands.empty()) r.scene_cause = 0;
    r.note_change();
}

void SleepingIslands::wake_all(const char* why)
{
    std::vector<std::uint32_t> all(rest().islands.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    wake(std::move(all), why, {});
}

/// Wakes the islands of bodies that do not depend on the same as when they fell asleep.
void SleepingIslands::wake_changed()
{
    RestState& r = rest();
    causes_.begin();
    if (r.scene_cause != causes_.of_scene()) return wake_all("what may hold it has changed");
    std::vector<std::uint32_t> changed;
    for (std::uint32_t i = 0; i < r.islands.size(); ++i)
    {
        const SleepingIsland& island = *r.islands[i];
        for (const PairState& p : island.pairs) causes_.add_pair(p);
        const auto is_changed = [&](std::uint32_t b)
        {
            const std::uint32_t g = step_.groups.group_of_body[b];
            return g == kNoIndex || may_sleep_[g] == 0 || r.bodies[b].cause != causes_.of_body(b);
        };
        if (std::any_of(island.bodies.begin(), island.bodies.end(), is_changed)) changed.push_back(i);
    }
    wake(std::move(changed), "what acts on it has changed", {});
}

bool SleepingIslands::wake_touched(std::span<const PairState> fresh)
{
    if (!any()) return false;
    std::vector<std::uint32_t> touched;
    Ref by;
    for (const PairState& p : fresh)
        for (const auto& [own, other] : {std::pair(p.a, p.b), std::pair(p.b, p.a)})
        {
            if (!rest().asleep(own.index)) continue;
            const std::uint32_t island = island_of_body_[own.index];
            if (std::find(touched.begin(), touched.end(), island) == touched.end()) touched.push_back(island);
            if (!by.valid()) by = other;
        }
    if (touched.empty()) return false;
    wake(std::move(touched), "touched", by);
    list_awake();
    return true;
}

}  // namespace plab::simulation
