/// Limits that the projections of positions and of speeds share.
#pragma once

#include <limits>

namespace plab::simulation
{

/// Errors below this share of the numbers whose difference they are count as rounding.
inline constexpr double kProjectionRounding = 16 * std::numeric_limits<double>::epsilon();
/// If the iteration cannot reduce the error of positions below this share, the rows contradict one another.
inline constexpr double kContradiction = 1e-8;
/// A correction must reduce the error to this share, or the matrix is factored again at the present state.
inline constexpr double kGoodContraction = 1e-3;

}  // namespace plab::simulation
