// Finds the time within its piece at which a pair meets. There are two ways:
//   - locate() with a bracket: the pair is clear at the start of the piece and overlaps at the end of the step; the resolution (a
//     bisection, for instance) says which time to try next.
//   - search() by conservative advancement from the clear side: each distance query gives a time span in which nothing can meet
//     (motion_bound.h), and the pair is advanced by that span until the gap is zero within rounding. As soon as a sample overlaps, the
//     two last samples are a bracket.
// Pairs that touch where their search begins: event_touching.cpp.
#include <algorithm>
#include <cmath>
#include <limits>

#include "simulation/events/event_locator.h"
#include "simulation/motion/component_call.h"

namespace plab::simulation
{
namespace
{

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
/// m: a gap of exactly 0 counts as an overlap; a resolution distinguishes the two by the sign, so it gets this much below 0.
constexpr double kNothing = 1e-300;
/// If a pair touches and does not close, and no bound says for how long it stays so, it is advanced by this fraction of the rest of the
/// piece without a guarantee; twice as far each time, so that the end of the piece is reached after about twenty queries.
constexpr double kUncertified = 0x1p-20;
/// Number of advancement steps towards a contact before the end of the piece is sampled, to find a bracket.
constexpr int kFirstSteps = 4;

/// What slides over a seam and sinks in by no more than this in the rest of the step, as a fraction of the overlap that is tolerated, is
/// not an event: far more than rounding explains, and far too little to be seen.
constexpr double kSeamSlack = 0x1p-10;

}  // namespace

double EventLocator::begin_of_scope() const
{
    double begin = 0;
    for (const std::uint32_t g : scope_) begin = std::max(begin, motion_.segment_begin(g));
    return begin;
}

bool EventLocator::overlaps_at(Candidate& candidate, double time)
{
    advance_scope(time, {}, true);
    ++step_.report.trials;
    const PersistentPair pair{candidate.a, candidate.b, {}};
    seen_.clear();
    const double before = sweeps_and_queries();
    contacts_.detect(contacts_.detectors()[candidate.detector], candidate.detector, std::span(&pair, 1), true, seen_);
    budget_.spend(1 + sweeps_and_queries() - before);
    std::erase_if(seen_, [&](const FoundContact& f) { return f.contact.depth <= candidate.ignored; });
    if (contacts_.passes_over(seen_)) seen_.clear();
    if (seen_.empty()) return false;
    sort_contacts(seen_, step_.world);
    candidate.contacts = seen_;
    return true;
}

namespace
{

/// A resolution may choose a time beyond the bracket, where a bound on the speed of approach was too small: no body is to be moved there.
void keep_within(EventBracket& trial)
{
    if (!(trial.next > trial.begin && trial.next < trial.end)) trial.next = trial.begin + 0.5 * (trial.end - trial.begin);
}

}  // namespace

void EventLocator::ask(const Candidate& candidate, EventBracket& trial)
{
    const std::uint32_t resolution = contacts_.detectors()[candidate.detector].resolution;
    ComponentCall question(step_, resolution);
    question.arguments.trial = &trial;
    const CostScope scope(step_.meter, step_.meter.of_component(resolution));
    question.run(Phase::Locate);
}

void EventLocator::bracket(Candidate& candidate, EventBracket& trial)
{
    for (;; ++trial.iteration)
    {
        ask(candidate, trial);
        if (trial.decision != EventBracket::Decision::Try || budget_.is_spent() || step_.frame.give_up()) return;
        keep_within(trial);
        (overlaps_at(candidate, trial.next) ? trial.end : trial.begin) = trial.next;
    }
}

void EventLocator::locate(Candidate& candidate)
{
    candidate.located = true;
    if (candidate.certified) return search(candidate);
    candidate.time = step_.frame.step;
    if (candidate.at_end) return;
    // Trials advance the groups of the pair only, whatever is rewound for the answer: the others are not affected by them.
    scope_of_pair(candidate);
    EventBracket trial;
    trial.begin = begin_of_scope(), trial.end = trial.step = step_.frame.step;
    trial.gap_begin = trial.gap_end = trial.rate_begin = trial.rate_end = kUnknown;
    for (const FoundContact& f : candidate.contacts) trial.depth = std::max(trial.depth, f.contact.depth);
    at_end_ = candidate.contacts;
    bool overlaps = overlaps_at(candidate, trial.begin);
    if (overlaps && slides(candidate.contacts))
    {
        // The surface along which the pair slides causes no event, but other shapes of the two bodies may.
        for (const FoundContact& f : candidate.contacts) candidate.ignored = std::max(candidate.ignored, f.contact.depth);
        overlaps = false;
        candidate.contacts = at_end_;
    }
    if (!overlaps)
    {
        candidate.at_begin = meets_at_begin(candidate, trial.begin);
        if (candidate.at_begin)
            trial.end = trial.begin;
        else
            bracket(candidate, trial);
        candidate.time = trial.begin;
        candidate.bracket = trial.end - trial.begin;
    }
    else
    {
        // Overlapping where the piece begins: there is no bracket. A pair that closes is answered there; one that separates is left alone
        // until the end of the step.
        const auto closes = [&](const FoundContact& f) { return contacts_.normal_velocity(f.contact) <= 0; };
        candidate.stuck = std::any_of(candidate.contacts.begin(), candidate.contacts.end(), closes);
        candidate.at_end = !candidate.stuck;
        if (candidate.stuck)
            candidate.time = trial.begin;
        else
            candidate.contacts = at_end_;
    }
    for (const std::uint32_t g : scope_) motion_.restore_end(g);
    candidate.located = !budget_.is_spent();
}

/// The scope of trials: the pair's own groups, and what rests on them.
void EventLocator::scope_of_pair(const Candidate& candidate)
{
    scope_.clear();
    const std::uint32_t ga = step_.groups.of(candidate.a), gb = step_.groups.of(candidate.b);
    const auto rests = [&](std::uint32_t g) { return g != kNoIndex && rests_[g] != 0; };
    if (!rests(ga) && !rests(gb))
    {
        for (const std::uint32_t g : {std::min(ga, gb), std::max(ga, gb)})
            if (g != kNoIndex && (scope_.empty() || scope_.back() != g)) scope_.push_back(g);
        return;
    }
    in_scope_.begin(step_.groups.all.size());
    scope_of(candidate);
    in_scope_.sort();
    scope_ = in_scope_.members();
}

EventLocator::DistanceSample EventLocator::sample_at(const Candidate& candidate, double time)
{
    advance_groups_to(time);
    ++step_.report.trials;
    DistanceSample sample;
    sample.time = time;
    const Measured measured = measure(candidate, time);
    sample.query = measured.query;
    const Bodies& bodies = step_.world.host().bodies;
    const GapQuery& q = sample.query;
    const Vec3 va = bodies.velocity_at(q.a.index, q.point_a), vb = bodies.velocity_at(q.b.index, q.point_b);
    sample.rate = dot(vb - va, q.normal);
    sample.speed = length(va) + length(vb);
    // Rounding of the positions, plus the distance covered in the shortest time that can be resolved.
    const double size = length(bodies.position[q.a.index]) + length(bodies.position[q.b.index]) + length(q.point_a - q.point_b);
    sample.contact_gap = 4e-16 * size + 2e-16 * length(bodies.position[q.b.index] - bodies.position[q.a.index]) +
                         0x1p-50 * step_.frame.step * std::fabs(sample.rate);
    sample.slack = slack_of(q.a, q.b, sample.speed);
    if (measured.over_seam) sample.slack = std::max(sample.slack, kSeamSlack * overlap_tolerance(q.a, q.b));
    return sample;
}

/// rad/s: angular velocity of the normal between one distance query and a later one.
Vec3 EventLocator::turn_between(const DistanceSample& first, const DistanceSample& then)
{
    return cross(first.query.normal, then.query.normal) / (then.time - first.time);
}

/// Lets the resolution find the zero of the gap between a clear and an overlapping sample. With `certify` it succeeds only if the pair is
/// certain not to have met earlier.
bool EventLocator::settle_in_bracket(Candidate& candidate, const DistanceSample& clear, const DistanceSample& over, bool certify)
{
    EventBracket trial;
    trial.begin = clear.time, trial.end = over.time, trial.step = step_.frame.step;
    trial.gap_begin = clear.query.gap, trial.rate_begin = clear.rate;
    trial.gap_end = std::min(over.query.gap, -kNothing), trial.rate_end = over.rate;
    trial.depth = -over.query.gap, trial.closing = -over.rate;
    trial.last = clear.time, trial.last_gap = clear.query.gap, trial.last_rate = clear.rate;
    DistanceSample low = clear;
    for (;; ++trial.iteration)
    {
        ask(candidate, trial);
        if (trial.decision != EventBracket::Decision::Try || budget_.is_spent() || step_.frame.give_up()) break;
        keep_within(trial);
        const DistanceSample sample = sample_at(candidate, trial.next);
        trial.last = sample.time, trial.last_gap = sample.query.gap, trial.last_rate = sample.rate;
        if (sample.query.gap > 0)
            low = sample, trial.begin = sample.time, trial.gap_begin = sample.query.gap, trial.rate_begin = sample.rate;
        else
            trial.end = sample.time, trial.gap_end = std::min(sample.query.gap, -kNothing), trial.rate_end = sample.rate;
    }
    candidate.time = trial.begin;
    candidate.bracket = trial.end - trial.begin;
    if (!certify || trial.begin == clear.time) return true;
    return was_clear(candidate, clear, sample_at(candidate, trial.begin));
}

/// The resolution gave up: only an overlap at the end of the step is known then.
bool EventLocator::found_when_given_up(Candidate& candidate, const DistanceSample& sample)
{
    const DistanceSample last = sample_at(candidate, step_.frame.step);
    if (!(last.query.gap < -last.contact_gap)) return false;
    candidate.time = sample.time, candidate.bracket = last.time - sample.time;
    return settle_in_bracket(candidate, sample, last, false);
}

void EventLocator::search(Candidate& candidate)
{
    scope_of_pair(candidate);
    candidate.nothing = !meets(candidate);
    candidate.located = !budget_.is_spent();
    for (const std::uint32_t g : scope_) motion_.restore_end(g);
}

/// Whether the pair meets, as far as the present sample decides it; empty: not decided, the pair has to be advanced.
std::optional<bool> EventLocator::decide_now(Candidate& candidate, Advancement& a)
{
    const DistanceSample& sample = a.sample;
    const double step = step_.frame.step, left = step - sample.time;
    const bool responds = contacts_.detectors()[candidate.detector].responds;
    a.touches = sample.query.gap <= sample.contact_gap, a.separates = sample.rate > kNoGapRate * sample.speed;
    const bool closes = sample.rate < -kNoGapRate * sample.speed;
    if (a.touches && (!responds || (closes && !(left > 0 && -sample.rate * left <= sample.slack)))) return true;
    if (!(left > 0)) return false;
    // A pair that touches a body which the present event stops may be stopped with it.
    if (a.touches && !met_bodies_.empty() && !a.separates && presses(candidate, sample)) return true;
    // Sliding along one another for the rest of the step is not an event.
    a.clear = clear_for(candidate, sample, a.turn, a.touches ? sample.slack : 0.0, a.trial.closing);
    if (sample.time + a.clear >= step)
    {
        if (a.touches && responds) unpressed_.push_back({candidate.detector, candidate.a, candidate.b, sample.time, candidate.version});
        return false;
    }
    // A pair that separates and comes back meets at a gap of 0, not a rounding error below it, so the bound for its return has no slack.
    if (a.touches) a.clear = clear_for(candidate, sample, a.turn, 0.0, a.trial.closing);
    // It is closing, and the remaining time is shorter than times can be resolved: this is the impact.
    if (!a.touches && a.clear < kShortest * step && sample.rate < 0) return true;
    // A pair that separates is advanced further; so is one that no force presses together, although no bound excludes that it sinks in.
    if (a.touches && !a.separates && presses(candidate, sample)) return true;
    if (a.touches) extend_uncertified(a);
    return {};
}

/// Extends the time in which the pair is taken to be clear beyond what the bound guarantees.
void EventLocator::extend_uncertified(Advancement& a) const
{
    a.clear = std::max(a.clear, std::min(a.uncertified, 1.0) * (step_.frame.step - a.sample.time));
    a.uncertified *= 2;
}

/// Fills the question to the resolution: the present sample as the clear end of a bracket, and an overlap at the end of the step, if there
/// is one, as the other end.
void EventLocator::fill_trial(const Candidate& candidate, Advancement& a)
{
    const DistanceSample& sample = a.sample;
    EventBracket& trial = a.trial;
    if (trial.iteration == kFirstSteps) a.at_end = sample_at(candidate, step_.frame.step);
    a.bracketed = trial.iteration >= kFirstSteps && a.at_end.query.gap < -a.at_end.contact_gap;
    trial.begin = sample.time, trial.gap_begin = std::max(sample.query.gap, 0x1p-60 * sample.contact_gap);
    trial.rate_begin = -trial.gap_begin / std::max(a.clear, 0x1p-60 * step_.frame.step);
    trial.gap_end = a.bracketed ? a.at_end.query.gap : kUnknown, trial.rate_end = a.bracketed ? a.at_end.rate : kUnknown;
    trial.last = sample.time, trial.last_gap = sample.query.gap, trial.last_rate = sample.rate;
}

/// Lets the resolution choose the next time of a pair that does not touch. Decides if the resolution accepts, gives up, or jumps to its
/// estimate of the zero and finds the impact there.
std::optional<bool> EventLocator::choose_time(Candidate& candidate, Advancement& a)
{
    const DistanceSample& sample = a.sample;
    ask(candidate, a.trial);
    if (a.trial.decision == EventBracket::Decision::Accept)
    {
        // A pair that separates has no impact, however narrow its gap still is: go on.
        if (!contacts_.detectors()[candidate.detector].responds || sample.rate < 0) return true;
        extend_uncertified(a);
        a.trial.next = sample.time + a.clear;
    }
    if (a.trial.decision == EventBracket::Decision::GiveUp) return found_when_given_up(candidate, sample);
    // With a known overlap ahead, the resolution may jump to its estimate of the zero.
    const bool may_jump = a.bracketed && (a.trial.iteration & 7) == kFirstSteps;
    if (may_jump && a.trial.next > sample.time + a.clear && settle_in_bracket(candidate, sample, a.at_end, true)) return true;
    return {};
}

/// Conservative advancement: measure, decide, advance by the time that is certain to be clear, and again.
bool EventLocator::meets(Candidate& candidate)
{
    Advancement a;
    a.uncertified = kUncertified;
    a.trial.end = a.trial.step = step_.frame.step;
    a.sample = sample_at(candidate, candidate.time);
    if (settle_at_begin(candidate, a.sample)) return !candidate.nothing;
    for (; !budget_.is_spent(); ++a.trial.iteration)
    {
        if (step_.frame.give_up()) return false;
        candidate.time = a.sample.time;
        if (const auto decided = decide_now(candidate, a)) return *decided;
        fill_trial(candidate, a);
        if (a.touches)
            a.trial.next = a.sample.time + a.clear;
        else if (const auto decided = choose_time(candidate, a))
            return *decided;
        const double next = std::min(a.trial.next, a.sample.time + a.clear);
        // The next time is not distinguishable from the present one; a pair that separates here is left to the next step.
        if (!(next > a.sample.time)) return !a.separates;
        const DistanceSample ahead = sample_at(candidate, std::min(next, step_.frame.step));
        // The bound relies on estimated accelerations, so an overlap is possible after all. Then the two samples are a bracket.
        if (ahead.query.gap < -ahead.contact_gap) return settle_in_bracket(candidate, a.sample, ahead, false);
        a.turn = turn_between(a.sample, ahead);
        a.sample = ahead;
    }
    return false;
}

}  // namespace plab::simulation
