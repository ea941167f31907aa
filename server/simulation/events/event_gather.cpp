// Which candidates are one event.
#include <algorithm>
#include <utility>

#include "simulation/events/event_locator.h"

namespace plab::simulation
{
namespace
{

/// Two events that are less than this fraction of the step apart count as simultaneous if one body takes part in both.
constexpr double kSameTime = 1e-10;
/// The same for one mechanism. Which of its feet touches first is chance, and those that are hit one after the other bounce off one
/// another.
constexpr double kSameTimeOfMechanism = 0x1p-20;

}  // namespace

/// Adds a candidate to the present event. If forces press its pair together, the event stops one of the two bodies; a contact on that
/// body, which was not pressed while both were falling, is then tested again as if the body had been stopped already. So a stack of
/// bodies that is released comes to rest in one event instead of one event per body.
void EventLocator::take(std::uint32_t slot, double until)
{
    chosen_.push_back(slot);
    const Bodies& bodies = step_.world.host().bodies;
    const Ref a = candidates_[slot].a, b = candidates_[slot].b;
    const auto choose = [&](std::uint32_t body)
    {
        if (bodies.dynamic(body) && !std::exchange(met_[body].chosen, true)) met_bodies_.push_back(body);
    };
    const auto choose_joined = [&](std::uint32_t body)
    {
        choose(body);
        met_[body].joined = bodies.dynamic(body);
    };
    for (const Ref r : {a, b})
    {
        choose(r.index);
        // What hits one body of a mechanism acts on all of them: a step ladder falls on both feet.
        const std::uint32_t g = step_.groups.of(r);
        if (g != kNoIndex && !step_.groups.all[g].rows.empty()) std::ranges::for_each(step_.groups.all[g].bodies, choose_joined);
    }
    // A response by rows solves an island as a whole anyway.
    if (!candidates_[slot].pressed || contacts_.detectors()[candidates_[slot].detector].by_rows) return;
    const auto is_fixed = [&](Ref r) { return !bodies.dynamic(r.index) || met_[r.index].relief != Vec3{}; };
    if (is_fixed(a) == is_fixed(b)) return;
    const Ref stopped = is_fixed(a) ? b : a;
    met_[stopped.index].relief = stopped == b ? candidates_[slot].relief : -candidates_[slot].relief;
    recall_unpressed(stopped, until);
}

/// Puts the pair of a body that touched without being pressed, up to the given time, back into the queue. If there are several such
/// pairs, they are left alone: in a wall of bricks one event would grow to all of it, and one answer for very many pairs takes longer
/// than several answers for a few pairs each.
void EventLocator::recall_unpressed(Ref stopped, double until)
{
    std::erase_if(unpressed_, [&](const PairAtTime& t) { return t.version != version_of(t.a, t.b); });
    const auto meets = [&](const PairAtTime& t) { return (t.a == stopped || t.b == stopped) && t.time <= until; };
    const auto found = std::find_if(unpressed_.begin(), unpressed_.end(), meets);
    if (found == unpressed_.end() || std::any_of(found + 1, unpressed_.end(), meets)) return;
    const std::uint32_t again = new_slot();
    Candidate& c = candidates_[again];
    c.detector = found->detector, c.a = found->a, c.b = found->b, c.time = found->time, c.version = found->version, c.certified = true;
    push(again);
    unpressed_.erase(found);
}

/// Collects the first event and all candidates that happen at the same time to the same bodies.
void EventLocator::gather(std::uint32_t first)
{
    chosen_.clear();
    const double until = candidates_[first].time + kSameTime * step_.frame.step;
    take(first, until);
    const Candidate& c = candidates_[first];
    if (c.certified && contacts_.detectors()[c.detector].responds && !c.stuck)
        gather_until(until, c.time + kSameTimeOfMechanism * step_.frame.step);
    for (const std::uint32_t b : met_bodies_) met_[b] = {};
    met_bodies_.clear();
}

/// `until` is for bodies that are hit, `until_joined` for mechanisms that are.
void EventLocator::gather_until(double until, double until_joined)
{
    const auto joined = [&](std::uint32_t body) { return met_[body].joined; };
    const auto is_in_time = [&](const Candidate& x) { return x.time <= (joined(x.a.index) || joined(x.b.index) ? until_joined : until); };
    const auto meets_chosen = [&](std::uint32_t slot)
    {
        const Candidate& x = candidates_[slot];
        return met_[x.a.index].chosen || met_[x.b.index].chosen;
    };
    set_aside_.clear();
    std::uint32_t slot = 0;
    while (!budget_.is_spent() && !queue_.empty() && queue_.front().time <= until_joined && pop(slot))
    {
        Candidate& x = candidates_[slot];
        if (!is_in_time(x) || !x.certified || !contacts_.detectors()[x.detector].responds || !meets_chosen(slot))
        {
            set_aside_.push_back(slot);
            continue;
        }
        if (!x.located) locate(x);
        if (x.located && x.nothing)
            free_.push_back(slot);
        else if (!x.located || !is_in_time(x) || x.at_end || x.stuck)
            set_aside_.push_back(slot);
        else
        {
            take(slot, until);
            // Candidates that were set aside may share a body with the new one: consider them again.
            const auto stays = [&](std::uint32_t s) { return !meets_chosen(s); };
            const auto known = std::partition(set_aside_.begin(), set_aside_.end(), stays);
            std::for_each(known, set_aside_.end(), [&](std::uint32_t s) { push(s); });
            set_aside_.erase(known, set_aside_.end());
        }
    }
    for (const std::uint32_t s : set_aside_) push(s);
}

}  // namespace plab::simulation
