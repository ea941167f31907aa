/// Solver/RotationSplitting: alternates kicks by forces and force-free flights; the free rotation of a flight is itself split into
/// rotations about the three principal axes. Each part is solved exactly, so the angular momentum of a free body is conserved to the last
/// bit (|m| in the body frame to rounding), and its energy error stays bounded in runs of any length.
///
/// With the flows A, B, C (rotation about the principal axes at m_i / I_i, beginning with that of the smallest moment, which gave the
/// least error for all tops that were tried; the centre of mass moves along) and K (u' = U(t, x, u) at fixed t and x), the map X(h) =
/// K(h) C(h) B(h) A(h) and its adjoint X*(h), applied from right to left:
///   order 2:  X*(h/2) X(h/2)                                  McLachlan, Reich: one kick in the middle
///   order 4:  X*(a_12 h) X(a_11 h) ... X*(a_2 h) X(a_1 h)     Blanes, Moan: six kicks, palindromic a_i
/// For a needle, the flight uses the closed form of its free rotation instead (plab/free_rotation.h).
/// Kicks by forces that do not depend on velocity are exact (and symplectic); other forces are integrated by the classical Runge-Kutta
/// method, which preserves the order. Uniform forces are applied in one kick in the middle of the step, which is exact.
/// Sources: McLachlan, SIAM J. Sci. Comput. 16 (1995) 151, section 4; Reich, Physica D 76 (1994) 375; Touma, Wisdom, Astron. J. 107
/// (1994) 1189; Blanes, Moan, J. Comput. Appl. Math. 142 (2002) 313, table 2, S6 (as a composition of X and X*: by the theorem of
/// McLachlan 1995 it is valid for any number of flows).
#pragma once

#include "plab/registrar.h"

namespace plab::solvers
{

struct RotationSplittingRows
{
    Column<std::int64_t> order;

    void describe(Schema& schema);
};

Result<void> prepare_rotation_splitting(const StepContext& context, Row row, const RotationSplittingRows& rows);
/// One step over context.dt, from coordinates 0.
void advance_rotation_splitting(const StepContext& context, Row row, const RotationSplittingRows& rows, DynamicSystem& system);

/// The method itself, for solvers that choose it; order 2 or 4. Uses workspaces 0..7.
void advance_by_splitting(double h, int order, DynamicSystem& system);

}  // namespace plab::solvers
