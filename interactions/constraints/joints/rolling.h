/// An ellipsoid of body b rolls on a plane of body a (of the world, if there is no a) without slipping. A ball is the
/// ellipsoid of three equal axes. Not holonomic: two of its rows hold speeds alone.
///
/// F: frame of the ellipsoid's axes, fixed in b; A = diag of semi-axes; n: the plane's normal, fixed in a; m = n in F.
///
///   s  = -A^2 m / h,  h = sqrt(m . A^2 m)                  lowest point, from the ellipsoid's centre, in F
///   s' = -A^2 m' / h + A^2 m (m . A^2 m') / h^3,  m' = -w_ba x m
///   V  = (v_b + w_b x r_b) - (v_a + w_a x r_a) = 0         r: from the centres of mass to that point; J = [ -e, -r_a x e | e, r_b x e ]
///   bias = -e . (w_b x r_b' - w_a x r_a') - (w_a x e) . V  r_b' = w_b x r_b + R_F s',  r_a' = v_b + r_b' - v_a,  e fixed in a
///   phi = n . (p - plane)                                  only along n; its rate is n . V, since n . R_F s' = 0
///
/// Source: M. Kane, D. Levinson, "Realistic mathematical modeling of the rattleback", Int. J. Non-Linear Mech. 17 (1982).
#pragma once

#include "joints/pair.h"

namespace plab::constraints
{

struct RollingRows : ReactionColumns
{
    Column<Ref> a, b;
    Column<Vec3> semi_axes, centre;                                       // m
    Column<Quat> axes;                                                    // q_BF
    Column<Vec3> point, normal;                                           // as given, in W
    Column<Vec3> plane_point, plane_normal, placed_point, placed_normal;  // frame of a; as given when they were taken
    Column<bool> placed;
    Column<Vec3> contact;         // m
    Column<double> normal_force;  // N

    void describe(Schema& s);
};

/// Where and how the surfaces meet, at one state.
struct RollingContact
{
    Side a, b;       ///< r: to the contact point
    Vec3 n;          ///< of the plane, in W
    Vec3 t1, t2;     ///< square to it, fixed in a
    double gap = 0;  ///< m, along n
    Vec3 slip;       ///< V, m/s
    Vec3 r_a_rate, r_b_rate;
};
RollingContact contact_of(const RollingRows& rows, Row row, const Bodies& bodies);

Result<void> prepare_rolling(Row row, RollingRows& rows, const Bodies& bodies);
void constrain_rolling(const StepContext& step, Rows which, const RollingRows& rows, const Bodies& bodies, RowSink& sink);
void finish_rolling(const StepContext& step, Rows which, RollingRows& rows, const Bodies& bodies, const RowReports& reports);

}  // namespace plab::constraints
