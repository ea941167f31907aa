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
    double force = 0;       ///< N, > 0: pushes the bodies apart
    double tangential = 0;  ///< N/m: stiffness on which that of the stiction spring is based
    double stored = 0;      ///< J
};

struct SurfaceForce
{
    Vec3 force;         ///< N on b, in the surface
    Vec3 stretch;       ///< m
    double stored = 0;  ///< J
};

/// N/m: stiffness of the spring k x^n at the depth to which an approach at `speed` (m/s) presses it, if bodies with the sum
/// `inverse_mass` (1/kg) meet at a central contact: m v^2 / 2 = k x^(n+1) / (n + 1). The stiction spring has it from the beginning
/// to the end of a contact. A stiffness that grew with the depth would give energy to a spring that has been stretched before.
double stiffness_at_approach(double k, double n, double speed, double inverse_mass);

/// A stiction spring of stiffness k (N/m) with a damper c (N s/m), limited by Coulomb's cone: if |k xi| > limit, the spring slips until
/// |k xi| = limit (radial return, as in plasticity), then
///   f = -k xi - c u_t, shortened to |f| = limit.
/// Neither gives energy: with s = -k xi in the cone, (s - f) . (s - (s - c u_t)) >= 0 for the point f of the cone nearest to s - c u_t, so
/// f . u_t <= s . u_t. A spring that slips until spring and damper together are within the cone (S. Luding, Cohesive, frictional
/// powders, Granular Matter 10 (2008) 235) would be stretched by the damper, against nothing that pays for it.
SurfaceForce surface_force(double k, double c, double limit, const Vec3& stretch, const Vec3& slip);

}  // namespace plab::response
