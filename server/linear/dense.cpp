#include "linear/dense.h"

#include <algorithm>
#include <cmath>

#include "linear/dense_view.h"

namespace plab::linear
{
namespace
{

using Eigen::Index;

/// The number of columns that are eliminated together, and of those to their right that are updated between two calls of `stop`.
constexpr Index kPanel = 32, kStrip = 256;

double magnitude(double a) { return std::fabs(a); }
double magnitude(const Complex& a) { return std::fabs(a.real()) + std::fabs(a.imag()); }

/// Most elements are zero, as in the Jacobian of a chain of bodies. Eigen's dense kernels compute with zeros like with other numbers, which
/// takes two to four times as long as leaving them out.
template <class T>
bool is_sparse(const SquareMatrix<T>& a)
{
    return 3 * std::count_if(a.all().begin(), a.all().end(), [](const T& v) { return v != T(0); }) < static_cast<Index>(a.all().size());
}

}  // namespace

void multiply(const SquareMatrix<double>& a, const SquareMatrix<double>& b, SquareMatrix<double>& out)
{
    out.resize(a.size());
    auto product = view(out);
    if (!is_sparse(b))
    {
        product.noalias() = view(a) * view(b);
        return;
    }
    product.setZero();
    for (Index j = 0; j < product.cols(); ++j)
        for (Index k = 0; k < product.rows(); ++k)
            if (const double factor = view(b)(k, j); factor != 0) product.col(j) += factor * view(a).col(k);
}

template <class T>
bool Factors<T>::find_scales()
{
    const std::size_t n = a_.size();
    pivot_.resize(n), scale_.assign(n, 0.0);
    for (std::size_t c = 0; c < n; ++c)
        for (std::size_t r = 0; r < n; ++r)
        {
            const double size = magnitude(a_(r, c));
            if (!(size <= scale_[r])) scale_[r] = size;  // also if it is not a number
        }
    for (double& scale : scale_)
    {
        if (!(scale > 0) || !std::isfinite(scale)) return false;
        scale = 1 / scale;
    }
    return true;
}

/// Eliminates the columns from .. to - 1. Rows are exchanged over the whole matrix.
template <class T>
bool Factors<T>::factorise_panel(std::size_t from, std::size_t to, Ask ask, const void* asked)
{
    auto a = view(a_);
    const std::size_t n = a_.size();
    for (std::size_t k = from; k < to; ++k)
    {
        if (ask(asked)) return false;
        std::size_t best = k;
        for (std::size_t i = k + 1; i < n; ++i)
            if (scale_[i] * magnitude(a_(i, k)) > scale_[best] * magnitude(a_(best, k))) best = i;
        if (!(magnitude(a_(best, k)) > 0)) return false;
        pivot_[k] = best;
        const auto at = static_cast<Index>(k), below = static_cast<Index>(n - k - 1);
        if (best != k) a.row(at).swap(a.row(static_cast<Index>(best))), std::swap(scale_[k], scale_[best]);
        a.col(at).tail(below) *= T(1) / a(at, at);
        for (Index j = at + 1; j < static_cast<Index>(to); ++j)
            if (const T factor = a(at, j); factor != T(0)) a.col(j).tail(below) -= factor * a.col(at).tail(below);
    }
    return true;
}

template <class T>
bool Factors<T>::factorise_asking(Ask ask, const void* asked)
{
    if (!find_scales()) return false;
    auto a = view(a_);
    const Index n = a.rows(), panel = is_sparse(a_) ? n : kPanel;  // one panel leaves zeros out
    for (Index k = 0; k < n; k += panel)
    {
        const Index size = std::min(panel, n - k), done = k + size, below = n - done;
        if (!factorise_panel(static_cast<std::size_t>(k), static_cast<std::size_t>(done), ask, asked)) return false;
        const auto corner = a.block(k, k, size, size);
        for (Index c = done; c < n; c += kStrip)
        {
            if (ask(asked)) return false;
            const Index wide = std::min(kStrip, n - c);
            auto above = a.block(k, c, size, wide);
            corner.template triangularView<Eigen::UnitLower>().solveInPlace(above);
            a.block(done, c, below, wide).noalias() -= a.block(done, k, below, size) * above;
        }
    }
    return true;
}

template <class T>
void Factors<T>::solve(std::span<T> b) const
{
    const std::size_t n = a_.size();
    for (std::size_t k = 0; k < n; ++k)
        if (pivot_[k] != k) std::swap(b[k], b[pivot_[k]]);
    Eigen::Map<DenseVector<T>> x(b.data(), static_cast<Index>(n));
    view(a_).template triangularView<Eigen::UnitLower>().solveInPlace(x);
    view(a_).template triangularView<Eigen::Upper>().solveInPlace(x);
}

template class Factors<double>;
template class Factors<Complex>;

}  // namespace plab::linear
