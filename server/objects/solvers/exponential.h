/// Solver/Exponential: exponential Rosenbrock method of order 4 with two evaluations beside the Jacobian. Exact at any step
/// where forces are linear in places and speeds (springs, dampers, linear drag), however stiff, and linear in time.
///
/// With J = df/dy and f_t = df/dt at the start of the step, phi_k(z) = the usual functions, c = 3/4:
///   Y  = y0 + c h phi_1(c h J) f0 + (c h)^2 phi_2(c h J) f_t
///   D  = f(c h, Y) - f0 - J (Y - y0) - c h f_t
///   y1 = y0 + h phi_1(h J) f0 + h^2 phi_2(h J) f_t + 32/9 h phi_3(h J) D
/// Everything stands in one matrix exponential each, of the system's size and 3 (J with the vectors beside it).
/// - J by differences that prove themselves linear or are extrapolated (jacobian.h): right to rounding for linear forces. Only
///   numbers that the motion can reach from its first rates, by way of J, take part: a body on a slider costs 2 of its 12.
/// - The energy ledger: exact for linear forces, by the mean and the covariance of the state over the step, however many turns
///   it holds. For others by Boole's sums along y(t) at 2^p + 1 points, p = 2 .. 7 by the size of h J: more than 10 turns in a
///   step and the books do not close, though the state is right.
/// - Steps of more than a radian along which J changes so much that small motions beside the large one might grow are made by
///   Radau5 (two evaluations to see it).
/// - Dense, so the cost grows with the cube of the size. Where more than max_size numbers move, Radau5 is used, and an event
///   says so once; so it is for steps in which the exponential overflows.
/// Sources: Luan, Appl. Math. Lett. 65 (2017) 132, "Fourth-order two-stage explicit exponential integrators", exprb42;
/// Hochbruck, Ostermann, Acta Numerica 19 (2010) 209, section 2.4; Al-Mohy, Higham, SIAM J. Sci. Comput. 33 (2011) 488,
/// theorem 2.1 (phi functions by one exponential).
#pragma once

#include "matrix_exponential.h"
#include "radau5.h"
#include "resolved.h"

namespace plab::solvers
{

struct ExponentialMemory
{
    std::vector<double> y, f0, ft, units, sizes, work, slope, other, wide, middle, defect, plain;
    std::vector<double> from, to, mean, spread;  ///< of what moves, and the chain of ones
    std::vector<std::size_t> moving;             ///< indices of y, ascending
    std::vector<std::uint8_t> moves;
    SquareMatrix<double> jacobian;
    MatrixExponential exponential;
    Radau5Memory radau;

    void fit(std::size_t n);
};

struct ExponentialCounts
{
    bool fine = false;                      ///< else nothing was changed
    bool linear = false;                    ///< the forces are linear to rounding, as far as the step went
    bool too_large = false, sways = false;  ///< why it is not fine: numbers that move; derivatives that change
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

/// The method itself, for solvers that choose it, where at most `most` numbers move. With `only_linear` a step along which
/// the forces bend (looked at in three more points) is not made.
ExponentialCounts advance_by_exponential(double h, bool only_linear, std::size_t most, ExponentialMemory& memory, DynamicSystem& system);

}  // namespace plab::solvers
