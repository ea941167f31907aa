// Answers an event: the bodies that it affects are advanced to its time, the response applies impulses, and the events are reported.
#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/events/event_locator.h"
#include "simulation/events/zeno.h"

namespace plab::simulation
{
namespace
{

/// Largest number of impacts per step of a pair in which a body is supported by others; then it stops bouncing. The supporting contacts
/// may push the body back as often as it bounces, so the sequence need not end by itself. A bounce that lasts a hundredth of the step
/// rises by at most g h^2 / 8e4, so little is lost.
constexpr std::uint32_t kMostOfHeldPair = 100;
/// Fraction of the closing speed plus the speed that forces give in a step: a pair that has stopped bouncing and separates more slowly
/// than this rests.
constexpr double kStays = 0x1p-24;
/// Rounding error of a position, relative to the bodies' sizes and distances from the origin.
constexpr double kAnswerRounding = 4e-15;
/// A closing speed below this fraction of the two speeds that it is the difference of counts as zero.
constexpr double kStill = 0x1p-30;

}  // namespace

/// Advances a group from the start of its piece to `time`. A group without persistent contacts, and without joints for which it needs a
/// manager, that observes no other group needs only its solver.
void EventLocator::advance_group(std::uint32_t g, double time, WorkBook book, bool trial)
{
    motion_.rewind(g);
    const std::span one(&g, 1);
    const bool alone = rests_[g] == 0 && !advance_.holds_joints_of(g) && step_.groups.all[g].upstream.empty();
    if (alone && !meets_force_contact_)
        motion_.advance_smooth(one, {}, motion_.segment_begin(g), time, book, trial);
    else
        advance_.advance(one, motion_.segment_begin(g), time, book, trial);
}

void EventLocator::advance_scope(double time, WorkBook book, bool trial)
{
    const double before = sweeps_and_queries();
    move_scope(time, book, trial);
    const bool any_rests = std::any_of(scope_.begin(), scope_.end(), [&](std::uint32_t g) { return rests_[g] != 0; });
    if (any_rests)
        budget_.spend(WorkBudget::kGoneThrough * static_cast<double>(step_.groups.all.size() + contacts_.cache().pairs().size()));
    budget_.spend(static_cast<double>(scope_.size()) + sweeps_and_queries() - before);
}

/// Groups whose pieces began at the same time advance together, as those do that rest on one another: alone, each would be solved as if
/// its neighbours could not move. Pieces of a scope begin at different times where a pair is about to meet of which one has been rewound.
/// Kinematic bodies are where each piece begins, as contacts with them are detected there, and move last.
void EventLocator::move_scope(double time, WorkBook book, bool trial)
{
    left_.clear(), kinematic_.clear();
    for (const std::uint32_t g : scope_) (step_.groups.all[g].prescribed_bodies.empty() ? left_ : kinematic_).push_back(g);
    for (std::size_t first = 0, end = 0; first < left_.size(); first = end)
    {
        const double begin = motion_.segment_begin(left_[first]);
        const auto begins = [&](std::uint32_t g) { return motion_.segment_begin(g) == begin; };
        const auto rest = std::stable_partition(left_.begin() + static_cast<std::ptrdiff_t>(first), left_.end(), begins);
        end = static_cast<std::size_t>(rest - left_.begin());
        const std::span<const std::uint32_t> together = std::span(left_).subspan(first, end - first);
        motion_.put_prescribed(kinematic_, begin);
        if (any_certifies_ && std::none_of(together.begin(), together.end(), [&](std::uint32_t g) { return rests_[g] != 0; }))
        {
            for (const std::uint32_t g : together) advance_group(g, time, book, trial);
            continue;
        }
        for (const std::uint32_t g : together) motion_.rewind(g);
        advance_.advance(together, begin, time, book, trial);
    }
    for (const std::uint32_t g : kinematic_) advance_group(g, time, book, trial);
}

/// Puts the groups of the scope to their state at `time`. Both ends of a piece are stored; other times take an advance.
void EventLocator::advance_groups_to(double time)
{
    if (time == step_.frame.step)
    {
        for (const std::uint32_t g : scope_) motion_.restore_end(g);
        return;
    }
    const auto begins = [&](std::uint32_t g)
    {
        return motion_.segment_begin(g) == time && step_.groups.all[g].prescribed_bodies.empty() &&
               step_.groups.all[g].prescribed_shafts.empty();
    };
    if (!std::all_of(scope_.begin(), scope_.end(), begins)) return advance_scope(time, {}, true);
    for (const std::uint32_t g : scope_) motion_.rewind(g);
}

/// Advances the scope from `time`, where a new piece begins, to the end of the step.
void EventLocator::go_on(double time)
{
    if (!any_certifies_)
    {
        const double before = sweeps_and_queries();
        advance_.advance(scope_, time, step_.frame.step, step_.book(), false);
        budget_.spend(static_cast<double>(scope_.size()) + sweeps_and_queries() - before);
        return;
    }
    advance_scope(step_.frame.step, step_.book(), false);
}

/// m: rounding error of the positions of two bodies.
double EventLocator::rounding_of(Ref a, Ref b) const
{
    const Bodies& bodies = step_.world.host().bodies;
    return kAnswerRounding * (smaller_radius(a, b) + length(bodies.position[a.index]) + length(bodies.position[b.index]));
}

void EventLocator::contacts_from_clear_side(Candidate& candidate)
{
    // The contacts were detected on the overlapping side of the bracket. Detect them again at the clear side, where the impulses will act,
    // with the bodies shifted together by no more than the distance across the bracket, so that lever arms and normals fit the state.
    double closing = 0;
    for (const FoundContact& f : candidate.contacts) closing = std::max(closing, std::fabs(contacts_.normal_velocity(f.contact)));
    const double margin = 4 * closing * candidate.bracket + rounding_of(candidate.a, candidate.b);
    const PersistentPair pair{candidate.a, candidate.b, candidate.contacts.front().contact.normal * -margin};
    seen_.clear();
    contacts_.detect(contacts_.detectors()[candidate.detector], candidate.detector, std::span(&pair, 1), true, seen_);
    if (seen_.empty()) return;
    sort_contacts(seen_, step_.world);
    candidate.contacts = seen_;
}

/// Fills in the contact points of a pair that was located by its gap, with the bodies at the time of the event. For a sensor the bodies
/// are put there for the query and back to the end of the step.
void EventLocator::complete(Candidate& candidate)
{
    if (!candidate.certified) return;
    const Detector& detector = contacts_.detectors()[candidate.detector];
    if (!detector.responds) scope_of_pair(candidate), advance_groups_to(candidate.time);
    const Bodies& bodies = step_.world.host().bodies;
    const GapQuery q = measure(candidate, candidate.time).query;
    const double closing = std::fabs(dot(bodies.velocity_at(q.b.index, q.point_b) - bodies.velocity_at(q.a.index, q.point_a), q.normal));
    // Corners that land a rounding error later belong to the same impact, hence the margin.
    const double margin =
        std::max(0.0, q.gap) * 2 + 4 * closing * candidate.bracket + rounding_of(q.a, q.b) + closing * 0x1p-44 * step_.frame.step;
    candidate.contacts.clear();
    detect_pair(candidate, q.normal * -margin, candidate.contacts);
    if (candidate.contacts.empty())
    {
        FoundContact& only = candidate.contacts.emplace_back();
        only.detector = candidate.detector;
        only.contact.a = q.a, only.contact.b = q.b, only.contact.normal = q.normal;
        only.contact.point = (q.point_a + q.point_b) * 0.5, only.contact.depth = -q.gap;
    }
    if (!detector.responds)
        for (const std::uint32_t g : scope_) motion_.restore_end(g);
}

/// Sets the normal accelerations of the contact points under the forces alone, which distinguish bouncing from coming to rest. Velocities
/// are projected onto joints for that: a manager has made them fit where it collected its rows, and bodies have turned since. `book`: where
/// what the projection takes is booked, if the state stays.
void EventLocator::rate_of_approach(std::vector<FoundContact>& contacts, double at, WorkBook book)
{
    accelerated_.clear();
    const Bodies& bodies = step_.world.host().bodies;
    for (const std::uint32_t g : scope_)
    {
        if (step_.groups.all[g].bodies.empty()) continue;
        GroupSystem& system = motion_.system_for(std::span(&g, 1), {});
        if (forces_.any()) forces_.attach(system, std::span(&g, 1));
        system.begin(at, step_.frame.step, book, nullptr);
        system.evaluate(0, 0);
        system.set_extra_forces(nullptr);
        for (std::size_t i = 0; i < system.bodies().size(); ++i)
        {
            const std::uint32_t b = system.bodies()[i];
            const Vec3 w = bodies.angular_velocity[b];
            accelerated_.push_back(
                {b, system.acceleration(i), bodies.inverse_inertia_W(b) * (system.torque(i) - cross(w, bodies.angular_momentum[b]))});
        }
    }
    std::sort(accelerated_.begin(), accelerated_.end(), [](const Accelerated& x, const Accelerated& y) { return x.body < y.body; });
    const auto acceleration = [&](std::uint32_t body, const Vec3& p) -> Vec3
    {
        const auto found = std::lower_bound(accelerated_.begin(), accelerated_.end(), body,
                                            [](const Accelerated& x, std::uint32_t wanted) { return x.body < wanted; });
        if (found == accelerated_.end() || found->body != body) return {};
        // Without w x (w x r): the contact point of a rolling ball rotates away from the ground, but the gap does not open.
        return found->linear + cross(found->spin_up, p - bodies.position[body]);
    };
    for (FoundContact& f : contacts)
        f.contact.normal_acceleration =
            dot(acceleration(f.contact.b.index, f.contact.point) - acceleration(f.contact.a.index, f.contact.point), f.contact.normal);
}

void EventLocator::announce_rest(const FoundContact& f, PairState& pair)
{
    if (!f.contact.resting || pair.resting) return;
    pair.resting = true;
    pair.bounces = {};
    contacts_.resting().add(pair);
    note_resting_groups_of(pair);
    step_.emit(contacts_.contact_event("contact.rest", pair, rest_time_, f.contact, f.contact.impulse));
}

void EventLocator::record(Candidate& candidate, const std::vector<FoundContact>& contacts, double time)
{
    const Detector& detector = contacts_.detectors()[candidate.detector];
    const auto is_own = [&](const FoundContact& f)
    { return f.detector == candidate.detector && f.contact.a == candidate.a && f.contact.b == candidate.b; };
    // The bodies pass one another over a seam (ContactBook::drop_passed).
    if (std::ranges::none_of(contacts, is_own)) return;
    bool added = false;
    PairState& pair = contacts_.cache().get_or_add(detector.component, candidate.a, candidate.b, step_.world, step_.frame.tick, added);
    pair.overlapping = !detector.responds || candidate.at_end;
    for (std::size_t i = 0; i < contacts.size(); ++i)
    {
        const FoundContact& f = contacts[i];
        if (!is_own(f)) continue;
        if (std::exchange(added, false))
        {
            // The impulses are reported by the impact events that follow.
            step_.emit(contacts_.contact_event("contact.begin", pair, time, f.contact));
        }
        pair.normal = f.contact.normal;
        (void)contacts_.cache().contact_of(pair, f.contact.feature);
        if (!detector.responds) continue;
        step_.emit(contacts_.contact_event("contact.impact", pair, time, f.contact, f.contact.impulse));
        if (paradox_[i]) contacts_.report_paradox(f.contact, pair, time);
        announce_rest(f, pair);
    }
}

/// Bodies that touch, and close no faster than forces make them in a step, may be in Painleve's paradox (paradox.h). An impact with a
/// larger closing speed always has a solution, even if the contact jams, so it is not reported as one.
void EventLocator::note_paradoxes()
{
    paradox_.clear();
    for (const FoundContact& f : impact_)
    {
        const Contact& c = f.contact;
        const double rounding = kStill * speeds_at(c.a, c.point, c.b, c.point);
        const bool pressed = contacts_.normal_velocity(c) >= 2 * c.normal_acceleration * step_.frame.step - rounding;
        paradox_.push_back(pressed && contacts_.is_paradox(f.contact) ? 1 : 0);
    }
}

void EventLocator::suppress_resting_bounce(std::vector<FoundContact>& contacts) const
{
    // An answer at the end of the step is late: a resting body seems to arrive with the speed that forces gave it in up to two steps. With
    // restitution it would bounce for ever, so such slow contacts get none.
    for (FoundContact& f : contacts)
        if (f.contact.normal_acceleration < 0 &&
            contacts_.normal_velocity(f.contact) >= 2 * f.contact.normal_acceleration * step_.frame.step)
            f.contact.restitution = 0;
}

void EventLocator::keep_if_it_cannot_leave(Contact& c) const
{
    // The pair overlapped where its piece began: a rebound too slow to get out of the overlap would be answered again and again.
    const double speed = contacts_.normal_velocity(c);
    const double height = std::max(c.depth, overlap_tolerance(c.a, c.b));
    if (speed <= 0 || (c.normal_acceleration < 0 && speed * speed < -2 * c.normal_acceleration * height)) c.resting = true;
    keep_if_it_would_sink(c);
}

/// What presses a link of a mechanism may be other contacts: by itself it would be accelerated away. Such a rebound, answered where the
/// step ends or where its piece begins, would let it sink a bit more in each step.
void EventLocator::keep_if_it_would_sink(Contact& c) const
{
    constexpr double kSoon = 8;  // steps, in which it does not get out of the overlap
    const double h = step_.frame.step;
    if (!(c.normal_acceleration * h * h > overlap_tolerance(c.a, c.b))) return;
    if (contacts_.normal_velocity(c) * kSoon * h < c.depth) c.resting = true;
}

/// Whether the pair's sequence of bounces ends within the step (zeno.h), or has become too long: then restitution is set to zero and
/// the pair comes to rest instead of bouncing. Gives the time at which the sequence ends, s.
bool EventLocator::stop_bouncing(const Candidate& candidate, double time, double& ends)
{
    ends = time;
    const Detector& detector = contacts_.detectors()[candidate.detector];
    PairState* pair = contacts_.cache().find(detector.component, candidate.a, candidate.b, step_.world);
    if (!pair) return false;
    if (pair->impacts_tick != step_.frame.tick) pair->impacts = 0, pair->impacts_tick = step_.frame.tick;
    if (++pair->impacts > kMostOfHeldPair && any_rests_)
    {
        if (pair->impacts == kMostOfHeldPair + 1)
        {
            Event e = contacts_.contact_event("contact.too_many", *pair, time);
            e.message = "more than " + std::to_string(kMostOfHeldPair) + " impacts of one pair in one step; it stops bouncing";
            step_.emit(std::move(e));
        }
        return true;
    }
    if (!candidate.certified) return false;
    note_impact(pair->bounces, time);
    double next = 0, ratio = 0;
    for (const FoundContact& f : impact_)
    {
        if (f.detector != candidate.detector || f.contact.a != candidate.a || f.contact.b != candidate.b) continue;
        const double closing = -contacts_.normal_velocity(f.contact);
        if (!(f.contact.normal_acceleration < 0) || !(closing > 0)) return false;
        next = std::max(next, 2 * f.contact.restitution * closing / -f.contact.normal_acceleration);
        ratio = std::max(ratio, f.contact.restitution);
    }
    const std::optional<double> rest = rest_of_bounces(pair->bounces, next, ratio);
    if (!rest || time + *rest > step_.frame.start_time + step_.frame.step) return false;
    ends = time + *rest;
    Event e = contacts_.contact_event("contact.zeno", *pair, ends);
    e.values = {next, ratio};
    step_.emit(std::move(e));
    return true;
}

/// Answers the chosen pairs, with all groups of the scope at the time of the event:
///   1. The contact points of each pair are completed at this state.
///   2. Persistent contacts of the scope are added, because the impact propagates through them.
///   3. The acceleration along each normal is evaluated, which distinguishes a bounce from coming to rest.
///   4. Pairs whose sequence of bounces ends within the step lose their restitution (zeno.h).
///   5. The response applies impulses to all of these contacts at once; joints are restored (event_joints.cpp).
///   6. The outcome is recorded per pair and reported as events.
void EventLocator::answer()
{
    const Candidate& first = candidates_[chosen_.front()];
    const double time = step_.frame.start_time + first.time;
    const bool at_end = first.at_end;
    impact_.clear();
    for (const std::uint32_t slot : chosen_)
    {
        Candidate& c = candidates_[slot];
        complete(c);
        if (!c.certified && !c.stuck && !c.at_end) contacts_from_clear_side(c);
        impact_.insert(impact_.end(), c.contacts.begin(), c.contacts.end());
    }
    contacts_.drop_passed(impact_);
    const std::size_t own = impact_.size();
    seen_.clear();
    any_rests_ = std::any_of(scope_.begin(), scope_.end(), [&](std::uint32_t g) { return rests_[g] != 0; });
    if (any_rests_) contacts_.touching_pairs_of(scope_, seen_);
    const auto is_chosen = [&](const FoundContact& f)
    {
        return std::any_of(chosen_.begin(), chosen_.end(),
                           [&](std::uint32_t slot) { return candidates_[slot].a == f.contact.a && candidates_[slot].b == f.contact.b; });
    };
    for (FoundContact& f : seen_)
        if (!is_chosen(f)) f.contact.impulse = {}, impact_.push_back(f);
    for (std::size_t i = 0; i < own; ++i) contacts_.fill_material(impact_[i]), impact_[i].contact.impulse = {};
    rate_of_approach(impact_, first.time, step_.book());
    if (at_end) suppress_resting_bounce(impact_);
    stopped_.clear();
    for (const std::uint32_t slot : chosen_)
    {
        double ends = time;
        if (!stop_bouncing(candidates_[slot], time, ends)) continue;
        double stays = 0;
        for (std::size_t i = 0; i < own; ++i)
        {
            Contact& c = impact_[i].contact;
            if (c.a != candidates_[slot].a || c.b != candidates_[slot].b) continue;
            c.restitution = 0;
            stays = std::max(stays, std::fabs(contacts_.normal_velocity(c)) + std::fabs(c.normal_acceleration) * step_.frame.step);
        }
        stopped_.push_back({slot, ends, kStays * stays});
    }
    note_paradoxes();
    respond(first.time);
    log_impact(first.time);
    if (first.stuck)
        for (std::size_t i = 0; i < own; ++i) keep_if_it_cannot_leave(impact_[i].contact);
    if (first.at_end)
        for (std::size_t i = 0; i < own; ++i) keep_if_it_would_sink(impact_[i].contact);
    for (const std::uint32_t slot : chosen_) record_answered(candidates_[slot], time);
    ++step_.report.events;
}

/// Notes the impulses of all points of the impact, at `time` (s since the start of the step).
void EventLocator::log_impact(double time)
{
    ContactLog& log = contacts_.log();
    if (!log.on()) return;
    for (const FoundContact& f : impact_)
        if (!(f.contact.impulse == Vec3{}))
            log.add(f.contact, contacts_.detectors()[f.detector].component, f.contact.depth, time, time, true);
}

/// Records and reports the outcome for a chosen pair, which may have bounced for the last time.
void EventLocator::record_answered(Candidate& candidate, double time)
{
    const std::uint32_t slot = static_cast<std::uint32_t>(&candidate - candidates_.data());
    for (const Stopped& stopped : stopped_)
    {
        if (stopped.slot != slot) continue;
        for (FoundContact& f : impact_)
            if (f.contact.a == candidate.a && f.contact.b == candidate.b && contacts_.normal_velocity(f.contact) <= stopped.stays)
                f.contact.resting = true;
        rest_time_ = stopped.ends;
        record(candidate, impact_, time);
        return;
    }
    rest_time_ = time;
    record(candidate, impact_, time);
}

}  // namespace plab::simulation
