/// The stages of one internal step of Radau5: simplified Newton iteration, prediction and error estimate.
///
/// The method demands that the rates at three points of the step, integrated with the method's matrix A, lead to these points themselves.
/// With Z = (z1, z2, z3), the stages minus y, that is Z = h (A x I) F(Z): 3 n nonlinear equations. Newton's method with the Jacobian J of
/// the start in place of the present one (simplified) solves in each iteration
///
///   (A^-1/h x I - I x J) dZ = (right-hand side)            one matrix of size 3 n
///
/// A^-1 has one real eigenvalue gamma and a pair alpha +- i beta. In the coordinates W = (T^-1 x I) Z of its eigenvectors the matrix falls
/// apart into gamma/h I - J and (alpha + i beta)/h I - J: a real and a complex system of size n, whose factorisations cost a fifth of that
/// of the whole. They are kept as long as h stays, and J for as long as the iteration contracts fast. The iteration starts from the
/// collocation polynomial of the step before, continued beyond its end. Its contraction theta tells how far W still is from the solution,
/// theta/(1 - theta) |dW|, so it stops when that is well below the error that the step may make, or gives up when the remaining iterations
/// would not suffice.
///
/// Error: an embedded formula of order 3 over the same stages would not be bounded for stiff components; multiplied by (gamma/h I - J)^-1,
/// which is at hand, it is. In the first step and after a rejection this filter is applied a second time, as the first estimate may be far
/// too large for components that the step damps away anyway. Source: E. Hairer, G. Wanner, Solving ordinary differential equations II,
/// section IV.8, eq. (8.4) to (8.20); the program RADAU5.
#pragma once

#include "flat_system.h"

namespace plab::solvers
{

/// Vectors and matrices of one advance, kept warm.
struct Radau5Memory
{
    std::vector<double> y, f0, units, sizes, scale, error, filtered, work, slope, other, wide;
    std::vector<double> z[3], w[3], f[3], polynomial[3];
    std::vector<Complex> pair;
    SquareMatrix<double> jacobian;
    Factors<double> real;
    Factors<Complex> complex;

    void fit(std::size_t n);
};

}  // namespace plab::solvers

namespace plab::solvers::radau
{

inline constexpr int kNewtonIterations = 7;
inline constexpr double kSqrt6 = 2.449489742783178098197284;
inline constexpr double kNode[3] = {(4 - kSqrt6) / 10, (4 + kSqrt6) / 10, 1};
inline constexpr double kWeight[3] = {(16 - kSqrt6) / 36, (16 + kSqrt6) / 36, 1.0 / 9};

struct NewtonResult
{
    bool converged = false, finite = true;
    int iterations = 0;
    double contraction = 0;
    double shrink = 0.5;  ///< what the step may be multiplied by for the next attempt
};

/// Works on the memory of an advance: y, f0 (its rates), scale and jacobian are given, z (stages minus y) is found.
class RadauStages
{
public:
    RadauStages(FlatSystem& flat, Radau5Memory& memory) : flat_(flat), m_(memory) {}

    /// The two matrices for steps of length h. False if one is singular.
    bool factorise(double h);
    /// Starts from the collocation polynomial of the step before, of length `previous`; 0: from y.
    void predict(double h, double previous);
    /// `limit`: the iteration's error in units of the scale.
    NewtonResult solve(double t, double h, double limit);
    /// In units of the scale. `careful`: a large one is estimated once more with filtered slopes.
    double error(double t, double h, bool careful);
    void keep_polynomial();

private:
    void correct(double h);

    FlatSystem& flat_;
    Radau5Memory& m_;
    double last_contraction_ = 1;
};

}  // namespace plab::solvers::radau
