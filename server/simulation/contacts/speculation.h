/// Speculative contacts: gaps that may close within a step, so that a manager stops bodies at the surface instead of
/// behind it. Nothing goes back; what the manager does with a gap is to let it close and no more.
///
/// Source: Catto, Continuous collision, GDC (2013); Stewart, Trinkle, IJNME 39 (1996): gaps enter as depth / h.
#pragma once

#include <span>

#include "plab/collision.h"
#include "plab/tables.h"

namespace plab::simulation
{

/// m: no gap wider than this closes within h (s), whoever meets whom. `radius_of_body` (m, about C) is infinite for
/// planes; `acceleration` (m/s^2) is the most that forces are expected to give.
double speculative_margin(const Bodies& bodies, std::span<const double> radius_of_body, double acceleration, double h);

/// Whether a found gap (depth < 0) may close within h. What overlaps or touches always counts.
bool may_close(const Bodies& bodies, std::span<const double> radius_of_body, const Contact& contact, double acceleration, double h);

/// m: no gap along `normal` (a to b) wider than this closes within h at the present speeds, turning included; and no more
/// than half of the smaller body's radius, beyond which what was seen now says nothing of then.
double closing_margin(const Bodies& bodies, std::span<const double> radius_of_body, Ref a, Ref b, const Vec3& normal, double h);

}  // namespace plab::simulation
