/// The laws of a contact that is a spring, by themselves: numbers in, numbers out.
#pragma once

#include "contact_point.h"
#include "plab/vector.h"

namespace plab::response
{

/// Damping ratio of a linear spring and damper that gives back the share e of the approach speed.
/// The contact ends where the bodies part (it may pull just before):  e = exp(-pi z / sqrt(1 - z^2)).
double ratio_for_restitution(double e);
/// The same where the contact ends with the force (it never pulls):   e = exp(-2 z acos(z) / sqrt(1 - z^2)), and with
/// acosh and z^2 - 1 for z > 1 (Schwager and Poeschel, Granular Matter 9 (2007), eq. 21). e below 0.01 counts as 0.01.
double ratio_for_restitution_without_pull(double e);
/// d v of Hunt and Crossley's law for an approach at v that comes back with e v. Whatever k, n and m:
///   m v dv / (1 + d v) = -k x^n dx   =>   (1 + e) s = ln((1 + s) / (1 - e s)),   s = d v.
/// e below 0.01 counts as 0.01.
double loss_for_restitution(double e);

/// Normal part of a contact force at one state.
struct NormalForce
{
    double force = 0;      ///< N, pushes apart
    double stiffness = 0;  ///< N/m, of the spring at this depth
    double stored = 0;     ///< J
};

struct SurfaceForce
{
    Vec3 force;         ///< N on b, in the surface
    Vec3 stretch;       ///< m
    double stored = 0;  ///< J
};

/// A stiction spring of stiffness k (N/m) and damper c (N s/m) within Coulomb's cone:
///   f = -k xi - c u_t,  |f| <= limit,  where it slips xi is what gives that force.
SurfaceForce surface_force(double k, double c, double limit, const Vec3& stretch, const Vec3& slip);

}  // namespace plab::response
