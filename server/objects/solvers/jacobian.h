/// df/dy of a FlatSystem by differences.
#pragma once

#include "dense.h"
#include "flat_system.h"

namespace plab::solvers
{

/// Where the derivative is taken, and vectors to work in; all of the system's size.
struct JacobianPoint
{
    double t = 0, h = 0;            ///< s; h is the step
    std::span<const double> y, f;   ///< f = f(t, y)
    std::span<const double> sizes;  ///< of the components of y (FlatSystem::sizes)
    std::span<const double> units;  ///< FlatSystem::units
    double absolute = 0;            ///< quantities smaller than this do not matter
    std::span<double> work, slope, other, wide;
};

/// One-sided differences over `relative` of each component's size: good to about `relative`, which is what Newton's method
/// needs. One evaluation per component. Bodies and shafts have places that the host adds to coordinates, whose rounding a
/// very short increment would drown in: theirs is at least 1e-3 `relative` units. Quantities have none.
void rough_jacobian(FlatSystem& system, const JacobianPoint& at, double relative, SquareMatrix<double>& out);

/// One column, by differences as good as the equations allow. `out` has its size; columns of speeds use those of positions. Where f is
/// linear in a component, a long increment has no truncation error: two lengths that agree prove it, and the derivative is right to
/// rounding (two evaluations). Otherwise central differences with Richardson's extrapolation, over the lengths that agree best (at most 34
/// evaluations).
void fine_column(FlatSystem& system, const JacobianPoint& at, std::size_t column, SquareMatrix<double>& out);

}  // namespace plab::solvers
