/// How a body moves over a smooth piece of a step, with bounds on everything in between: what it takes to say that two
/// bodies do not meet before a time, though nobody has looked there.
///
/// For a direction n the width of the gap between two bodies is f(t) = min over their points of n . (p_b - p_a). Points move
/// smoothly, so between two looks
///
///   f(t + s) >= l(s) - E s^2 / 2,            l: each point by its present velocity; l is concave, a support function;
///                                            n fixed in the world or turning with one of the bodies, whatever says more
///   f(t + s) >= chord - (k + E) s (T - s)/2, between looks at t and t + T
///   |p + v s + k s^2/2| - E s^2/2 > R        for the balls around two bodies
///
/// with the relative acceleration k of the centres and a bound E of what other points and forces add. At the time of a
/// first zero nothing has met. Close to a contact the first bound is Newton's method, but never goes too far.
/// Sources: Mirtich, Impulse-based Dynamic Simulation, PhD thesis (1996), 2.3; Zhang, Redon, Lee, Kim, Continuous
/// collision detection for articulated models using Taylor models and temporal culling, SIGGRAPH (2007).
#pragma once

#include "simulation/events/extent.h"

namespace plab::simulation
{

/// Pose and speeds of a body at one time.
struct BodyState
{
    Vec3 position;     ///< p_WC, m
    Quat orientation;  ///< q_WB
    Vec3 velocity;     ///< m/s
    Vec3 spin;         ///< w_WB in W, rad/s

    static BodyState of(const Bodies& bodies, std::uint32_t b)
    {
        return {bodies.position[b], bodies.orientation[b], bodies.velocity[b], bodies.angular_velocity[b]};
    }
};

/// A body between the two ends of a piece. Accelerations are estimated from the ends: exact for constant forces; what a
/// force does faster than the piece is long is not seen.
struct MotionBound
{
    double begin = 0, end = 0;  ///< s, since the start of the step
    BodyState first, last;
    Vec3 acceleration;     ///< m/s^2, constant part: leads from one position to the other
    double deviation = 0;  ///< m/s^2, what the acceleration of C may differ from it
    TurningBound turning;

    Vec3 position_at(double t) const
    {
        const double s = t - begin;
        return first.position + first.velocity * s + acceleration * (0.5 * s * s);
    }
    Vec3 velocity_at(double t) const { return first.velocity + acceleration * (t - begin); }
};
/// Of a dynamic body. `begin` < `end`.
MotionBound motion_bound_of(const Bodies& bodies, std::uint32_t b, const BodyExtent& extent, double begin, const BodyState& first,
                            double end, const BodyState& last);
/// Of a body whose motion is prescribed, or that stands still.
MotionBound prescribed_motion_bound(const BodyExtent& extent, double begin, const BodyState& first, double end, const BodyState& last);

/// m: how far a point of the body gets, over its course, from where it is at its end.
double swept_distance(const MotionBound& motion, const BodyExtent& extent);

/// One of two bodies, or a shape of it, as seen at the time from which a bound is asked.
struct Mover
{
    std::uint32_t body = 0;
    const MotionBound* motion = nullptr;
    const ShapeExtent* extent = nullptr;
    BodyState now;
};

/// Until when two bodies cannot meet. Times in s from `now`; never more than `left`, the rest of the piece.
class Clearance
{
public:
    Clearance(const Bodies& bodies, const Shapes& shapes, const Mover& a, const Mover& b, double left);

    /// By the balls around both. 0 where those overlap.
    double of_balls() const;
    /// By the normal of a half-space, where one of them is one that does not turn. 0 where they overlap.
    double of_half_space() const;
    /// The normal from a to b of the one that is a half-space which does not turn, and how far the other one is from it, m.
    bool find_half_space(Vec3& n, double& gap) const;
    /// m: how far they are apart along n; < 0: their widths overlap.
    double width_along(const Vec3& n) const;
    /// By a direction n from a to b (unit, W), `gap` (m) apart; of bodies that are not convex: along whatever direction. `turn` (rad/s):
    /// how n was seen to turn, if it was; where two edges meet it turns with neither body.
    double along(const Vec3& n, double gap, const Vec3& turn = {}) const;
    /// For bodies that are not convex: `gap` over the largest closing speed in any direction.
    double in_any_direction(double gap) const;
    /// m/s, the largest closing speed along n over the rest of the piece: linear and turning.
    double fastest_closing(const Vec3& n) const;
    /// Whether they were apart for `ago` before now, gap > 0 along n now.
    bool was_clear(const Vec3& n, double gap, double ago, const Vec3& turn = {}) const;

private:
    /// By n, where all of one body lies behind the plane through its point of contact: then their convex hulls are no nearer.
    double of_hulls(const Vec3& n, double gap) const;
    /// Of a ball inside of a bowl or a bore that does not turn: gap'' >= -(v^2 / d + |a|), d from its middle.
    double of_ball_in_round(const Vec3& n, double gap) const;
    double round_radius(const Mover& m) const;
    /// Spin of the frame in which the direction stands still, and how fast widths may bend in it, m/s^2.
    struct Frame
    {
        Vec3 spin;
        double bend = 0;
    };
    Frame world_frame(const Vec3& n) const;
    Frame frame_of(const Mover& mover) const;
    Frame frame_turning(const Vec3& turn) const;
    double quadratic(double gap, double rate, double acceleration) const;
    double by_points(const Vec3& n, double gap, const Vec3& turn) const;
    double by_points_in(const Frame& frame, const Vec3& n, double gap) const;
    double by_chord(const Vec3& n, double gap) const;
    double linear_width(const Frame& frame, const Vec3& n, double gap, double s) const;
    double support_of(const Mover& m, const Quat& q, const Vec3& n) const;
    static double sweep_of(const Mover& m);
    static double sweep_up_of(const Mover& m);

    const Bodies& bodies_;
    const Shapes& shapes_;
    Mover a_, b_;
    double left_;
    Vec3 apart_, speed_, acceleration_;  ///< b's centre seen from a's
    double unsure_ = 0;                  ///< m/s^2, deviations of both centres
    double turning_ = 0;                 ///< m/s, most of points about their centres
    double swirl_ = 0;                   ///< m/s^2, most of points about their centres
};

}  // namespace plab::simulation
