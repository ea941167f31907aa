// How far two bodies are apart, and until when they stay apart, also for bodies of several shapes. A detection measures only the closest
// two shapes. For all other pairs of shapes the host computes a lower bound of their distance: the gap between their projections onto a
// suitable direction (a separating axis). Against planes this is the exact distance.
#include <algorithm>
#include <array>
#include <cmath>

#include "plab/rotation.h"
#include "simulation/events/event_locator.h"
#include "simulation/motion/component_call.h"

namespace plab::simulation
{
namespace
{

/// Face normals of a box: likely separating axes.
std::array<Vec3, 3> face_normals(const Shapes& shapes, const Mover& m)
{
    const ShapeExtent& e = *m.extent;
    if (e.shape == kNoIndex || shapes.geometry[e.shape].kind != GeometryKind::Box) return {};
    const Quat q = m.now.orientation * e.in_body.q;
    return {rotate(q, {1, 0, 0}), rotate(q, {0, 1, 0}), rotate(q, {0, 0, 1})};
}

}  // namespace

/// m/s: sum of the speeds of one point of each body.
double EventLocator::speeds_at(Ref a, const Vec3& point_a, Ref b, const Vec3& point_b) const
{
    const Bodies& bodies = step_.world.host().bodies;
    return length(bodies.velocity_at(a.index, point_a)) + length(bodies.velocity_at(b.index, point_b));
}

double EventLocator::smaller_radius(Ref a, Ref b) const { return contacts_.smaller_radius(a, b); }

/// m: overlaps up to this, and sinking in by up to this in a step, are explained by rounding of positions and velocities.
double EventLocator::slack_of(Ref a, Ref b, double speed) const
{
    const Bodies& bodies = step_.world.host().bodies;
    return 0x1p-46 *
           (smaller_radius(a, b) + length(bodies.position[a.index]) + length(bodies.position[b.index]) + speed * step_.frame.step);
}

/// Whether all contacts overlap, and sink in within a whole step, by rounding only.
bool EventLocator::slides(std::span<const FoundContact> contacts) const
{
    return std::all_of(contacts.begin(), contacts.end(),
                       [&](const FoundContact& f)
                       {
                           const Contact& c = f.contact;
                           const double rate = contacts_.normal_velocity(c),
                                        slack = slack_of(c.a, c.b, speeds_at(c.a, c.point, c.b, c.point));
                           return c.depth <= slack && -rate * step_.frame.step <= slack;
                       });
}

/// Whether two shapes touch, and sink in by no more than rounding in the rest of the step.
bool EventLocator::slides(const Candidate& candidate, const ShapeGap& g, double time) const
{
    const double slack = slack_of(candidate.a, candidate.b, speeds_at(candidate.a, g.point_a, candidate.b, g.point_b));
    const double left = step_.frame.step - time;
    return std::fabs(g.gap) <= slack && left > 0 && clearance_of(candidate, g, left).along(g.normal, slack) >= left;
}

/// The clearance of the two bodies at their present state; the overload below takes one shape of each.
Clearance EventLocator::clearance_of(const Candidate& candidate, double left) const
{
    const Bodies& bodies = step_.world.host().bodies;
    const std::uint32_t a = candidate.a.index, b = candidate.b.index;
    return {bodies, step_.world.host().shapes, mover(a, BodyState::of(bodies, a)), mover(b, BodyState::of(bodies, b)), left};
}

Clearance EventLocator::clearance_of(const Candidate& candidate, const ShapeGap& gap, double left) const
{
    const Bodies& bodies = step_.world.host().bodies;
    Mover a = mover(candidate.a.index, BodyState::of(bodies, candidate.a.index)),
          b = mover(candidate.b.index, BodyState::of(bodies, candidate.b.index));
    a.extent = gap.shape_a, b.extent = gap.shape_b;
    return {bodies, step_.world.host().shapes, a, b, left};
}

/// Tries likely separating axes of two shapes, and returns the one with the widest gap.
EventLocator::ShapeGap EventLocator::gap_of_shapes(const Candidate& candidate, const ShapeExtent& shape_a, const ShapeExtent& shape_b,
                                                   const Vec3& hint) const
{
    const Bodies& bodies = step_.world.host().bodies;
    const Shapes& shapes = step_.world.host().shapes;
    ShapeGap out{&shape_a, &shape_b, -HUGE_VAL, hint, {}, {}, false};
    const Clearance clearance = clearance_of(candidate, out, step_.frame.step);
    const Mover a{candidate.a.index, nullptr, &shape_a, BodyState::of(bodies, candidate.a.index)};
    const Mover b{candidate.b.index, nullptr, &shape_b, BodyState::of(bodies, candidate.b.index)};
    if (Vec3 n; clearance.find_half_space(n, out.gap))
    {
        const bool first = shape_a.is_plane;
        const Mover& solid = first ? b : a;
        out.normal = n, out.exact = true;
        const Vec3 p = solid.now.position + support_point(bodies, shapes, solid.body, *solid.extent, solid.now.orientation, first ? -n : n);
        out.point_a = first ? p - n * out.gap : p, out.point_b = first ? p : p + n * out.gap;
        return out;
    }
    const auto offer = [&](const Vec3& n)
    {
        const double size = length(n);
        if (!(size > 0)) return;
        for (const double sign : {1.0, -1.0})
            if (const double width = clearance.width_along(n * (sign / size)); width > out.gap)
                out.gap = width, out.normal = n * (sign / size);
    };
    offer(hint);
    const auto middle = [&](const Mover& m)
    { return m.now.position + rotate(m.now.orientation, m.extent->in_body.p - bodies.center_B[m.body]); };
    offer(middle(b) - middle(a));
    for (const Mover* m : {&a, &b})
        for (const Vec3& n : face_normals(shapes, *m)) offer(n);
    out.point_a = middle(a), out.point_b = middle(b);
    return out;
}

/// If one of two bodies has several shapes: lists the gaps between all pairs of shapes. The closest pair goes first, with its measured
/// gap.
void EventLocator::list_shape_gaps(const Candidate& candidate, const GapQuery& nearest)
{
    shape_gaps_.clear();
    const BodyExtent &ea = extents_[candidate.a.index], &eb = extents_[candidate.b.index];
    if (ea.shapes.size() <= 1 && eb.shapes.size() <= 1) return;
    std::size_t best = 0;
    double least = HUGE_VAL;
    for (const ShapeExtent& a : ea.shapes)
        for (const ShapeExtent& b : eb.shapes)
        {
            if (a.shape == kNoIndex || b.shape == kNoIndex || (a.is_plane && b.is_plane)) continue;
            ShapeGap& g = shape_gaps_.emplace_back(gap_of_shapes(candidate, a, b, nearest.normal));
            // The measurement does not name its two shapes; they are the ones whose gap along the measured normal equals the measured gap.
            const double width = g.exact ? (g.normal == nearest.normal ? g.gap : HUGE_VAL)
                                         : clearance_of(candidate, g, step_.frame.step).width_along(nearest.normal);
            if (const double off = std::fabs((std::isfinite(width) ? width : g.gap) - nearest.gap); off < least)
                least = off, best = shape_gaps_.size() - 1;
        }
    budget_.spend(0.25 * static_cast<double>(shape_gaps_.size()));
    if (shape_gaps_.empty()) return;
    ShapeGap& g = shape_gaps_[best];
    g.gap = nearest.gap, g.normal = nearest.normal, g.point_a = nearest.point_a, g.point_b = nearest.point_b, g.exact = true;
    std::swap(shape_gaps_.front(), g);
}

/// If one of the two lies on a surface along which it passes the other one, and has reached it: the gap across that surface is what
/// counts. An overlap there within the tolerance is none, and sinking in by as much is no event: rounding alone makes bodies touch that
/// slide over flush tiles.
bool EventLocator::look_over_seam(const Candidate& candidate, GapQuery& query)
{
    if (!contacts_.detectors()[candidate.detector].responds || query.gap > overlap_tolerance(candidate.a, candidate.b)) return false;
    const std::optional<Vec3> across = contacts_.seam_between(candidate.a, candidate.b, {});
    if (!across) return false;
    query.gap = std::max(0.0, clearance_of(candidate, step_.frame.step).width_along(*across)), query.normal = *across;
    shape_gaps_.clear();
    return true;
}

/// Measures the gap of the pair at its present state, at `time`. If the closest shapes just slide along one another, their gap stays zero
/// and hides all others; the pair may meet a plane next to them, so the gap to the nearest such plane is returned.
EventLocator::Measured EventLocator::measure(const Candidate& candidate, double time)
{
    const Detector& detector = contacts_.detectors()[candidate.detector];
    GapQuery query;
    query.a = candidate.a, query.b = candidate.b;
    ComponentCall question(step_, *step_.world.tables()[detector.table], detector.row);
    question.context.events = nullptr, question.arguments.gap = &query;
    (void)question.run(*detector.gap);
    budget_.spend(1 + WorkBudget::kFurtherPair * query.further_pairs);
    list_shape_gaps(candidate, query);
    if (look_over_seam(candidate, query)) return {query, true};
    if (shape_gaps_.empty() || !slides(candidate, shape_gaps_.front(), time)) return {query};
    const ShapeGap* next = nullptr;
    for (const ShapeGap& g : shape_gaps_)
        if (g.exact && (!next || g.gap < next->gap) && !slides(candidate, g, time)) next = &g;
    if (next) query.gap = next->gap, query.point_a = next->point_a, query.point_b = next->point_b, query.normal = next->normal;
    return {query};
}

/// s: time from the last query during which the pair cannot come to overlap by more than `slack` (m). `closing`: bound on the closing
/// speed, m/s.
double EventLocator::clear_for(const Candidate& candidate, const DistanceSample& sample, const Vec3& turn, double slack,
                               double& closing) const
{
    const double left = step_.frame.step - sample.time;
    const Clearance whole = clearance_of(candidate, left);
    closing = whole.fastest_closing(sample.query.normal);
    const double balls = whole.of_balls();
    if (shape_gaps_.empty()) return std::max(balls, whole.along(sample.query.normal, std::max(0.0, sample.query.gap) + slack, turn));
    double clear = left;
    for (const ShapeGap& g : shape_gaps_)
    {
        const Clearance clearance = clearance_of(candidate, g, left);
        // No pair of shapes is closer than the closest one, which is first in the list.
        double of_shapes = std::max(clearance.in_any_direction(std::max(g.gap, shape_gaps_.front().gap)), clearance.of_balls());
        const bool is_nearest = g.normal == sample.query.normal && g.gap == sample.query.gap;
        const double allowed = is_nearest ? slack : std::fabs(g.gap) <= sample.slack ? sample.slack : 0.0;
        const double open = std::max(0.0, g.gap) + allowed;
        if (of_shapes < left && open > 0) of_shapes = std::max(of_shapes, clearance.along(g.normal, open, is_nearest ? turn : Vec3{}));
        clear = std::min(clear, of_shapes);
    }
    return std::max(balls, clear);
}

/// Whether no shapes of the pair can have met between two queries, of which `last` is the later one.
bool EventLocator::was_clear(const Candidate& candidate, const DistanceSample& clear, const DistanceSample& last) const
{
    const double left = step_.frame.step - last.time, ago = last.time - clear.time;
    const Vec3 turn = turn_between(clear, last);
    if (shape_gaps_.empty()) return clearance_of(candidate, left).was_clear(last.query.normal, std::max(last.query.gap, 0.0), ago, turn);
    return std::all_of(
        shape_gaps_.begin(), shape_gaps_.end(),
        [&](const ShapeGap& g)
        {
            const bool is_nearest = g.normal == last.query.normal && g.gap == last.query.gap;
            const double allowed = !is_nearest && std::fabs(g.gap) <= last.slack ? last.slack : 0;
            return clearance_of(candidate, g, left).was_clear(g.normal, std::max(g.gap, 0.0) + allowed, ago, is_nearest ? turn : Vec3{});
        });
}

}  // namespace plab::simulation
