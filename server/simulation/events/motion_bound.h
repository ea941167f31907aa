/// Bounds on the motion of a body over a smooth piece of a step, and conservative advancement with them: until what time are two bodies
/// certain not to meet, without testing the times in between?
///
/// Two convex bodies are apart as long as a direction n exists along which they are separated. The width of the gap along n is
///   f(t) = min over the points of both bodies of n . (p_b - p_a),
/// a difference of support functions. Given one distance query at t (normal n, gap f(t) > 0), and bounds on the accelerations of all
/// points, f is bounded from below for the rest of the piece, and the first zero of the bound is a time before which nothing meets:
///
///   f(t + s) >= l(s) - E s^2 / 2             l(s): the width if each point went on with its present velocity. l is concave, as it is
///                                            a minimum of linear functions. n is fixed in the world or turns with one of the bodies;
///                                            each choice gives a valid bound, and the largest one is taken.
///   f(t + s) >= chord - (k + E) s (T - s)/2  chord: linear interpolation between the widths at t and at t + T, the end of the piece.
///   |p + v s + k s^2/2| - E s^2/2 > R        bounding spheres: p, v = relative position and velocity of the centres, R = sum of radii.
///
/// k is the relative acceleration of the centres, and E bounds what other points (rotation) and changes of the forces add to it.
/// The locator advances both bodies to that zero, queries the distance again, and repeats. Close to a contact the first bound becomes
/// Newton's method for the time of impact, with quadratic convergence, but it never steps beyond the impact.
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

/// The motion of a body between the two ends of a piece. Accelerations are estimated from the states at both ends. This is exact for
/// constant forces; a force that varies on a shorter time scale than the piece is not captured.
struct MotionBound
{
    double begin = 0, end = 0;  ///< s, since the start of the step
    BodyState first, last;
    Vec3 acceleration;     ///< m/s^2, constant part: the one that leads from the first position to the last
    double deviation = 0;  ///< m/s^2, bound on how far the acceleration of the centre of mass C differs from it
    TurningBound turning;

    Vec3 position_at(double t) const
    {
        const double s = t - begin;
        return first.position + first.velocity * s + acceleration * (0.5 * s * s);
    }
    Vec3 velocity_at(double t) const { return first.velocity + acceleration * (t - begin); }
};
/// The bound for a dynamic body. Times in s since the start of the step; `begin` < `end`.
MotionBound motion_bound_of(const Bodies& bodies, std::uint32_t b, const BodyExtent& extent, double begin, const BodyState& first,
                            double end, const BodyState& last);
/// The bound for a kinematic or static body.
MotionBound prescribed_motion_bound(const BodyExtent& extent, double begin, const BodyState& first, double end, const BodyState& last);

/// m: the largest distance that a point of the body has, during the piece, from its position at the end of the piece.
double swept_distance(const MotionBound& motion, const BodyExtent& extent);

/// One of two bodies, or a shape of it, with its state at the time from which the bound starts.
struct Mover
{
    std::uint32_t body = 0;
    const MotionBound* motion = nullptr;
    const ShapeExtent* extent = nullptr;
    BodyState now;
};

/// Computes until when two bodies cannot meet. Times in s from `now`; never more than `left`, the rest of the piece.
class Clearance
{
public:
    Clearance(const Bodies& bodies, const Shapes& shapes, const Mover& a, const Mover& b, double left);

    /// By the bounding spheres of both. 0 if those overlap.
    double of_balls() const;
    /// By the normal of a half-space, if one of the two is a half-space that does not rotate. 0 if they overlap.
    double of_half_space() const;
    /// If one of the two is a half-space that does not rotate: its normal, from a to b, and the distance of the other one from it, m.
    bool find_half_space(Vec3& n, double& gap) const;
    /// m: the gap between their projections onto n; < 0: the projections overlap.
    double width_along(const Vec3& n) const;
    /// By a direction n from a to b (unit, W) along which they are `gap` (m) apart. For bodies that are not convex the gap is taken as a
    /// distance, whatever the direction. `turn` (rad/s): angular velocity of n as measured between two queries, if known; the normal of
    /// two edges turns with neither body.
    double along(const Vec3& n, double gap, const Vec3& turn = {}) const;
    /// For bodies that are not convex: `gap` (m) divided by the largest closing speed in any direction, accelerations included.
    double in_any_direction(double gap) const;
    /// m/s, bound on the closing speed along n over the rest of the piece, translation and rotation together.
    double fastest_closing(const Vec3& n) const;
    /// Whether they are certain to have been apart during the last `ago` s, given a gap (m) > 0 along n now.
    bool was_clear(const Vec3& n, double gap, double ago, const Vec3& turn = {}) const;

private:
    /// By n, if the measured gap is also the gap of the projections onto n: then the convex hulls are as far apart as the bodies.
    double of_hulls(const Vec3& n, double gap) const;
    /// For a ball inside a bowl or a bore that does not rotate: gap'' >= -(v^2 / d + |a|), d = distance from its centre or axis.
    double of_ball_in_round(const Vec3& n, double gap) const;
    double round_radius(const Mover& m) const;
    /// Angular velocity (rad/s) of the frame in which the direction is fixed, and bound on the second derivative of widths in it, m/s^2.
    struct Frame
    {
        Vec3 spin;
        double acceleration = 0;
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
    Vec3 apart_, speed_, acceleration_;  ///< b's centre relative to a's
    double unsure_ = 0;                  ///< m/s^2, sum of the deviations of both centres
    double turning_ = 0;                 ///< m/s, bound on the speed of points about their centres, summed over both bodies
    double swirl_ = 0;                   ///< m/s^2, the same bound for accelerations
};

}  // namespace plab::simulation
