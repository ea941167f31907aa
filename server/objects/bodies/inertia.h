/// Inertia matrices: conditions that a real mass distribution satisfies, and the sum of parts.
#pragma once

#include <array>

#include "plab/result.h"
#include "plab/tables.h"

namespace plab::bodies
{

/// The eigenvalues of a symmetric matrix, ascending.
std::array<double, 3> principal_moments(const Mat3& inertia);

/// Refuses, by name, inertias that no rigid body has or no step can invert: not finite, not symmetric, not positive definite, violating
/// I1 + I2 >= I3 (to 1e-9: a disc has equality), or without a finite inverse.
Result<void> check_inertia(const Mat3& inertia);

/// The inverse of a symmetric matrix; that of a diagonal matrix is exactly diagonal.
Mat3 inverse_inertia(const Mat3& inertia);

/// Adds `part` to `sum` (each about its own centre, in one frame) by Steiner's theorem about the common centre.
MassProperties combined(const MassProperties& sum, const MassProperties& part);

/// The same solid with another density.
MassProperties scaled(const MassProperties& solid, double factor);

}  // namespace plab::bodies
