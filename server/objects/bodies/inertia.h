/// Inertia matrices: what a real mass distribution may have, and how parts add up.
#pragma once

#include <array>

#include "plab/result.h"
#include "plab/tables.h"

namespace plab::bodies
{

/// The eigenvalues of a symmetric matrix, ascending.
std::array<double, 3> principal_moments(const Mat3& inertia);

/// Refuses, by name, what no rigid body has or no step can invert: an inertia that is not finite, symmetric and
/// positive definite, breaks I1 + I2 >= I3 (to 1e-9: a disc has equality), or has no finite inverse.
Result<void> check_inertia(const Mat3& inertia);

/// The inverse of a symmetric matrix; of a diagonal one exactly diagonal.
Mat3 inverse_inertia(const Mat3& inertia);

/// Adds `part` to `sum` (both about their own centres, in one frame): Steiner's theorem about the common centre.
MassProperties combined(const MassProperties& sum, const MassProperties& part);

/// The same solid at another density.
MassProperties scaled(const MassProperties& solid, double factor);

}  // namespace plab::bodies
