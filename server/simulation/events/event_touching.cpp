// Pairs that touch already where their search begins. They need care: a body that slides or rests must not produce an event in every
// step, but one that closes, or that forces press into the surface, must. presses() and meets_at_begin() decide from the closing speed and
// the relative normal acceleration. Such an impact is at the beginning; there is no time to search for.
#include <algorithm>

#include "simulation/events/event_locator.h"

namespace plab::simulation
{

/// Handles a pair that overlaps already where the search begins. True if that decides the candidate.
bool EventLocator::settle_at_begin(Candidate& candidate, const DistanceSample& sample)
{
    if (sample.query.gap >= -sample.contact_gap - overlap_tolerance(candidate.a, candidate.b)) return false;
    // There is no time of impact to find: a pair that closes is answered here; one that separates is left alone until the end of the step.
    candidate.time = sample.time;
    candidate.stuck = sample.rate <= 0 || !contacts_.detectors()[candidate.detector].responds;
    candidate.at_end = !candidate.stuck;
    if (candidate.stuck) return true;
    candidate.time = step_.frame.step;
    const DistanceSample last = sample_at(candidate, step_.frame.step);
    candidate.nothing = !(last.query.gap < 0 && last.rate < 0);
    return true;
}

/// Whether the pair has had an impact at exactly this time: a second answer would not separate it either.
bool EventLocator::answered_at(const Candidate& candidate, double time) const
{
    const PairState* pair =
        contacts_.cache().find(contacts_.detectors()[candidate.detector].component, candidate.a, candidate.b, step_.world);
    return pair && pair->impacts_tick == step_.frame.tick && pair->bounces.time == step_.frame.start_time + time;
}

/// Fills in the normal accelerations at the contacts in pressed_, all of one pair, at `time`, where its bodies are.
void EventLocator::accelerations_at_contacts(const Candidate& candidate, double time)
{
    const auto held = [&](Ref r) { return step_.groups.of(r) != kNoIndex && rests_[step_.groups.of(r)] != 0; };
    if (!held(candidate.a) && !held(candidate.b)) return rate_of_approach(pressed_, time, {});
    // A supported body does not fall as forces alone would make it. Its mean acceleration follows from the known end of the step.
    const Bodies& bodies = step_.world.host().bodies;
    const std::uint32_t a = candidate.a.index, b = candidate.b.index;
    // The lever arms move with their bodies but do not rotate: the contact point of a rolling ball rotates away from the ground, yet
    // the gap does not open.
    const Vec3 from_a = bodies.position[a], from_b = bodies.position[b];
    const auto rate = [&](const Contact& c)
    {
        const Vec3 va = bodies.velocity[a] + cross(bodies.angular_velocity[a], c.point - from_a);
        const Vec3 vb = bodies.velocity[b] + cross(bodies.angular_velocity[b], c.point - from_b);
        return dot(vb - va, c.normal);
    };
    for (FoundContact& f : pressed_) f.contact.normal_acceleration = -rate(f.contact);
    advance_groups_to(step_.frame.step);
    for (FoundContact& f : pressed_)
        f.contact.normal_acceleration = (rate(f.contact) + f.contact.normal_acceleration) / (step_.frame.step - time);
    advance_groups_to(time);
}

/// Whether forces press a touching pair together so strongly that it would sink in by more than rounding during the rest of the step.
/// This is asked once per contact time: after the answer the pair is at rest.
bool EventLocator::presses(Candidate& candidate, const DistanceSample& sample)
{
    if (answered_at(candidate, sample.time)) return false;
    const double left = step_.frame.step - sample.time;
    pressed_.assign(1, {});
    Contact& c = pressed_.front().contact;
    c.a = candidate.a, c.b = candidate.b, c.normal = sample.query.normal, c.point = (sample.query.point_a + sample.query.point_b) * 0.5;
    accelerations_at_contacts(candidate, sample.time);
    c.normal_acceleration += dot(met_[c.b.index].relief - met_[c.a.index].relief, c.normal);
    candidate.relief = c.normal * -c.normal_acceleration;
    return candidate.pressed = -0.5 * c.normal_acceleration * left * left > sample.slack;
}

/// Lists in pressed_ the contacts of a pair that touch within rounding and do not separate, with the bodies as they are.
void EventLocator::find_touching(const Candidate& candidate)
{
    const auto deepest = std::max_element(at_end_.begin(), at_end_.end(),
                                          [](const FoundContact& x, const FoundContact& y) { return x.contact.depth < y.contact.depth; });
    const PersistentPair closer{candidate.a, candidate.b, deepest->contact.normal * -rounding_of(candidate.a, candidate.b)};
    pressed_.clear();
    ++step_.report.trials;
    const double before = sweeps_and_queries();
    contacts_.detect(contacts_.detectors()[candidate.detector], candidate.detector, std::span(&closer, 1), true, pressed_);
    budget_.spend(1 + sweeps_and_queries() - before);
    std::erase_if(pressed_,
                  [&](const FoundContact& f)
                  {
                      const Contact& c = f.contact;
                      return contacts_.normal_velocity(c) > kNoGapRate * speeds_at(c.a, c.point, c.b, c.point);
                  });
    sort_contacts(pressed_, step_.world);
}

/// Whether a pair that is clear where its piece begins, at `begin` s, and overlaps at the end of the step, touches there already, and
/// closes or is pressed together by forces. Then it meets at this time, and its contacts are those that touch. Halving would only approach
/// the beginning, down to the resolution of times, and advance in each trial whatever rests on the pair: a stack would take the work of a
/// step for a few of its bodies. The bodies are at `begin`; at_end_ has the contacts at the end of the step.
bool EventLocator::meets_at_begin(Candidate& candidate, double begin)
{
    const double left = step_.frame.step - begin;
    if (!contacts_.detectors()[candidate.detector].responds || !(left > kShortest * step_.frame.step)) return false;
    // What a first answer did not separate, a second one at the same time would not separate either.
    const auto is_this = [&](const PairAtTime& p)
    { return p.time == begin && p.detector == candidate.detector && p.a == candidate.a && p.b == candidate.b; };
    if (std::any_of(met_at_begin_.begin(), met_at_begin_.end(), is_this)) return false;
    find_touching(candidate);
    const auto slack = [&](const Contact& c) { return slack_of(c.a, c.b, speeds_at(c.a, c.point, c.b, c.point)); };
    const auto closes = [&](const FoundContact& f) { return -contacts_.normal_velocity(f.contact) * left > slack(f.contact); };
    const auto sinks = [&](const FoundContact& f) { return -0.5 * f.contact.normal_acceleration * left * left > slack(f.contact); };
    // Surfaces along which the pair only slides do neither.
    bool meets = std::any_of(pressed_.begin(), pressed_.end(), closes);
    if (!meets && !pressed_.empty())
    {
        accelerations_at_contacts(candidate, begin);
        meets = std::any_of(pressed_.begin(), pressed_.end(), sinks);
        // In Painleve's paradox an impact ends the slip however slowly it closes, but it has to close. Here it does not yet.
        for (FoundContact& f : pressed_) contacts_.fill_material(f);
        meets =
            meets && std::none_of(pressed_.begin(), pressed_.end(), [&](const FoundContact& f) { return contacts_.is_paradox(f.contact); });
    }
    if (meets) candidate.contacts = pressed_;
    return meets;
}

}  // namespace plab::simulation
