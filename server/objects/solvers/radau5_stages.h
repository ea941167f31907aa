/// The stages of one internal step of Radau5: simplified Newton iteration, prediction and error estimate.
#pragma once

#include "jacobian.h"

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
