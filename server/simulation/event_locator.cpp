#include "simulation/event_locator.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plab::simulation
{
namespace
{
/// Events in one step of one world before the rest of them is answered at its end, and said so.
constexpr int kMostEvents = 20000;

/// What an event says of a contact: point, normal, impulse, depth (server/docs/step.md).
std::vector<double> values_of(const Contact& c, const Vec3& impulse)
{
    return {c.point.x, c.point.y, c.point.z, c.normal.x, c.normal.y, c.normal.z, impulse.x, impulse.y, impulse.z, c.depth};
}

}  // namespace

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
    bool overlaps = false, approaching = false;
    for (std::size_t i = begin; i < end; ++i)
    {
        overlaps = overlaps || found[i].contact.depth > 0;
        approaching = approaching || (found[i].contact.depth > 0 && s_->normal_velocity(found[i].contact) < 0);
    }
    const PairState* pair = s_->cache_.find(detector.component, first.contact.a, first.contact.b, s_->world_);
    if (!overlaps || !acts(detector, pair, approaching)) return;
    const auto same = [&](const Candidate& c) { return c.detector == first.detector && c.a == first.contact.a && c.b == first.contact.b; };
    if (std::any_of(candidates_.begin(), candidates_.end(), same)) return;
    Candidate c;
    c.detector = first.detector, c.a = first.contact.a, c.b = first.contact.b;
    c.at_end = !detector.locates;
    c.contacts.assign(found.begin() + static_cast<std::ptrdiff_t>(begin), found.begin() + static_cast<std::ptrdiff_t>(end));
    candidates_.push_back(std::move(c));
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

void EventLocator::close_over_resting_pairs()
{
    // Whatever rests on a member goes with it: an impact passes through standing contacts.
    for (bool grown = true; grown;)
    {
        grown = false;
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
    in_scope_.assign(groups, local ? 0 : 1);
    for (const Ref r : {candidate.a, candidate.b})
        if (const std::uint32_t g = s_->groups_.of(r); g != kNoIndex) in_scope_[g] = 1;
    close_over_resting_pairs();
    scope_.clear();
    for (std::uint32_t g = 0; g < groups; ++g)
        if (in_scope_[g]) scope_.push_back(g);
}

double EventLocator::begin_of_scope() const
{
    double begin = 0;
    for (const std::uint32_t g : scope_) begin = std::max(begin, s_->segment_begin_[g]);
    return begin;
}

void EventLocator::advance_scope(double time, WorkBook book, bool trial)
{
    // Pieces that began together advance together; usually all of them did.
    bool together = true;
    for (const std::uint32_t g : scope_) together = together && s_->segment_begin_[g] == s_->segment_begin_[scope_.front()];
    for (const std::uint32_t g : scope_) s_->rewind(g);
    if (together)
        s_->advance(scope_, s_->segment_begin_[scope_.front()], time, book, trial);
    else
        for (const std::uint32_t& g : scope_) s_->advance(std::span(&g, 1), s_->segment_begin_[g], time, book, trial);
}

bool EventLocator::overlaps_at(Candidate& candidate, double time)
{
    advance_scope(time, {}, true);
    ++s_->report_.trials;
    const StandingPair pair{candidate.a, candidate.b, {}};
    seen_.clear();
    s_->detect(s_->detectors_[candidate.detector], candidate.detector, std::span(&pair, 1), true, seen_);
    std::erase_if(seen_, [](const FoundContact& f) { return f.contact.depth <= 0; });
    if (seen_.empty()) return false;
    sort_contacts(seen_, s_->world_);
    candidate.contacts = seen_;
    return true;
}

void EventLocator::bracket(Candidate& candidate, Trial& trial)
{
    const world::Component& c = s_->world_.component(s_->detectors_[candidate.detector].resolution);
    world::Table& table = s_->world_.table_of(s_->detectors_[candidate.detector].resolution);
    StepContext context;
    context.time = s_->frame_.start_time, context.dt = s_->frame_.step, context.tick = s_->frame_.tick, context.events = s_;
    context.component_of_row = table.component_of_row(), context.facet_of_row = table.host_of_row();
    PhaseCall call;
    call.context = &context, call.rows = Rows(&c.row, 1), call.trial = &trial;
    for (;; ++trial.iteration)
    {
        for (const CommandInfo& command : table.type().info.commands)
            if (command.phase == Phase::Locate && command.run) (void)command.run(call, table.rows());
        if (trial.decision != Trial::Decision::Try) return;
        (overlaps_at(candidate, trial.next) ? trial.end : trial.begin) = trial.next;
    }
}

void EventLocator::locate(Candidate& candidate)
{
    candidate.located = true;
    candidate.time = s_->frame_.step;
    if (candidate.at_end) return;
    // Trials need the pair alone, whoever is rewound for its answer: the rest does not feel it.
    scope_of(candidate, true);
    Trial trial;
    trial.begin = begin_of_scope(), trial.end = trial.step = s_->frame_.step;
    for (const FoundContact& f : candidate.contacts) trial.depth = std::max(trial.depth, f.contact.depth);
    at_end_ = candidate.contacts;
    if (!overlaps_at(candidate, trial.begin))
    {
        bracket(candidate, trial);
        candidate.time = trial.begin;
        candidate.bracket = trial.end - trial.begin;
    }
    else
    {
        // Overlapping where the piece begins: nothing to bracket. A pair that closes is answered there; one that parts is
        // left alone until the end of the step.
        const auto closes = [&](const FoundContact& f) { return s_->normal_velocity(f.contact) <= 0; };
        candidate.stuck = std::any_of(candidate.contacts.begin(), candidate.contacts.end(), closes);
        candidate.at_end = !candidate.stuck;
        if (candidate.stuck)
            candidate.time = trial.begin;
        else
            candidate.contacts = at_end_;
    }
    for (const std::uint32_t g : scope_) s_->restore_end(g);
}

void EventLocator::look_from_the_clear_side(Candidate& candidate)
{
    // The contacts were seen a rounding error later: see them where the answer will act, pushed together by no more
    // than the way from there, so that arms and normals fit the state.
    double closing = 0;
    for (const FoundContact& f : candidate.contacts) closing = std::max(closing, std::fabs(s_->normal_velocity(f.contact)));
    const Bodies& bodies = s_->world_.host().bodies;
    const double size = length(bodies.position[candidate.a.index]) + length(bodies.position[candidate.b.index]);
    const double margin = 4 * closing * candidate.bracket + 1e-15 * (1 + size);
    const StandingPair pair{candidate.a, candidate.b, candidate.contacts.front().contact.normal * -margin};
    seen_.clear();
    s_->detect(s_->detectors_[candidate.detector], candidate.detector, std::span(&pair, 1), true, seen_);
    if (seen_.empty()) return;
    sort_contacts(seen_, s_->world_);
    candidate.contacts = seen_;
}

void EventLocator::rate_of_approach(std::vector<FoundContact>& contacts, double at)
{
    // Normal acceleration of the contact points under the forces alone; it tells bouncing from coming to rest.
    GroupSystem& system = s_->system_for(scope_, {});
    system.begin(at, s_->frame_.step, {}, nullptr);
    system.evaluate_here();
    const Bodies& bodies = s_->world_.host().bodies;
    const auto acceleration = [&](std::uint32_t body, const Vec3& p) -> Vec3
    {
        const auto members = system.bodies();
        const auto found = std::find(members.begin(), members.end(), body);
        if (found == members.end()) return {};
        const auto i = static_cast<std::size_t>(found - members.begin());
        const Vec3 w = bodies.angular_velocity[body], r = p - bodies.position[body];
        const Vec3 spin_up = bodies.inverse_inertia_W(body) * (system.torque(i) - cross(w, bodies.angular_momentum[body]));
        // Without w x (w x r): a rolling ball's point turns away from the ground, its gap does not.
        return system.acceleration(i) + cross(spin_up, r);
    };
    for (FoundContact& f : contacts)
        f.contact.normal_acceleration =
            dot(acceleration(f.contact.b.index, f.contact.point) - acceleration(f.contact.a.index, f.contact.point), f.contact.normal);
}

void EventLocator::announce_rest(const FoundContact& f, PairState& pair, double time)
{
    if (!f.contact.resting || pair.resting) return;
    pair.resting = true;
    Event e = s_->contact_event("contact.rest", pair, time);
    e.values = values_of(f.contact, f.contact.impulse);
    s_->emit(std::move(e));
}

void EventLocator::record(Candidate& candidate, const std::vector<FoundContact>& contacts, double time)
{
    const Detector& detector = s_->detectors_[candidate.detector];
    bool added = false;
    PairState& pair = s_->cache_.get_or_add(detector.component, candidate.a, candidate.b, s_->world_, s_->frame_.tick, added);
    pair.overlapping = !detector.responds || candidate.at_end;
    for (const FoundContact& f : contacts)
    {
        if (f.detector != candidate.detector || f.contact.a != candidate.a || f.contact.b != candidate.b) continue;
        if (std::exchange(added, false))
        {
            // Impulses are told by the impacts that follow.
            Event begin = s_->contact_event("contact.begin", pair, time);
            begin.values = values_of(f.contact, {});
            s_->emit(std::move(begin));
        }
        pair.normal = f.contact.normal;
        (void)s_->cache_.contact_of(pair, f.contact.feature);
        if (!detector.responds) continue;
        Event e = s_->contact_event("contact.impact", pair, time);
        e.values = values_of(f.contact, f.contact.impulse);
        s_->emit(std::move(e));
        announce_rest(f, pair, time);
    }
}

void EventLocator::calm(std::vector<FoundContact>& contacts) const
{
    // Answered late, a resting body seems to arrive with the speed that it gathered in up to two steps: that is no bounce.
    for (FoundContact& f : contacts)
        if (f.contact.normal_acceleration < 0 && s_->normal_velocity(f.contact) >= 2 * f.contact.normal_acceleration * s_->frame_.step)
            f.contact.restitution = 0;
}

void EventLocator::keep_if_it_cannot_leave(Contact& c) const
{
    // It overlapped from the start: a rebound that does not clear the overlap would be answered again and again.
    const double speed = s_->normal_velocity(c);
    const double way = std::max(c.depth, kOverlapTolerance);
    if (speed <= 0 || (c.normal_acceleration < 0 && speed * speed < -2 * c.normal_acceleration * way)) c.resting = true;
}

void EventLocator::answer(Candidate& candidate)
{
    const double time = s_->frame_.start_time + candidate.time;
    if (!candidate.stuck && !candidate.at_end && s_->detectors_[candidate.detector].responds) look_from_the_clear_side(candidate);
    impact_ = candidate.contacts;
    if (s_->detectors_[candidate.detector].responds)
    {
        const std::size_t own = impact_.size();
        seen_.clear();
        s_->touching_pairs_of(scope_, seen_);
        for (FoundContact& f : seen_)
            if (!(f.contact.a == candidate.a && f.contact.b == candidate.b)) f.contact.impulse = {}, impact_.push_back(f);
        for (std::size_t i = 0; i < own; ++i) s_->fill_material(impact_[i]), impact_[i].contact.impulse = {};
        rate_of_approach(impact_, candidate.time);
        if (candidate.at_end) calm(impact_);
        s_->respond(impact_, ImpactMode::Impact, 0, {&s_->work_, 1});
        if (candidate.stuck)
            for (std::size_t i = 0; i < own; ++i) keep_if_it_cannot_leave(impact_[i].contact);
    }
    record(candidate, impact_, time);
    ++s_->report_.events;
}

bool EventLocator::process(Candidate& candidate)
{
    scope_of(candidate, true);
    touched_ = in_scope_;
    if (!s_->detectors_[candidate.detector].local && !candidate.at_end) scope_of(candidate, false);
    if (!s_->detectors_[candidate.detector].responds)
    {
        // A sensor disturbs nobody: the time is known, nothing goes back.
        record(candidate, candidate.contacts, s_->frame_.start_time + candidate.time);
        return false;
    }
    if (candidate.at_end)
    {
        // Answered where the step ends: nobody goes back, only speeds change.
        answer(candidate);
        for (const std::uint32_t g : scope_) s_->save_end(g);
        return false;
    }
    // What the pieces booked up to the end of the step is taken back, then booked again in two parts.
    advance_scope(s_->frame_.step, {&s_->work_, -1}, true);
    advance_scope(candidate.time, {&s_->work_, 1}, true);
    for (const std::uint32_t g : scope_) s_->segment_begin_[g] = candidate.time;
    s_->report_.rewinds += static_cast<int>(scope_.size());
    answer(candidate);
    for (const std::uint32_t g : scope_) s_->save_segment(g);
    if (candidate.time < s_->frame_.step) s_->advance(scope_, candidate.time, s_->frame_.step, {&s_->work_, 1}, false);
    for (const std::uint32_t g : scope_) s_->save_end(g);
    return true;
}

void EventLocator::look_again(std::vector<FoundContact>& found)
{
    // Only pairs with a member that went back can have changed; the rest of what was known stands.
    const auto touched = [&](Ref r)
    {
        const std::uint32_t g = s_->groups_.of(r);
        return g != kNoIndex && touched_[g] != 0;
    };
    const auto stale = [&](Ref a, Ref b) { return touched(a) || touched(b); };
    std::erase_if(candidates_, [&](const Candidate& c) { return stale(c.a, c.b); });
    s_->detect_all(found);
    collect(found);
}

void EventLocator::run(std::vector<FoundContact>& found)
{
    s_->detect_all(found);
    candidates_.clear();
    collect(found);
    for (int events = 0; !candidates_.empty(); ++events)
    {
        if (events == kMostEvents)
        {
            Event e;
            e.time = s_->frame_.start_time, e.kind = "contact.too_many", e.severity = Severity::Warning;
            e.component = s_->detectors_[candidates_.front().detector].component;
            e.message = "more than " + std::to_string(kMostEvents) + " events in one step; the rest waits for the next one";
            s_->emit(std::move(e));
            return;
        }
        for (Candidate& c : candidates_)
            if (!c.located) locate(c);
        const auto first = std::min_element(candidates_.begin(), candidates_.end(),
                                            [](const Candidate& x, const Candidate& y) { return x.time < y.time; });
        Candidate chosen = std::move(*first);
        candidates_.erase(first);
        if (process(chosen)) look_again(found);
    }
}

}  // namespace plab::simulation
