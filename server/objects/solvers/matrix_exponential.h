/// exp(A) of small dense matrices.
#pragma once

#include "linear/dense.h"

namespace plab::solvers
{

using linear::SquareMatrix;

/// exp(A) and its square roots exp(A / 2^p) by balancing, scaling, a Taylor polynomial of degree 16 and squaring. Eigen's exp
/// (unsupported/Eigen/MatrixFunctions) is not used, because it does not balance, which costs digits where the units of rows differ
/// (tests/unit/solvers/own_algebra_test.cpp), and gives neither the roots nor the moments. Products are Eigen's.
/// Sources: Moler, Van Loan, "Nineteen dubious ways ...", SIAM Rev. 45 (2003) 3, method 3; Parlett, Reinsch, Numer. Math. 13
/// (1969) 293 (balancing by powers of two, which rounds nothing); Paterson, Stockmeyer, SIAM J. Comput. 2 (1973) 60.
class MatrixExponential
{
public:
    static constexpr int kLeastRoots = 2, kMostRoots = 7;

    /// A view of A to fill; compute() destroys it.
    SquareMatrix<double>& matrix() { return a_; }
    /// exp(A / 2^root) for root = 0 .. roots(). False if it is not finite.
    bool compute();
    /// How many roots were made on the way: from kLeastRoots to kMostRoots, more where A is larger.
    int roots() const { return roots_; }
    /// out = exp(A / 2^root) v. out and v are different.
    void apply(int root, std::span<const double> v, std::span<double> out) const;
    /// The mean over 0 <= t <= 1 of y(t) = exp(A t) e, e the unit vector `constant`, and columns L, one after the other in
    /// `spread`, with the covariance of y = L L^T, for those components below `count` that `constant` is not. `constant` has to
    /// stay 1 all the time. Their number. After compute(). Doubling of Gram's matrix: Van Loan, IEEE Trans. Autom. Control 23
    /// (1978) 395.
    std::size_t moments(std::size_t constant, std::size_t count, std::vector<double>& mean, std::vector<double>& spread);
    /// Norm of the balanced A: how many turns and decays there are in it.
    double size() const { return size_; }

private:
    void balance();
    void taylor();
    void flush();
    void start_gram(std::size_t constant);
    void double_gram();
    std::size_t factorise_covariance(std::size_t constant, std::size_t count, std::vector<double>& spread);

    SquareMatrix<double> a_, square_, cube_, fourth_, sum_, spare_;
    SquareMatrix<double> base_, gram_, wide_;  ///< base_ = exp(A / 2^squarings_)
    std::vector<double> powers_, left_;
    std::vector<SquareMatrix<double>> root_;
    std::vector<double> scale_;  ///< powers of two: A = D B D^-1
    double size_ = 0;
    int roots_ = kLeastRoots, squarings_ = 0;
};

}  // namespace plab::solvers
