/// Dense matrices: products and factorisation. dense.cpp computes with Eigen, which this header does not show, because Eigen would
/// add two seconds to every source that includes it (dense_view.h). Sums have one order on every processor and with every compiler
/// (server/docs/determinism.md).
/// Source: G. Golub, C. Van Loan, Matrix computations, chapter 3 (blocked elimination; scaling of rows).
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "linear/square_matrix.h"

namespace plab::linear
{

using Complex = std::complex<double>;

/// out = a b. out is neither of them.
void multiply(const SquareMatrix<double>& a, const SquareMatrix<double>& b, SquareMatrix<double>& out);

/// P A = L U by Gauss' elimination with partial pivoting on rows scaled to their largest element; T is double or Complex.
///
/// Eigen's PartialPivLU is not used, because its pivots depend on the units of the rows: rows of positions and of velocities may differ
/// by a factor of 1e9, and a wrong pivot loses all digits (tests/unit/solvers/own_algebra_test.cpp). Nor can it be interrupted, which
/// is needed for groups of hundreds of bodies, where it would take minutes. Products and triangular solves are Eigen's.
template <class T>
class Factors
{
public:
    /// A view of the matrix to fill; factorise() then destroys it.
    SquareMatrix<T>& matrix() { return a_; }
    /// False if the matrix is singular or not finite, or `stop` says so, which is asked for each column.
    template <class Stop>
    bool factorise(const Stop& stop)
    {
        return factorise_asking([](const void* asked) { return (*static_cast<const Stop*>(asked))(); }, &stop);
    }
    bool factorise()
    {
        return factorise([] { return false; });
    }
    void solve(std::span<T> b) const;

private:
    using Ask = bool (*)(const void*);
    bool factorise_asking(Ask ask, const void* asked);
    bool find_scales();
    bool factorise_panel(std::size_t from, std::size_t to, Ask ask, const void* asked);

    SquareMatrix<T> a_;
    std::vector<std::size_t> pivot_;
    std::vector<double> scale_;
};

extern template class Factors<double>;
extern template class Factors<Complex>;

}  // namespace plab::linear
