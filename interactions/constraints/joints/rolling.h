/// An ellipsoid of body b rolls without slipping on a plane of body a (of the world, if there is no a), or a ball on a sphere
/// or a cylinder of it, outside or inside. A ball is the ellipsoid of three equal axes. Not holonomic: two rows hold speeds alone.
///
/// On a plane. F: frame of the ellipsoid's axes, fixed in b; A = diag of semi-axes; n: the plane's normal, fixed in a; m = n in F.
///
///   s  = -A^2 m / h,  h = sqrt(m . A^2 m)                  lowest point, from the ellipsoid's centre, in F
///   s' = -A^2 m' / h + A^2 m (m . A^2 m') / h^3,  m' = -w_ba x m
///   phi = n . (p - plane)
///   n' = w_a x n
///
/// A ball of radius r on a sphere or cylinder of radius R, with centre O or axis u through O, both fixed in a; c: the ball's
/// centre, d = c - O (cylinder: less its part along u), N = d/|d|, sigma = 1 outside, -1 inside:
///
///   n  = sigma N,  n' = sigma (d' - (N . d') N) / |d|      from the surface to the ball
///   phi = sigma (|d| - R) - r                              m
///   s  = -r n,     s' = -r n'
///
/// Of both, with r_a, r_b from the centres of mass to the point of contact:
///
///   V  = (v_b + w_b x r_b) - (v_a + w_a x r_a) = 0         m/s; J = [ -e, -r_a x e | e, r_b x e ] for e = n, t1, t2
///   bias = -e . (w_b x r_b' - w_a x r_a') - e' . V         m/s^2; r_b' = w_b x (r_b - s) + s', r_a' = v_b + r_b' - v_a,
///                                                          e' = W x e, W: angular velocity of the triad n, t1, t2
///   phi' = n . V                                           phi is held along n only
///
/// (On the plane, s turns with b: s' there is w_b x s + R_F s'.) With `parallel`, b is a cylinder that touches along a line, and
/// the ball is its cross-section: two further rows keep its axis parallel to u (sides.h, turn).
///
/// Sources: T. R. Kane, D. A. Levinson, "Realistic mathematical modeling of the rattleback", Int. J. Non-Linear Mech. 17 (1982) 175;
/// J. Neimark, N. Fufaev, Dynamics of nonholonomic systems (1972), on the ball in a sphere and in a cylinder.
#pragma once

#include "joints/pair.h"

namespace plab::constraints
{

struct RollingRows : ReactionColumns
{
    Column<Ref> a, b;
    Column<Vec3> semi_axes, centre;  // m
    Column<Quat> axes;               // q_BF
    Column<std::string> on;
    Column<double> radius;  // R, m
    Column<bool> inside, parallel;
    Column<Vec3> point, normal, axis;                                     // as given, in W
    Column<Vec3> plane_point, plane_normal, placed_point, placed_normal;  // in the frame of a; the parameters from which they were taken
    Column<Vec3> placed_axis, axis_b;                                     // parameter from which axis_b was taken; u in the frame of b
    Column<bool> placed;
    Column<Vec3> contact;         // m
    Column<double> normal_force;  // N

    void describe(Schema& s);
};

/// The geometry of the contact at one state.
struct RollingContact
{
    Side a, b;       ///< r: to the contact point
    Vec3 n;          ///< from the surface to b, in W
    Vec3 t1, t2;     ///< perpendicular to n
    Vec3 turn;       ///< rad/s: angular velocity of n, t1, t2
    Vec3 u;          ///< axis of the cylinder, in W
    double gap = 0;  ///< phi, m, along n
    Vec3 slip;       ///< V, m/s
    Vec3 r_a_rate, r_b_rate;
};
RollingContact contact_of(const RollingRows& rows, Row row, const Bodies& bodies);

Result<void> prepare_rolling(Row row, RollingRows& rows, const Bodies& bodies);
void constrain_rolling(const StepContext& step, Rows which, const RollingRows& rows, const Bodies& bodies, RowSink& sink);
void finish_rolling(const StepContext& step, Rows which, RollingRows& rows, const Bodies& bodies, const RowReports& reports);

}  // namespace plab::constraints
