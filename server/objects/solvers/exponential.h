/// Solver/Exponential: an exponential Rosenbrock method of order 4 with two evaluations in addition to the Jacobian. Exact at any step if
/// forces are linear in positions and speeds (springs, dampers, linear drag), however stiff, and linear in time.
///
/// Why an exponential: the linear system y' = J y + b has the solution y0 + h phi_1(h J) (J y0 + b), phi_1(z) = (e^z - 1)/z, whatever the
/// size of h J. A Rosenbrock method splits f into its linearisation at the start of the step, which the exponential solves exactly, and a
/// remainder, which an explicit method integrates. So the length of a step is bounded not by how stiff the forces are, but only by how
/// much their derivative changes along the step. Unlike implicit methods, which damp what a step does not resolve, this keeps each
/// oscillation with its amplitude and its phase.
///
/// With J = df/dy and f_t = df/dt at the start of the step, phi_k(z) = the usual functions, c = 3/4:
///   Y  = y0 + c h phi_1(c h J) f0 + (c h)^2 phi_2(c h J) f_t
///   D  = f(c h, Y) - f0 - J (Y - y0) - c h f_t
///   y1 = y0 + h phi_1(h J) f0 + h^2 phi_2(h J) f_t + 32/9 h phi_3(h J) D
/// Each of the two is computed by one matrix exponential of the system's size plus 3 (J with the vectors as additional columns).
/// - J is computed by differences that verify their own linearity or are extrapolated (flat_system.h): exact to rounding for linear forces.
/// Only numbers that the motion can reach from its first rates through J take part: a body on a slider needs 2 of its 12.
/// - The energy ledger is exact for linear forces, from the mean and the covariance of the state over the step, however many oscillations
/// it contains. For other forces it uses Boole's rule along y(t) at 2^p + 1 points, p = 2 .. 7 depending on the size of h J. With more
/// than 10 oscillations per step the ledger does not close, although the state is right.
/// - Steps longer than one radian, along which J changes so much that small motions beside the large one might grow, are made by Radau5
/// (two evaluations detect them).
/// - The matrices are dense, so the cost grows with the cube of the size. If more than max_size numbers move, Radau5 is used, and an
/// event reports that once; likewise for steps in which the exponential overflows.
/// Sources: V. T. Luan, Fourth-order two-stage explicit exponential integrators for time-dependent PDEs, Appl. Numer. Math. 112 (2017) 91
/// (the method exprb42);
/// Hochbruck, Ostermann, Acta Numerica 19 (2010) 209, section 2.4; Al-Mohy, Higham, SIAM J. Sci. Comput. 33 (2011) 488,
/// theorem 2.1 (phi functions by one exponential).
#pragma once

#include "matrix_exponential.h"
#include "radau5.h"
#include "reports.h"

namespace plab::solvers
{

struct ExponentialMemory
{
    std::vector<double> y, f0, ft, units, sizes, work, slope, other, wide, middle, defect, plain;
    std::vector<double> from, to, mean, spread;  ///< of the numbers that move, and of the chain of ones
    std::vector<std::size_t> moving;             ///< indices of y, ascending
    std::vector<std::uint8_t> moves;
    SquareMatrix<double> jacobian;
    MatrixExponential exponential;
    Radau5Memory radau;

    void fit(std::size_t n);
};

struct ExponentialCounts
{
    bool fine = false;                         ///< if false, nothing was changed
    bool linear = false;                       ///< the forces are linear to rounding along the step
    bool too_large = false, unsteady = false;  ///< why it failed: too many numbers move; the derivatives change
    std::int64_t evaluations = 0;
};

struct ExponentialRows
{
    Column<std::int64_t> max_size;
    Column<std::int64_t> evaluations;
    Column<bool> linear;
    ResolvedColumns resolved;
    Column<ExponentialMemory> memory;

    void describe(Schema& schema);
};

/// One step over context.dt, from coordinates 0.
void advance_exponential(const StepContext& context, Row row, ExponentialRows& rows, DynamicSystem& system);

/// The method itself, for solvers that choose it; at most `most` numbers may move. With `only_linear`, no step is made if the forces are
/// nonlinear along it (tested at three more points).
ExponentialCounts advance_by_exponential(double h, bool only_linear, std::size_t most, ExponentialMemory& memory, DynamicSystem& system);

}  // namespace plab::solvers
