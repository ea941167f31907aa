/// Magnitudes with which a step can compute: squares of states, and products of given parameters, must be finite doubles.
#pragma once

#include <cmath>

#include "plab/vector.h"

namespace plab
{

/// Largest magnitude of numbers in blueprints and requests, in SI units.
inline constexpr double kLargestGiven = 1e100;
/// Smallest value of numbers that must be positive, because something is divided by them.
inline constexpr double kLeastGiven = 1e-100;
/// The square of a larger state would overflow; an object with such a state is taken out of the step (state.not_finite).
inline constexpr double kLargestState = 1e150;

/// Also false for nan and inf.
inline bool is_computable(double x) { return std::fabs(x) <= kLargestState; }
inline bool is_computable(const Vec3& v) { return is_computable(v.x) && is_computable(v.y) && is_computable(v.z); }

}  // namespace plab
