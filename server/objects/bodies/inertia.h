/// Masses and inertias: conditions that a real mass distribution satisfies, and the sum of parts.
#pragma once

#include <array>
#include <string>

#include "plab/limits.h"
#include "plab/number_text.h"
#include "plab/result.h"
#include "plab/tables.h"

namespace plab::bodies
{

/// Refuses values that are not positive, or too small or large to compute with: the step divides by masses and inertias.
inline Result<void> check_positive(const std::string& name, double value)
{
    if (!(value > 0)) return reason(name + " must be positive, not " + number_text(value));
    if (!(value >= kLeastGiven && value <= kLargestGiven))
        return reason(name + " must lie between " + number_text(kLeastGiven) + " and " + number_text(kLargestGiven) + ", not " +
                      number_text(value));
    return {};
}

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
