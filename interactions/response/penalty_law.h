/// The force laws of spring contacts, as functions of numbers alone.
#pragma once

#include "contact_point.h"
#include "plab/vector.h"

namespace plab::response
{

/// The damping ratio z with which a linear spring and damper returns the share e of the approach speed, if the contact ends when
/// the bodies separate (the damper may pull just before):  e = exp(-pi z / sqrt(1 - z^2)).
double ratio_for_restitution(double e);
/// The same if the contact ends with its force (it never pulls):   e = exp(-2 z acos(z) / sqrt(1 - z^2)); for z > 1 with acosh
/// and z^2 - 1 (Schwager and Poeschel, Granular Matter 9 (2007), eq. 21). e below 0.01 counts as 0.01.
double ratio_for_restitution_without_pull(double e);
/// d v in Hunt and Crossley's law for an approach at speed v that returns with e v, for any k, n and m:
///   m v dv / (1 + d v) = -k x^n dx   =>   (1 + e) s = ln((1 + s) / (1 - e s)),   s = d v.
/// e below 0.01 counts as 0.01.
double loss_for_restitution(double e);

/// Normal part of a contact force in one state.
struct NormalForce
{
    double force = 0;      ///< N, > 0: pushes the bodies apart
    double stiffness = 0;  ///< N/m, of the spring at this depth
    double stored = 0;     ///< J
};

struct SurfaceForce
{
    Vec3 force;         ///< N on b, in the surface
    Vec3 stretch;       ///< m
    double stored = 0;  ///< J
};

/// A stiction spring of stiffness k (N/m) with a damper c (N s/m), limited by Coulomb's cone:
///   f = -k xi - c u_t,  |f| <= limit;  while the point slides, xi is set to the extension that gives |f| = limit.
SurfaceForce surface_force(double k, double c, double limit, const Vec3& stretch, const Vec3& slip);

}  // namespace plab::response
