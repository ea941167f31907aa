#include "simulation/events/event_locator.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace plab::simulation
{

bool EventLocator::Entry::operator<(const Entry& other) const
{
    // A heap keeps its largest element on top, so the earliest entry has to compare as the largest.
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

std::uint64_t EventLocator::version_of(Ref a, Ref b) const
{
    std::uint64_t sum = 0;
    for (const Ref r : {a, b})
        if (const std::uint32_t g = step_.groups.of(r); g != kNoIndex) sum += versions_[g];
    return sum;
}

void EventLocator::push(std::uint32_t slot)
{
    const Candidate& c = candidates_[slot];
    const world::World& world = step_.world;
    queue_.push_back({c.time, world.rank(contacts_.detectors()[c.detector].component), world.rank(c.a), world.rank(c.b), slot});
    std::push_heap(queue_.begin(), queue_.end());
}

/// The earliest candidate that is not stale.
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

/// Lists the pairs in the queue that are not stale, for is_live().
void EventLocator::note_live()
{
    live_.clear();
    for (const Entry& e : queue_)
        if (const Candidate& c = candidates_[e.slot]; c.version == version_of(c)) live_.push_back({c.detector, c.a.index, c.b.index});
    std::sort(live_.begin(), live_.end());
}

bool EventLocator::is_live(std::uint32_t detector, Ref a, Ref b) const
{
    return std::binary_search(live_.begin(), live_.end(), PairKey{detector, a.index, b.index});
}

bool EventLocator::acts(const Detector& detector, const PairState* pair, bool approaching) const
{
    if (pair && pair->resting) return false;
    // A sensor needs only the time of the first contact.
    if (!detector.responds) return !pair;
    if (!detector.locates) return approaching;
    return approaching || !(pair && pair->overlapping);
}

void EventLocator::consider(const std::vector<FoundContact>& found, std::size_t begin, std::size_t end)
{
    const FoundContact& first = found[begin];
    const Detector& detector = contacts_.detectors()[first.detector];
    if (contacts_.persists(detector, first.contact.a, first.contact.b) || (detector.certifies && !answers_at_end_)) return;
    bool overlaps = false, approaching = false;
    for (std::size_t i = begin; i < end; ++i)
    {
        overlaps = overlaps || found[i].contact.depth > 0;
        approaching = approaching || (found[i].contact.depth > 0 && contacts_.normal_velocity(found[i].contact) < 0);
    }
    const PairState* pair = contacts_.cache().find(detector.component, first.contact.a, first.contact.b, step_.world);
    if (!overlaps || !acts(detector, pair, approaching)) return;
    const auto own = std::span(found).subspan(begin, end - begin);
    if (detector.locates && detector.responds && slides(own)) return;
    if (detector.responds && contacts_.passes_over(own)) return;
    if (is_live(first.detector, first.contact.a, first.contact.b)) return;
    const std::uint32_t slot = new_slot();
    Candidate& c = candidates_[slot];
    c.detector = first.detector, c.a = first.contact.a, c.b = first.contact.b;
    c.at_end = answers_at_end_ || !detector.locates;
    c.version = version_of(c);
    c.contacts.assign(found.begin() + static_cast<std::ptrdiff_t>(begin), found.begin() + static_cast<std::ptrdiff_t>(end));
    push(slot);
}

void EventLocator::collect(const std::vector<FoundContact>& found)
{
    const auto& detectors = contacts_.detectors();
    if (std::all_of(detectors.begin(), detectors.end(), [](const Detector& d) { return d.persists(); })) return;
    note_live();
    for (std::size_t i = 0; i < found.size();)
    {
        std::size_t end = i;
        while (end < found.size() && same_pair(found[end], found[i])) ++end;
        consider(found, i, end);
        i = end;
    }
}

void EventLocator::note_resting_groups()
{
    rests_.assign(step_.groups.all.size(), 0);
    if (forces_.any()) forces_.flag_near(rests_);  // springs couple groups as well
    for (const PairState& p : contacts_.cache().pairs())
        if (p.resting) note_resting_groups_of(p);
}

/// Kinematic bodies do not count: nothing that touches them reaches others through them.
void EventLocator::note_resting_groups_of(const PairState& pair)
{
    for (const Ref r : {pair.a, pair.b})
        if (step_.world.host().bodies.dynamic(r.index)) rests_[step_.groups.of(r)] = 1;
}

/// Adds whatever rests on a member, because an impact propagates through persistent contacts and is rewound with all it reaches. So are
/// the kinematic bodies that it rests on, which pass nothing on.
void EventLocator::close_over_resting_pairs()
{
    for (std::size_t known = 0; known != in_scope_.members().size();)
    {
        contacts_.resting().close_over(in_scope_, resting_places_);
        known = in_scope_.members().size();
        if (forces_.any()) close_over_forces();
    }
    for (const std::uint32_t place : resting_places_)
        for (const PairState& p = std::as_const(contacts_).cache().pairs()[place]; const Ref r : {p.a, p.b})
            if (const std::uint32_t g = step_.groups.of(r); g != kNoIndex) in_scope_.add(g);
}

/// Adds the groups that springs may connect with members.
void EventLocator::close_over_forces()
{
    flags_.assign(step_.groups.all.size(), 0);
    for (const std::uint32_t g : in_scope_.members()) flags_[g] = 1;
    (void)forces_.close_over(flags_);
    for (std::uint32_t g = 0; g < flags_.size(); ++g)
        if (flags_[g] != 0) in_scope_.add(g);
}

/// m: an overlap up to this at the start of a piece is treated like a gap of 0.
double EventLocator::overlap_tolerance(Ref a, Ref b) const { return contacts_.overlap_tolerance(a, b); }

/// Adds the pair's own groups, and what rests on them.
void EventLocator::scope_of(const Candidate& candidate)
{
    bool rests = false;
    for (const Ref r : {candidate.a, candidate.b})
        if (const std::uint32_t g = step_.groups.of(r); g != kNoIndex) in_scope_.add(g), rests = rests || rests_[g] != 0;
    if (rests) close_over_resting_pairs();
}

/// Answers the chosen event.
void EventLocator::process()
{
    const Candidate& first = candidates_[chosen_.front()];
    const Detector& detector = contacts_.detectors()[first.detector];
    const double time = first.time;
    rewound_ = false;
    if (!detector.responds)
    {
        // A sensor changes no motion: the time is known, and nothing has to be rewound.
        complete(candidates_[chosen_.front()]);
        record(candidates_[chosen_.front()], candidates_[chosen_.front()].contacts, step_.frame.start_time + time);
        return;
    }
    in_scope_.begin(step_.groups.all.size());
    for (const std::uint32_t slot : chosen_) scope_of(candidates_[slot]);
    in_scope_.sort();
    disturbed_ = in_scope_.members();
    scope_ = detector.local || first.at_end ? disturbed_ : step_.all_groups;
    if (first.at_begin) met_at_begin_.push_back({first.detector, first.a, first.b, time, first.version});
    if (first.at_end)
    {
        // Answered where the step ends: nothing is rewound, only velocities change.
        pushed_since_ = true;
        answer();
        for (const std::uint32_t g : scope_) motion_.save_end(g);
        return;
    }
    rewound_ = true, found_ = false;
    // The work that was booked for the pieces up to the end of the step is taken back, then booked again in two parts: up to the event
    // here, and from it in go_on().
    advance_scope(step_.frame.step, {&step_.work, -1}, true);
    advance_scope(time, step_.book(), true);
    for (const std::uint32_t g : scope_) motion_.begin_segment(g, time);
    step_.report.rewinds += static_cast<int>(scope_.size());
    const double before = sweeps_and_queries();
    answer();
    budget_.spend(static_cast<double>(impact_.size()) + sweeps_and_queries() - before);
    for (const std::uint32_t g : scope_) motion_.save_segment(g);
    if (any_certifies_) start_pieces(time);
    if (time < step_.frame.step) go_on(time);
    for (const std::uint32_t g : scope_) motion_.save_end(g);
    // No impact changes the motion of a kinematic body, so its pairs with all others stay as they are.
    for (const std::uint32_t g : disturbed_)
        if (step_.groups.all[g].solver != kNoIndex) ++versions_[g];
    if (any_certifies_) end_pieces();
}

void EventLocator::detect_again(std::vector<FoundContact>& found)
{
    // Only pairs with a rewound member can have changed; all other candidates stay valid.
    if (any_certifies_) find_near_rewound();
    if (!any_at_end_) return;
    const double before = sweeps_and_queries();
    detect_at_end();
    budget_.spend(WorkBudget::kListedPair * static_cast<double>(step_.groups.all.size() + found.size()) + sweeps_and_queries() - before);
    collect(found);
}

/// What responses, managers, joints and distance queries have cost in this step so far, in units of the budget.
double EventLocator::sweeps_and_queries() const
{
    return WorkBudget::kSweptRow * static_cast<double>(step_.report.swept_rows) + WorkBudget::kFurtherPair * step_.report.further_pairs +
           held_bodies();
}

double EventLocator::held_bodies() const
{
    return WorkBudget::kHeldBody * static_cast<double>(motion_.scratch().held_bodies + advance_.batches().held_bodies());
}

/// Sets the budget to a multiple of what the step costs without event location: its groups, its known pairs, and the rows and queries
/// so far. Of the joints no more counts than most steps spend on them: where the equations of motion are so stiff that the step is dear
/// already, each trial would be as dear again.
void EventLocator::begin_budget()
{
    constexpr double kMostHeld = 10'000;
    const double held = held_bodies();
    const double plain = static_cast<double>(step_.groups.all.size() + contacts_.cache().pairs().size()) + sweeps_and_queries() -
                         std::max(0.0, held - kMostHeld);
    double multiple = 0, base = 0;
    for (const Detector& d : contacts_.detectors())
        if (d.locates)
            multiple = std::max(multiple, d.max_work.value_or(0)), base = std::max(base, d.base_work.value_or(WorkBudget::kBase));
    budget_.begin(plain, multiple > 0 ? multiple : WorkBudget::kMultiple, base);
}

void EventLocator::report_too_many(std::size_t left)
{
    Event e;
    e.time = step_.frame.start_time + step_.frame.step, e.kind = "resolution.over_budget", e.severity = Severity::Warning;
    const auto locates =
        std::find_if(contacts_.detectors().begin(), contacts_.detectors().end(), [](const Detector& d) { return d.locates; });
    e.component = (locates == contacts_.detectors().end() ? contacts_.detectors().front() : *locates).component;
    if (locates != contacts_.detectors().end() && locates->adapts) e.severity = Severity::Info;  // it is meant to give way
    e.message = "event location exceeded the work budget of the step (" + std::to_string(std::llround(budget_.allowed())) +
                " distance queries and advances) after " + std::to_string(step_.report.events) + " impacts; " + std::to_string(left) +
                " pairs are answered at the end of the step; take shorter steps, Resolution/None, or a larger max_work";
    e.values = {static_cast<double>(left)};
    step_.emit(std::move(e));
}

/// The work budget is spent. All bodies are at the end of the step, and what overlaps is answered there, one island of bodies at a time,
/// as with Resolution/None.
void EventLocator::answer_the_rest(std::size_t left, std::vector<FoundContact>& found)
{
    report_too_many(left);
    queue_.clear(), free_.clear(), chosen_.clear();
    for (std::uint32_t i = 0; i < candidates_.size(); ++i) free_.push_back(i);
    detect_at_end();
    answers_at_end_ = true;
    collect(found);
    answers_at_end_ = false;
    left_islands_.reset(step_.groups.all.size());
    const Bodies& bodies = step_.world.host().bodies;
    const auto join = [&](Ref a, Ref b)
    {
        if (bodies.dynamic(a.index) && bodies.dynamic(b.index)) left_islands_.join(step_.groups.of(a), step_.groups.of(b));
    };
    for (const Entry& e : queue_) join(candidates_[e.slot].a, candidates_[e.slot].b);
    for (const PairState& p : contacts_.cache().pairs())
        if (p.resting) join(p.a, p.b);
    const auto island_of = [&](const Candidate& c) { return left_islands_.find(step_.groups.of(bodies.dynamic(c.a.index) ? c.a : c.b)); };
    std::uint32_t slot = 0;
    while (pop(slot))
    {
        chosen_.assign(1, slot);
        Candidate& first = candidates_[slot];
        first.time = step_.frame.step;
        for (const Entry& e : queue_)
        {
            Candidate& c = candidates_[e.slot];
            if (c.detector != first.detector || !contacts_.detectors()[c.detector].responds || island_of(c) != island_of(first)) continue;
            c.time = step_.frame.step;
            chosen_.push_back(e.slot);
        }
        std::sort(chosen_.begin() + 1, chosen_.end());
        for (const std::uint32_t taken : chosen_) ++candidates_[taken].version;  // out of the queue
        process();
    }
}

void EventLocator::begin_run()
{
    const auto& detectors = contacts_.detectors();
    any_certifies_ = std::any_of(detectors.begin(), detectors.end(), [](const Detector& d) { return d.certifies; });
    all_certify_ = std::all_of(detectors.begin(), detectors.end(), [](const Detector& d) { return d.certifies && !d.spares_crowds; });
    any_at_end_ = std::any_of(detectors.begin(), detectors.end(), [](const Detector& d) { return !d.certifies && !d.persists(); });
    const auto spares = [](const Detector& d) { return d.spares_crowds || !d.locates; };
    all_spare_ = !contacts_.crowded().empty() && std::all_of(detectors.begin(), detectors.end(), spares);
    any_persists_ = std::any_of(detectors.begin(), detectors.end(), [](const Detector& d) { return d.by_rows && d.may_persist(); });
    found_ = pushed_since_ = false;
    meets_force_contact_ = std::any_of(detectors.begin(), detectors.end(), [](const Detector& d) { return d.by_force; });
    begin_budget();
    queue_.clear(), free_.clear(), unpressed_.clear(), met_at_begin_.clear();
    for (std::uint32_t i = 0; i < candidates_.size(); ++i) free_.push_back(i);
    versions_.assign(step_.groups.all.size(), 0);
    met_.assign(step_.world.host().bodies.size(), {});
    if (std::any_of(detectors.begin(), detectors.end(), [](const Detector& d) { return !d.persists(); })) note_resting_groups();
}

void EventLocator::run(std::vector<FoundContact>& found)
{
    const auto& detectors = contacts_.detectors();
    if (std::all_of(detectors.begin(), detectors.end(), [](const Detector& d) { return d.persists(); }))
        return contacts_.detect_all();  // there are no events
    begin_run();
    if (any_certifies_) begin_motion_bounds();
    const bool few = all_spare_ && few_are_apart();
    if (few || any_at_end_) detect_at_end();
    if (few)
        find_near_apart();
    else if (any_certifies_)
        find_near(nullptr);
    if (any_at_end_) collect(found);
    answer_all(found);
    find_at_end();
    if (all_spare_ && budget_.is_too_much_beside_crowds()) contacts_.crowd_all();
}

/// Whether looking for what is near all bodies would cost more than looking for the contacts at the end once more, where there are impacts.
bool EventLocator::few_are_apart() const
{
    const Bodies& bodies = step_.world.host().bodies;
    std::int64_t more_crowded = 0;
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
        if (bodies.dynamic(b)) more_crowded += contacts_.crowded()[b] != 0 ? 1 : -1;
    return more_crowded > 0;
}

void EventLocator::detect_at_end()
{
    contacts_.detect_all();
    found_ = true, pushed_since_ = false;
}

/// Which gaps a manager holds depends on the velocities.
void EventLocator::find_at_end()
{
    if (all_certify_ && !found_)
        contacts_.detect_known_pairs();
    else if (!found_ || (pushed_since_ && any_persists_))
        detect_at_end();
}

/// Answers the events in the order of their times.
void EventLocator::answer_all(std::vector<FoundContact>& found)
{
    std::uint32_t slot = 0;
    while (!step_.frame.give_up() && pop(slot))
    {
        Candidate& c = candidates_[slot];
        if (budget_.is_spent())
        {
            push(slot);
            note_live();
            answer_the_rest(live_.size(), found);
            return;
        }
        if (!c.located)
        {
            locate(c);
            if (c.located && c.nothing)
                free_.push_back(slot);
            else
                push(slot);
            continue;
        }
        gather(slot);
        process();
        for (const std::uint32_t done : chosen_) free_.push_back(done);
        if (rewound_) detect_again(found);
    }
}

}  // namespace plab::simulation
