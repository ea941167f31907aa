/// The two sides of a joint at one state, and the rows that hold them together.
///
/// Side a may be the world. All rows use the same letters: c, v, w of a body's centre of mass and spin in W; r the lever from
/// c to the joint's point p; d = p_b - p_a, d' its rate, w_ba = w_b - w_a.
///
///   point     phi = e . d          J = [ -e, -(r_a x e) | e, r_b x e ]          bias = -e . (w_b x (w_b x r_b) - w_a x (w_a x r_a))
///   travel    phi = t . d - x      t turns with a: the lever of a reaches p_b, and bias gains -(w_a x (w_a x t)) . d - 2 (w_a x t) . d'
///   turn      phi = e . s          J = [ -e | e ] on spins, s the rotation vector from a to b; bias = -(e' . w_ba), e' = w_a x e
///
/// s is good to half a turn, has no second zero, and J is its derivative on the constraint, where s = 0.
#pragma once

#include <cmath>

#include "plab/rotation.h"
#include "plab/rows.h"
#include "plab/tables.h"

namespace plab::constraints
{

struct Side
{
    Ref who;  ///< not valid: the world
    Vec3 c, v, w;
    Quat q;
    Vec3 r;  ///< from c to the joint's point, in W
    Vec3 p;  ///< the joint's point
};

/// The side of a body whose point is at point_B (m, in its frame as authored; in W for the world).
Side side_of(const Bodies& bodies, Ref who, const Vec3& point_B);

struct Sides
{
    Side a, b;
    Vec3 d, rate;  ///< d, d'
    Vec3 w_ba;

    /// w x (w x r) of b less that of a: what the points accelerate by while spins stay.
    Vec3 centripetal() const { return cross(b.w, cross(b.w, b.r)) - cross(a.w, cross(a.w, a.r)); }
};
Sides sides_of(const Side& a, const Side& b);

/// A row over both sides, error and bias still 0. The world has no block.
ConstraintRow row_over(const Sides& s, const Vec3& linear, const Vec3& angular_a, const Vec3& angular_b, std::uint32_t feature);

/// One row for each axis of W: p_b = p_a.
void add_point_rows(const Sides& s, std::uint32_t feature, RowSink& sink);
/// t . d = travel, t fixed in a.
ConstraintRow travel_row(const Sides& s, const Vec3& t, double travel, std::uint32_t feature);
/// No turn of b against a about e; `turned` (rad) is how far it has. `e_turns`: e is fixed in a, else in W.
ConstraintRow turn_row(const Sides& s, const Vec3& e, double turned, bool e_turns, std::uint32_t feature);
/// One row for each axis of W: frame b is frame a. q_WFa, q_WFb.
void add_attitude_rows(const Sides& s, const Quat& frame_a, const Quat& frame_b, std::uint32_t feature, RowSink& sink);
/// Two rows: axis n_b (fixed in b) lies along n_a, not against it. t1, t2: unit, square to n_a, fixed in a.
void add_axis_rows(const Sides& s, const Vec3& n_a, const Vec3& n_b, const Vec3& t1, const Vec3& t2, std::uint32_t feature, RowSink& sink);

/// A frame with z along the unit vector n.
Quat frame_of_axis(const Vec3& n);
/// Angle about z of the frame b against a, within half a turn, rad: the twist of the relative rotation.
double twist(const Quat& frame_a, const Quat& frame_b);
/// The angle equal to `angle` up to whole turns that is nearest to `expected`.
double unwrapped(double angle, double expected);

}  // namespace plab::constraints
