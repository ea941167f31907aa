/// Speculative contacts: pairs whose gap may close within the step are contacts already, so that a manager stops the bodies at the surface
/// instead of behind it. Nothing is rewound; the manager lets the gap close but not turn into overlap (n . u >= -gap / h).
///
/// Source: Catto, Continuous collision, GDC (2013); Stewart, Trinkle, IJNME 39 (1996): gaps enter as depth / h.
#pragma once

#include <span>

#include "plab/collision.h"
#include "plab/tables.h"

namespace plab::simulation
{

/// m: no gap wider than this closes within h (s), for any pair of the bodies. `radius_of_body` (m, about the centre of mass) is infinite
/// for planes; `acceleration` (m/s^2) is the largest that forces are expected to cause.
double speculative_margin(const Bodies& bodies, std::span<const double> radius_of_body, double acceleration, double h);

/// Whether a detected gap (depth < 0) may close within h (s). Contacts that overlap or touch always count.
bool may_close(const Bodies& bodies, std::span<const double> radius_of_body, const Contact& contact, double acceleration, double h);

/// m: no gap along `normal` (a to b) wider than this closes within h (s) at the present velocities, rotation included. At most half of the
/// smaller body's radius: over longer distances the present contact geometry does not predict the later one.
double closing_margin(const Bodies& bodies, std::span<const double> radius_of_body, Ref a, Ref b, const Vec3& normal, double h);

}  // namespace plab::simulation
