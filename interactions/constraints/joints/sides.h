/// The two sides of a joint at one state, and the rows that hold them together.
///
/// Side a may be the world. All rows use the same symbols: c, v, w are the position and velocity of a body's centre of mass and
/// its angular velocity, in W; r is the lever from c to the joint's point p; d = p_b - p_a, d' is its rate, w_ba = w_b - w_a.
///
///   point     phi = e . d          J = [ -e, -(r_a x e) | e, r_b x e ]          bias = -e . (w_b x (w_b x r_b) - w_a x (w_a x r_a))
///   travel    phi = t . d - x      t turns with a: the lever of a reaches p_b, and bias gains -(w_a x (w_a x t)) . d - 2 (w_a x t) . d'
///   angle     phi = e_a . e_b - c  J = [ -k | k ], k = e_b x e_a               bias = -(k' . w_ba)
///   turn      phi = e . s          J = [ -e | e ] on spins, s the rotation vector from a to b; bias = -(e' . w_ba), e' = w_a x e
///
/// How a row is used: phi is what must be zero, and J, with one block for each body, its derivative: phi' = J v. Differentiated once more,
/// phi'' = J v' + J' v, so the accelerations v' that keep phi at zero satisfy J v' = bias with bias = -J' v: what the points' accelerations
/// would be at constant speeds, with opposite sign. For `point` that is the centripetal acceleration w x (w x r) of each side. The host
/// adds forces J^T lambda that make J v' = bias true at every stage of a solver (index 1; E. Hairer, G. Wanner, Solving ordinary
/// differential equations II, section VII.2), and projects phi and J v to zero after the step, because twice integrated rounding drifts.
/// A direction e that is fixed in a body turns with it, e' = w x e, which adds the terms with e' above.
///
/// s is valid up to half a turn and has no second zero there; J is its derivative on the constraint, where s = 0.
/// Source of the rows: E. J. Haug, Computer aided kinematics and dynamics of mechanical systems, volume I (1989), chapter 9.
#pragma once

#include <cmath>

#include "plab/rotation.h"
#include "plab/rows.h"
#include "plab/tables.h"

namespace plab::constraints
{

struct Side
{
    Ref body;  ///< invalid: the world
    Vec3 c, v, w;
    Quat q;
    Vec3 r;  ///< from c to the joint's point, in W
    Vec3 p;  ///< the joint's point
};

/// The side of a body whose point is at point_B (m, in the body's frame as authored; for the world, in W).
Side side_of(const Bodies& bodies, Ref body, const Vec3& point_B);

struct Sides
{
    Side a, b;
    Vec3 d, rate;  ///< d, d'
    Vec3 w_ba;

    /// w x (w x r) of b minus that of a: the relative acceleration of the points at constant angular velocities.
    Vec3 centripetal() const { return cross(b.w, cross(b.w, b.r)) - cross(a.w, cross(a.w, a.r)); }
};
Sides sides_of(const Side& a, const Side& b);

/// A row over both sides; error and bias are 0. The world has no block.
ConstraintRow row_over(const Sides& s, const Vec3& linear, const Vec3& angular_a, const Vec3& angular_b, std::uint32_t feature);

/// Adds a block to a row; blocks of the same participant are merged. The world has no block.
void add_block(const RowBlock& block, ConstraintRow& row);
/// Adds `factor` times another row: its blocks, error and bias.
void add_row(const ConstraintRow& other, double factor, ConstraintRow& row);

/// Three rows, one for each axis of W: p_b = p_a.
void add_point_rows(const Sides& s, std::uint32_t feature, RowSink& sink);
/// t . d = travel, with t fixed in a.
ConstraintRow travel_row(const Sides& s, const Vec3& t, double travel, std::uint32_t feature);
/// No rotation of b relative to a about e; `turned` (rad) is the present rotation. `e_turns`: e is fixed in a, otherwise in W.
ConstraintRow turn_row(const Sides& s, const Vec3& e, double turned, bool e_turns, std::uint32_t feature);
/// Three rows, one for each axis of W: the frame of b coincides with that of a. q_WFa, q_WFb.
void add_attitude_rows(const Sides& s, const Quat& frame_a, const Quat& frame_b, std::uint32_t feature, RowSink& sink);
/// Two rows: axis n_b (fixed in b) lies along n_a, in the same direction. t1, t2: unit, perpendicular to n_a, fixed in a.
void add_axis_rows(const Sides& s, const Vec3& n_a, const Vec3& n_b, const Vec3& t1, const Vec3& t2, std::uint32_t feature, RowSink& sink);

/// One row: e_b (fixed in b) keeps its angle to e_a (fixed in a), e_a . e_b = cosine.
ConstraintRow angle_row(const Sides& s, const Vec3& e_a, const Vec3& e_b, double cosine, std::uint32_t feature);

/// The axes of a joint's frame.
struct Axes
{
    Quat q;  ///< q_WF
    Vec3 t1, t2, n;
};
Axes axes_of(const Quat& q_WF);

/// A frame whose z axis is the unit vector n.
Quat frame_of_axis(const Vec3& n);
/// The angle of frame b relative to a about z, within half a turn, rad: the twist of the relative rotation.
double twist(const Quat& frame_a, const Quat& frame_b);
/// The angle that equals `angle` up to whole turns and is nearest to `expected`.
double unwrapped(double angle, double expected);

}  // namespace plab::constraints
