/// What a step can compute with: squares of states, and products of what a blueprint gives, must stay within a double.
#pragma once

#include <cmath>

#include "plab/vector.h"

namespace plab
{

/// Numbers in blueprints and requests, in SI units: no larger than this in size.
inline constexpr double kLargestGiven = 1e100;
/// What must be positive is at least this: something is divided by it.
inline constexpr double kLeastGiven = 1e-100;
/// A state beyond this has no finite square: who has it is taken out of the step (state.not_finite).
inline constexpr double kLargestState = 1e150;

/// False for nan and inf, too.
inline bool is_computable(double x) { return std::fabs(x) <= kLargestState; }
inline bool is_computable(const Vec3& v) { return is_computable(v.x) && is_computable(v.y) && is_computable(v.z); }

}  // namespace plab
