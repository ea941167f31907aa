// Candidates of resolutions that certify: motion bounds of all bodies, a broad phase over the swept boxes, and the first lower bounds on
// the times of impact.
#include <algorithm>

#include "simulation/events/event_locator.h"

namespace plab::simulation
{

/// Bounds the motion of each body over the step from its states at both ends (motion_bound.h), and from that how far any of its points can
/// travel. A box that is expanded by this distance contains the body at every time of the step, so two bodies whose expanded boxes do not
/// overlap cannot meet, and the broad phase lists all pairs that may.
void EventLocator::begin_motion_bounds()
{
    const world::HostTables& host = step_.world.host();
    const Bodies& bodies = host.bodies;
    const double step = step_.frame.step;
    // The sizes need no update: the stepper makes a new locator when anything but the motion has changed.
    if (motions_.size() != bodies.size())
    {
        motions_.assign(bodies.size(), {});
        for (std::uint32_t b = 0; b < bodies.size(); ++b) extents_.push_back(extent_of(bodies, host.shapes, b));
        motion_margin_.assign(bodies.size(), 0.0), active_.begin(bodies.size());
    }
    // Nothing is located of crowded bodies.
    const std::span<const std::uint8_t> crowded = all_spare_ ? contacts_.crowded() : std::span<const std::uint8_t>();
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
    {
        motion_margin_[b] = 0;
        if (!crowded.empty() && crowded[b] != 0) continue;
        const BodyState last = BodyState::of(bodies, b);
        if (bodies.motion[b] == Motion::Static)
        {
            motions_[b] = prescribed_motion_bound(extents_[b], 0, last, step, last);
            continue;
        }
        motion_.start().restore_body(step_.world.host(), b);
        const BodyState first = BodyState::of(bodies, b);
        motion_.end().restore_body(step_.world.host(), b);
        motions_[b] = bodies.dynamic(b) ? motion_bound_of(bodies, b, extents_[b], 0, first, step, last)
                                        : prescribed_motion_bound(extents_[b], 0, first, step, last);
        motion_margin_[b] = swept_distance(motions_[b], extents_[b]);
    }
}

void EventLocator::start_pieces(double time)
{
    for (const std::uint32_t g : scope_)
        for (const std::uint32_t b : step_.groups.all[g].bodies)
            motions_[b].begin = time, motions_[b].first = BodyState::of(step_.world.host().bodies, b);
}

void EventLocator::end_pieces()
{
    const Bodies& bodies = step_.world.host().bodies;
    for (const std::uint32_t g : scope_)
        for (const std::uint32_t b : step_.groups.all[g].bodies)
        {
            const MotionBound& c = motions_[b];
            motions_[b] = motion_bound_of(bodies, b, extents_[b], c.begin, c.first, step_.frame.step, BodyState::of(bodies, b));
            motion_margin_[b] = swept_distance(motions_[b], extents_[b]);
        }
}

/// Of those whose trajectory the last answer changed. All others keep the bounds that they have.
void EventLocator::find_near_rewound()
{
    active_.clear();
    for (const std::uint32_t g : disturbed_)
        for (const std::uint32_t b : step_.groups.all[g].bodies) active_.add(b);
    find_near(&active_);
}

/// Of those that are not crowded, whatever moves them. Pairs with crowded bodies, whose expanded boxes are old, are no candidates.
void EventLocator::find_near_apart()
{
    active_.clear();
    for (std::uint32_t b = 0; b < contacts_.crowded().size(); ++b)
        if (contacts_.crowded()[b] == 0) active_.add(b);
    find_near(&active_);
}

/// Makes candidates of all pairs whose expanded boxes overlap, with a body of `among`; null: all.
void EventLocator::find_near(const IndexSet* among)
{
    const Bodies& bodies = step_.world.host().bodies;
    for (std::uint32_t d = 0; d < contacts_.detectors().size(); ++d)
    {
        const Detector& detector = contacts_.detectors()[d];
        if (!detector.certifies) continue;
        near_.clear();
        NearCollector sink(step_.world, motion_margin_, near_);
        contacts_.query(detector, sink, among);
        std::erase_if(near_, [&](const NearCollector::Pair& pair) { return !contacts_.locates(detector, pair.a, pair.b); });
        budget_.spend(WorkBudget::kListedPair * static_cast<double>(near_.size()));
        for (const NearCollector::Pair& pair : near_)
            if (bodies.dynamic(pair.a.index) || bodies.dynamic(pair.b.index)) consider_near(d, pair.a, pair.b);
    }
}

/// Detects the contacts of one pair as if b were displaced by `shift` (m). Only these two bodies are active in the detection, which knows
/// all of them from its broad phase.
void EventLocator::detect_pair(const Candidate& candidate, const Vec3& shift, std::vector<FoundContact>& found)
{
    const Detector& detector = contacts_.detectors()[candidate.detector];
    const PersistentPair pair{candidate.a, candidate.b, shift};
    active_.clear();
    active_.add(candidate.a.index), active_.add(candidate.b.index);
    ContactCollector sink(step_.world, found);
    sink.begin_query(candidate.detector, std::span(&pair, 1), true);
    contacts_.query(detector, sink, &active_);
    step_.report.further_pairs += sink.further_pairs();
    sort_contacts(found, step_.world);
}

/// Queues a pair at a time before which it cannot meet. Most listed pairs never come near one another within the step, and for them bounds
/// by enclosing balls and half-spaces, which need no distance query, are enough: if they cover the rest of the step, the pair is dropped.
void EventLocator::consider_near(std::uint32_t detector, Ref a, Ref b)
{
    // If a piece begins inside the step, the rounding error of its bound is far below this fraction of the acceleration.
    constexpr double kExact = 0x1p-32;
    const MotionBound &ca = motions_[a.index], &cb = motions_[b.index];
    const double begin = std::max(ca.begin, cb.begin), left = step_.frame.step - begin;
    if (!(left > 0)) return;
    const Bodies& bodies = step_.world.host().bodies;
    const Shapes& shapes = step_.world.host().shapes;
    double clear = 0;
    // If one piece began earlier, the position at `begin` follows from its motion bound, provided that its forces are constant.
    const auto is_exact = [&](const MotionBound& c)
    { return c.begin == begin || c.deviation <= kExact * (length(c.acceleration) + length(c.first.velocity) / (c.end - c.begin)); };
    if (is_exact(ca) && is_exact(cb))
    {
        const auto at_begin = [&](std::uint32_t body, const MotionBound& c) {
            return mover(body, {c.position_at(begin), c.first.orientation, c.velocity_at(begin), c.first.spin});
        };
        const Clearance clearance(bodies, shapes, at_begin(a.index, ca), at_begin(b.index, cb), left);
        clear = clearance.of_balls();
        // The orientation is known only at the start of a piece.
        const auto known = [&](std::uint32_t body, const MotionBound& c) { return c.begin == begin || extents_[body].arm == 0; };
        if (known(a.index, ca) && known(b.index, cb)) clear = std::max(clear, clearance.of_half_space());
        if (clear >= left) return;
    }
    const Detector& by = contacts_.detectors()[detector];
    const PairState* pair = contacts_.cache().find(by.component, a, b, step_.world);
    if (pair && (pair->resting || !by.responds)) return;
    const std::uint32_t slot = new_slot();
    Candidate& c = candidates_[slot];
    c.detector = detector, c.a = a, c.b = b;
    c.certified = true;
    c.time = begin + clear;
    c.version = version_of(c);
    push(slot);
}

}  // namespace plab::simulation
