#include "simulation/events/event_locator.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace plab::simulation
{
namespace
{
/// Events in one step of one world before the rest of them is answered without bounce, and said so.
constexpr int kMostEvents = 200000;
/// And without bounce, before the rest waits for the next step.
constexpr int kMostQuietEvents = 20000;
/// Events this share of the step apart happen at one time where a body takes part in both.
constexpr double kSameTime = 1e-13;

}  // namespace

bool EventLocator::Entry::operator<(const Entry& other) const
{
    // A heap has its largest on top.
    return std::tie(time, detector_rank, a_rank, b_rank) > std::tie(other.time, other.detector_rank, other.a_rank, other.b_rank);
}

std::uint32_t EventLocator::new_slot()
{
    if (free_.empty())
    {
        candidates_.emplace_back();
        return static_cast<std::uint32_t>(candidates_.size() - 1);
    }
    const std::uint32_t slot = free_.back();
    free_.pop_back();
    Candidate& c = candidates_[slot];
    std::vector<FoundContact> kept = std::move(c.contacts);
    kept.clear();
    c = {};
    c.contacts = std::move(kept);
    return slot;
}

std::uint64_t EventLocator::version_of(const Candidate& c) const
{
    std::uint64_t sum = 0;
    for (const Ref r : {c.a, c.b})
        if (const std::uint32_t g = s_->groups_.of(r); g != kNoIndex) sum += versions_[g];
    return sum;
}

void EventLocator::push(std::uint32_t slot)
{
    const Candidate& c = candidates_[slot];
    const world::World& world = s_->world_;
    queue_.push_back({c.time, world.rank(s_->detectors_[c.detector].component), world.rank(c.a), world.rank(c.b), slot});
    std::push_heap(queue_.begin(), queue_.end());
}

/// The first that is not stale.
bool EventLocator::pop(std::uint32_t& slot)
{
    while (!queue_.empty())
    {
        std::pop_heap(queue_.begin(), queue_.end());
        slot = queue_.back().slot;
        queue_.pop_back();
        if (candidates_[slot].version == version_of(candidates_[slot])) return true;
        free_.push_back(slot);
    }
    return false;
}

bool EventLocator::is_live(std::uint32_t detector, Ref a, Ref b) const
{
    return std::any_of(queue_.begin(), queue_.end(),
                       [&](const Entry& e)
                       {
                           const Candidate& c = candidates_[e.slot];
                           return c.detector == detector && c.a == a && c.b == b && c.version == version_of(c);
                       });
}

bool EventLocator::acts(const Detector& detector, const PairState* pair, bool approaching) const
{
    if (pair && pair->resting) return false;
    // A sensor only wants the time of the first touch.
    if (!detector.responds) return !pair;
    if (!detector.locates) return approaching;
    return approaching || !(pair && pair->overlapping);
}

void EventLocator::consider(const std::vector<FoundContact>& found, std::size_t begin, std::size_t end)
{
    const FoundContact& first = found[begin];
    const Detector& detector = s_->detectors_[first.detector];
    if (detector.persists() || detector.certifies) return;
    bool overlaps = false, approaching = false;
    for (std::size_t i = begin; i < end; ++i)
    {
        overlaps = overlaps || found[i].contact.depth > 0;
        approaching = approaching || (found[i].contact.depth > 0 && s_->normal_velocity(found[i].contact) < 0);
    }
    const PairState* pair = s_->cache_.find(detector.component, first.contact.a, first.contact.b, s_->world_);
    if (!overlaps || !acts(detector, pair, approaching)) return;
    if (is_live(first.detector, first.contact.a, first.contact.b)) return;
    const std::uint32_t slot = new_slot();
    Candidate& c = candidates_[slot];
    c.detector = first.detector, c.a = first.contact.a, c.b = first.contact.b;
    c.at_end = !detector.locates;
    c.version = version_of(c);
    c.contacts.assign(found.begin() + static_cast<std::ptrdiff_t>(begin), found.begin() + static_cast<std::ptrdiff_t>(end));
    push(slot);
}

void EventLocator::collect(const std::vector<FoundContact>& found)
{
    for (std::size_t i = 0; i < found.size();)
    {
        std::size_t end = i;
        while (end < found.size() && Stepper::same_pair(found[end], found[i])) ++end;
        consider(found, i, end);
        i = end;
    }
}

void EventLocator::note_resting_groups()
{
    rests_.assign(s_->groups_.all.size(), 0);
    if (s_->forces_.any()) s_->forces_.flag_near(rests_);  // springs hold together as well
    for (const PairState& p : s_->cache_.pairs())
    {
        if (!p.resting) continue;
        for (const Ref r : {p.a, p.b})
            if (const std::uint32_t g = s_->groups_.of(r); g != kNoIndex) rests_[g] = 1;
    }
}

void EventLocator::close_over_resting_pairs()
{
    // Whatever rests on a member goes with it: an impact passes through standing contacts.
    for (bool grown = true; grown;)
    {
        grown = s_->forces_.any() && s_->forces_.close_over(in_scope_);
        for (const PairState& p : s_->cache_.pairs())
        {
            const std::uint32_t ga = s_->groups_.of(p.a), gb = s_->groups_.of(p.b);
            const Bodies& bodies = s_->world_.host().bodies;
            if (!p.resting || !bodies.dynamic(p.a.index) || !bodies.dynamic(p.b.index) || in_scope_[ga] == in_scope_[gb]) continue;
            in_scope_[ga] = in_scope_[gb] = 1;
            grown = true;
        }
    }
}

void EventLocator::scope_of(const Candidate& candidate, bool local)
{
    const std::size_t groups = s_->groups_.all.size();
    if (!local) in_scope_.assign(groups, 1);
    bool rests = !local;
    for (const Ref r : {candidate.a, candidate.b})
        if (const std::uint32_t g = s_->groups_.of(r); g != kNoIndex) in_scope_[g] = 1, rests = rests || rests_[g] != 0;
    if (rests) close_over_resting_pairs();
}

/// Takes the first event, and with it whatever happens at the same time to the same bodies.
void EventLocator::gather(std::uint32_t first)
{
    chosen_.assign(1, first);
    const Candidate& c = candidates_[first];
    if (!c.certified || !s_->detectors_[c.detector].responds || c.stuck) return;
    const double until = c.time + kSameTime * s_->frame_.step;
    const auto meets_chosen = [&](const Candidate& x)
    {
        return std::any_of(chosen_.begin(), chosen_.end(),
                           [&](std::uint32_t slot)
                           {
                               const Candidate& y = candidates_[slot];
                               const Bodies& bodies = s_->world_.host().bodies;
                               const auto same = [&](Ref r, Ref q) { return r == q && bodies.dynamic(r.index); };
                               return same(x.a, y.a) || same(x.a, y.b) || same(x.b, y.a) || same(x.b, y.b);
                           });
    };
    set_aside_.clear();
    std::uint32_t slot = 0;
    while (!queue_.empty() && queue_.front().time <= until && pop(slot))
    {
        Candidate& x = candidates_[slot];
        if (x.time > until || !x.certified || !s_->detectors_[x.detector].responds || !meets_chosen(x))
        {
            set_aside_.push_back(slot);
            continue;
        }
        if (!x.located) locate(x);
        if (x.nothing)
            free_.push_back(slot);
        else if (x.time > until || x.at_end || x.stuck)
            set_aside_.push_back(slot);
        else
        {
            chosen_.push_back(slot);
            // Who was passed over may know the new one.
            for (const std::uint32_t s : set_aside_) push(s);
            set_aside_.clear();
        }
    }
    for (const std::uint32_t s : set_aside_) push(s);
}

/// Answers the chosen event.
void EventLocator::process()
{
    const Candidate& first = candidates_[chosen_.front()];
    const Detector& detector = s_->detectors_[first.detector];
    const double time = first.time;
    rewound_ = false;
    if (!detector.responds)
    {
        // A sensor disturbs nobody: the time is known, nothing goes back.
        complete(candidates_[chosen_.front()]);
        record(candidates_[chosen_.front()], candidates_[chosen_.front()].contacts, s_->frame_.start_time + time);
        return;
    }
    in_scope_.assign(s_->groups_.all.size(), 0);
    for (const std::uint32_t slot : chosen_) scope_of(candidates_[slot], true);
    touched_ = in_scope_;
    if (!detector.local && !first.at_end) scope_of(first, false);
    scope_.clear();
    for (std::uint32_t g = 0; g < in_scope_.size(); ++g)
        if (in_scope_[g]) scope_.push_back(g);
    if (first.at_end)
    {
        // Answered where the step ends: nobody goes back, only speeds change.
        answer();
        for (const std::uint32_t g : scope_) s_->save_end(g);
        return;
    }
    rewound_ = true;
    // What the pieces booked up to the end of the step is taken back, then booked again in two parts.
    advance_scope(s_->frame_.step, {&s_->work_, -1}, true);
    advance_scope(time, {&s_->work_, 1}, true);
    for (const std::uint32_t g : scope_) s_->segment_begin_[g] = time;
    s_->report_.rewinds += static_cast<int>(scope_.size());
    answer();
    for (const std::uint32_t g : scope_) s_->save_segment(g);
    if (any_certifies_) start_pieces(time);
    if (time < s_->frame_.step) go_on(time);
    for (const std::uint32_t g : scope_) s_->save_end(g), versions_[g] += touched_[g];
    if (any_certifies_) end_pieces();
}

void EventLocator::look_again(std::vector<FoundContact>& found)
{
    // Only pairs with a member that went back can have changed; the rest of what was known stands.
    if (any_certifies_) find_near(true);
    if (all_certify_) return;
    s_->detect_all(found);
    collect(found);
}

bool EventLocator::out_of_budget(int events)
{
    if (events < kMostEvents) return false;
    if (!std::exchange(exhausted_, true))
    {
        Event e;
        e.time = s_->frame_.start_time, e.kind = "contact.too_many", e.severity = Severity::Warning;
        e.component = s_->detectors_[candidates_[chosen_.front()].detector].component;
        e.message = "more than " + std::to_string(kMostEvents) + " events in one step; what follows in this step does not bounce";
        s_->emit(std::move(e));
    }
    return events >= kMostEvents + kMostQuietEvents;
}

void EventLocator::run(std::vector<FoundContact>& found)
{
    const auto& detectors = s_->detectors_;
    any_certifies_ = std::any_of(detectors.begin(), detectors.end(), [](const Detector& d) { return d.certifies; });
    all_certify_ = std::all_of(detectors.begin(), detectors.end(), [](const Detector& d) { return d.certifies; });
    touches_by_force_ = std::any_of(detectors.begin(), detectors.end(), [](const Detector& d) { return d.by_force; });
    exhausted_ = false;
    queue_.clear(), free_.clear();
    for (std::uint32_t i = 0; i < candidates_.size(); ++i) free_.push_back(i);
    versions_.assign(s_->groups_.all.size(), 0);
    note_resting_groups();
    if (any_certifies_) begin_courses(), find_near(false);
    if (!all_certify_) s_->detect_all(found), collect(found);
    std::uint32_t slot = 0;
    for (int events = 0; !s_->frame_.give_up() && pop(slot);)
    {
        Candidate& c = candidates_[slot];
        if (!c.located)
        {
            locate(c);
            if (c.nothing)
                free_.push_back(slot);
            else
                push(slot);
            continue;
        }
        gather(slot);
        if (out_of_budget(events)) break;
        process();
        ++events;
        for (const std::uint32_t done : chosen_) free_.push_back(done);
        if (rewound_) look_again(found);
    }
    if (all_certify_) look_at_known_pairs(found);
}

}  // namespace plab::simulation
