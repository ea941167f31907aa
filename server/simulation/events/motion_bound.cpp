#include "simulation/events/motion_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plab/rotation.h"
#include "plab/surface.h"

namespace plab::simulation
{
namespace
{

constexpr double kNeverMeets = std::numeric_limits<double>::infinity();
/// Safety factor on changes of the acceleration, which are estimated from the two ends of a piece only.
constexpr double kDeviationReserve = 2;

}  // namespace

MotionBound motion_bound_of(const Bodies& bodies, std::uint32_t b, const BodyExtent& extent, double begin, const BodyState& first,
                            double end, const BodyState& last)
{
    MotionBound c{begin, end, first, last, {}, 0, {}};
    const double T = end - begin;
    if (!(T > 0)) return c;
    // x = x0 + v0 T + k T^2/2 defines k. If x were cubic, the speed at the end would differ by j T^2/6 from v0 + k T.
    c.acceleration = (last.position - first.position - first.velocity * T) * (2 / (T * T));
    c.deviation = kDeviationReserve * 4 / T * length(last.velocity - first.velocity - c.acceleration * T);
    const auto momentum = [&](const BodyState& s)
    { return rotate(s.orientation, bodies.inertia_B[b] * rotate_back(s.orientation, s.spin)); };
    c.turning =
        free_turning(extent.principal, extent.arm, {momentum(first), momentum(last)}, {first.spin, last.spin}, T, kDeviationReserve);
    return c;
}

MotionBound prescribed_motion_bound(const BodyExtent& extent, double begin, const BodyState& first, double end, const BodyState& last)
{
    return {begin, end, first, last, {}, 0, steady_turning(first.spin, extent.arm)};
}

double swept_distance(const MotionBound& motion, const BodyExtent& extent)
{
    const double T = motion.end - motion.begin;
    const double bulge = 0.125 * (length(motion.acceleration) + motion.deviation) * T * T;
    const double turned = motion.turning.sweep > 0 ? std::min(2 * extent.arm, motion.turning.sweep * T) : 0;
    return length(motion.last.position - motion.first.position) + bulge + turned;
}

Clearance::Clearance(const Bodies& bodies, const Shapes& shapes, const Mover& a, const Mover& b, double left)
    : bodies_(bodies), shapes_(shapes), a_(a), b_(b), left_(left)
{
    apart_ = b.now.position - a.now.position;
    speed_ = b.now.velocity - a.now.velocity;
    acceleration_ = b.motion->acceleration - a.motion->acceleration;
    for (const Mover* m : {&a_, &b_})
    {
        unsure_ += m->motion->deviation;
        turning_ += sweep_of(*m);
        swirl_ += sweep_up_of(*m);
    }
}

/// m/s, bound on the speed of the mover's points about the body's centre; the bound of a shape is at most that of its body.
double Clearance::sweep_of(const Mover& m)
{
    const TurningBound& t = m.motion->turning;
    return m.extent->arm == 0 || t.spin == 0 ? 0 : std::min(t.sweep, t.spin * m.extent->arm);
}

/// m/s^2, the same bound for the accelerations.
double Clearance::sweep_up_of(const Mover& m)
{
    const TurningBound& t = m.motion->turning;
    return m.extent->arm == 0 || t.spin == 0 ? 0 : std::min(t.sweep_up, (t.spin * t.spin + t.spin_up) * m.extent->arm);
}

/// s: first zero of gap + rate s + acceleration s^2/2, gap >= 0; `left_` if there is none before that.
double Clearance::quadratic(double gap, double rate, double acceleration) const
{
    const double square = rate * rate - 2 * acceleration * gap;
    if (square < 0) return left_;
    const double root = std::sqrt(square);
    // Both forms of the root are equal; each branch uses the one without cancellation.
    double s = left_;
    if (rate < 0)
        s = 2 * gap / (root - rate);
    else if (acceleration < 0)
        s = (rate + root) / -acceleration;
    return std::min(s, left_);
}

double Clearance::of_balls() const
{
    const double R = a_.extent->radius + b_.extent->radius;
    const double distance = length(apart_);
    if (!(distance > R)) return 0;
    // Treat the motion as straight and enlarge the radius by the most that accelerations displace the centres in the time s. The time
    // of entry is a better value for s, so the estimate is repeated with it.
    const double change = length(acceleration_) + unsure_;
    const double v2 = length_squared(speed_), along = dot(apart_, speed_);
    double s = left_;
    for (int pass = 0; pass < 3; ++pass)
    {
        const double grown = R + 0.5 * change * s * s;
        if (!(distance > grown))
        {
            s *= 0.25;
            continue;
        }
        const double c = (distance - grown) * (distance + grown);
        const double square = along * along - v2 * c;
        if (along >= 0 || square < 0) return s;
        const double entry = c / (std::sqrt(square) - along);
        if (entry >= s) return s;
        // With the radius enlarged for s, `entry` is certain; a shorter s gives a smaller radius and a later entry. The last pass returns
        // the certain value.
        if (change * s * s == 0 || pass == 2) return std::min(entry, s);
        s = std::min(s, 1.5 * entry);
    }
    return 0;
}

double Clearance::support_of(const Mover& m, const Quat& q, const Vec3& n) const
{
    return support(bodies_, shapes_, m.body, *m.extent, q, n);
}

Clearance::Frame Clearance::world_frame(const Vec3& n) const
{
    return {{}, std::min(0.0, dot(acceleration_, n) - unsure_ - (turning_ > 0 ? swirl_ : 0))};
}

/// The direction rotates with one of the bodies: in that frame its own points do not move, and the points of the other body have
/// Coriolis and centrifugal accelerations.
Clearance::Frame Clearance::frame_of(const Mover& m) const
{
    const Mover& other = &m == &a_ ? b_ : a_;
    const double w = m.motion->turning.spin, arm = other.extent->is_plane ? 0 : other.extent->arm;
    const double pull = length(acceleration_) + unsure_;
    const double distance = length(apart_) + (length(speed_) + 0.5 * pull * left_) * left_ + arm;
    const double speed = length(speed_) + pull * left_ + (arm > 0 ? sweep_of(other) : 0);
    const double swirl = arm > 0 ? sweep_up_of(other) : 0;
    return {m.now.spin, -(pull + swirl + 2 * w * speed + (w * w + m.motion->turning.spin_up) * distance)};
}

/// Any direction gives a valid bound, also one that rotates at an arbitrary constant rate.
Clearance::Frame Clearance::frame_turning(const Vec3& turn) const
{
    const double w = length(turn), pull = length(acceleration_) + unsure_;
    const double distance = length(apart_) + (length(speed_) + 0.5 * pull * left_) * left_ + a_.extent->arm + b_.extent->arm;
    const double speed = length(speed_) + pull * left_ + turning_;
    return {turn, -(pull + swirl_ + 2 * w * speed + w * w * distance)};
}

/// l(s), m. With n' = W x n in the frame, a point at r from the centre of b approaches with r . ((W - w_b) x n), and a point of a
/// correspondingly. s < 0 gives earlier times.
double Clearance::linear_width(const Frame& frame, const Vec3& n, double gap, double s) const
{
    double width = gap + (dot(speed_, n) + dot(cross(frame.spin, n), apart_)) * s;
    const auto grow = [&](const Mover& m, const Vec3& outward)
    {
        if (m.extent->is_plane || m.extent->arm == 0 || frame.spin == m.now.spin) return;
        const Vec3 turned = outward + cross(frame.spin - m.now.spin, outward) * s;
        width -= support_of(m, m.now.orientation, turned) - support_of(m, m.now.orientation, outward);
    };
    grow(a_, n), grow(b_, -n);
    return width;
}

double Clearance::by_points(const Vec3& n, double gap, const Vec3& turn) const
{
    // A half-space has one separating direction, its normal. If it rotates, the direction rotates with it.
    for (const Mover* m : {&a_, &b_})
        if (m->extent->is_plane && m->motion->turning.spin > 0) return by_points_in(frame_of(*m), n, gap);
    if (turning_ == 0) return quadratic(gap, dot(speed_, n), dot(acceleration_, n) - unsure_);
    double clear = by_points_in(world_frame(n), n, gap);
    // Against a half-space no other direction helps. Otherwise try directions that rotate with a body: for a rotating face its own normal
    // gives the best bound.
    if (a_.extent->is_plane || b_.extent->is_plane) return clear;
    for (const Mover* m : {&a_, &b_})
        if (clear < left_ && m->extent->arm > 0) clear = std::max(clear, by_points_in(frame_of(*m), n, gap));
    if (clear < left_ && turn != Vec3{}) clear = std::max(clear, by_points_in(frame_turning(turn), n, gap));
    return clear;
}

double Clearance::by_points_in(const Frame& frame, const Vec3& n, double gap) const
{
    const auto width = [&](double s) { return linear_width(frame, n, gap, s) + 0.5 * frame.acceleration * s * s; };
    // The width is concave: positive at both ends means positive between them. Otherwise approach its zero from the clear side by
    // bisection and secants.
    double high = left_, at_high = width(high);
    if (at_high > 0) return left_;
    double low = high, at_low = at_high;
    for (int i = 0; i < 60 && !(at_low > 0); ++i)
    {
        high = low, at_high = at_low;
        low *= 0.25, at_low = width(low);
    }
    if (!(at_low > 0)) return 0;
    for (int i = 0; i < 24 && high - low > 1e-9 * high; ++i)
    {
        // The chord of a concave function lies below the function, so its zero is on the clear side.
        const double chord = low + (high - low) * at_low / (at_low - at_high);
        const double middle = 0.5 * (low + high);
        const double at_chord = width(chord);
        if (at_chord > 0)
            low = chord, at_low = at_chord;
        else
            high = chord, at_high = at_chord;
        if (i % 3 != 2 || !(middle > low && middle < high)) continue;
        const double at_middle = width(middle);
        (at_middle > 0 ? low : high) = middle;
        (at_middle > 0 ? at_low : at_high) = at_middle;
    }
    return low;
}

double Clearance::by_chord(const Vec3& n, double gap) const
{
    // Width along the same n at the end of the piece.
    const Vec3 end_a = a_.motion->last.position, end_b = b_.motion->last.position;
    double width = gap + dot((end_b - end_a) - apart_, n);
    const auto grow = [&](const Mover& m, const Vec3& outward)
    {
        if (m.extent->is_plane || m.extent->arm == 0 || m.motion->last.orientation == m.now.orientation) return;
        width -= support_of(m, m.motion->last.orientation, outward) - support_of(m, m.now.orientation, outward);
    };
    grow(a_, n), grow(b_, -n);
    const double acceleration = std::max(0.0, dot(acceleration_, n) + unsure_ + swirl_);
    // gap + (width - gap) s/T - acceleration s (T - s)/2
    return quadratic(gap, (width - gap) / left_ - 0.5 * acceleration * left_, acceleration);
}

double Clearance::along(const Vec3& n, double gap, const Vec3& turn) const
{
    const bool has_plane = a_.extent->is_plane || b_.extent->is_plane;
    if (!has_plane && !(a_.extent->convex && b_.extent->convex))
        return std::max({in_any_direction(gap), of_hulls(n, gap), of_ball_in_round(n, gap)});
    const double open = std::max(0.0, gap);
    const bool plane_turns = (a_.extent->is_plane && a_.motion->turning.spin > 0) || (b_.extent->is_plane && b_.motion->turning.spin > 0);
    return std::max(by_points(n, open, turn), open > 0 && !plane_turns ? by_chord(n, open) : 0.0);
}

double Clearance::of_hulls(const Vec3& n, double gap) const
{
    const double to_a = support_of(a_, a_.now.orientation, n), to_b = support_of(b_, b_.now.orientation, -n), apart = dot(n, apart_);
    const double width = apart - to_a - to_b;
    if (!(width >= gap - 4e-16 * (std::fabs(apart) + std::fabs(to_a) + std::fabs(to_b)))) return 0;
    const double open = std::max(0.0, gap);
    return std::max(by_points_in(world_frame(n), n, open), open > 0 ? by_chord(n, open) : 0.0);
}

double Clearance::of_ball_in_round(const Vec3& n, double gap) const
{
    const bool first = round_radius(a_) > 0;
    const Mover &round = first ? a_ : b_, &ball = first ? b_ : a_;
    const double radius = round_radius(round);
    if (radius == 0 || ball.extent->arm > 0 || round.motion->turning.spin > 0) return 0;
    // The distance from the centre has a second derivative of at most v^2 / distance. As long as the ball travels less than a tenth of
    // the distance, that value changes little (the factor 0.9).
    const double distance = radius - ball.extent->radius - gap, pull = length(acceleration_) + unsure_;
    const double speed = length(speed_) + pull * left_;
    if (!(distance > 0)) return 0;
    const double near = speed > 0 ? std::min(left_, 0.1 * distance / speed) : left_;
    return std::min(near, quadratic(std::max(0.0, gap), dot(speed_, n), -(speed * speed / (0.9 * distance) + pull)));
}

double Clearance::round_radius(const Mover& m) const
{
    if (bodies_.shapes[m.body].size() != 1) return 0;
    const Geometry& g = shapes_.geometry[bodies_.shapes[m.body].front().index];
    const Surface surface = surface_of(g);
    return surface == Surface::Bowl || surface == Surface::Bore ? surface_radius(g) : 0;
}

double Clearance::in_any_direction(double gap) const
{
    if (!(gap > 0)) return 0;
    const double turning = std::isfinite(turning_) ? turning_ : 0;
    return quadratic(gap, -(length(speed_) + turning), -(length(acceleration_) + unsure_));
}

double Clearance::fastest_closing(const Vec3& n) const
{
    const double pull = std::max(0.0, -dot(acceleration_, n)) + unsure_;
    return std::max(0.0, -dot(speed_, n)) + pull * left_ + turning_;
}

bool Clearance::was_clear(const Vec3& n, double gap, double ago, const Vec3& turn) const
{
    if (turning_ > 0 && !(a_.extent->convex && b_.extent->convex)) return false;
    const auto was = [&](const Frame& frame) { return linear_width(frame, n, gap, -ago) + 0.5 * frame.acceleration * ago * ago > 0; };
    for (const Mover* m : {&a_, &b_})
        if (m->extent->is_plane && m->motion->turning.spin > 0) return was(frame_of(*m));
    if (was(world_frame(n)) || a_.extent->is_plane || b_.extent->is_plane) return was(world_frame(n));
    return (a_.extent->arm > 0 && was(frame_of(a_))) || (b_.extent->arm > 0 && was(frame_of(b_))) || was(frame_turning(turn));
}

double Clearance::of_half_space() const
{
    Vec3 n;
    double gap = 0;
    return find_half_space(n, gap) && gap > 0 ? along(n, gap) : 0;
}

double Clearance::width_along(const Vec3& n) const
{
    if (a_.extent->is_plane || b_.extent->is_plane) return -kNeverMeets;
    return dot(apart_, n) - support_of(a_, a_.now.orientation, n) - support_of(b_, b_.now.orientation, -n);
}

bool Clearance::find_half_space(Vec3& n, double& gap) const
{
    const bool first = a_.extent->is_plane;
    const Mover &flat = first ? a_ : b_, &solid = first ? b_ : a_;
    if (!flat.extent->is_plane || solid.extent->is_plane || flat.motion->turning.spin > 0 || solid.extent->radius == 0) return false;
    const Pose& X = flat.extent->in_body;
    const Vec3 up = rotate(flat.now.orientation * X.q, Vec3{0, 0, 1});
    const Vec3 on_it = flat.now.position + rotate(flat.now.orientation, X.p - bodies_.center_B[flat.body]);
    gap = dot(solid.now.position - on_it, up) - support_of(solid, solid.now.orientation, -up);
    n = first ? up : -up;
    return true;
}

}  // namespace plab::simulation
