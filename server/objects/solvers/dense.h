/// Small dense linear algebra with sums in one fixed order, so that every build and every alignment rounds alike
/// (server/docs/determinism.md); a general library promises no such order.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace plab::solvers
{

/// A complex number without the C++ library's care for infinities, which costs a call per product.
struct Complex
{
    double re = 0, im = 0;
    friend Complex operator+(const Complex& a, const Complex& b) { return {a.re + b.re, a.im + b.im}; }
    friend Complex operator-(const Complex& a, const Complex& b) { return {a.re - b.re, a.im - b.im}; }
    friend Complex operator*(const Complex& a, const Complex& b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }
};
inline double magnitude(double a) { return std::fabs(a); }
inline double magnitude(const Complex& a) { return std::fabs(a.re) + std::fabs(a.im); }
inline double reciprocal(double a) { return 1 / a; }
inline Complex reciprocal(const Complex& a)
{
    // Smith's way, which does not overflow.
    if (std::fabs(a.re) >= std::fabs(a.im))
    {
        const double r = a.im / a.re, d = a.re + a.im * r;
        return {1 / d, -r / d};
    }
    const double r = a.re / a.im, d = a.re * r + a.im;
    return {r / d, -1 / d};
}

/// n x n, row by row. Keeps its memory when it is resized.
template <class T>
class SquareMatrix
{
public:
    void resize(std::size_t n) { n_ = n, a_.resize(n * n); }
    std::size_t size() const { return n_; }
    T& operator()(std::size_t r, std::size_t c) { return a_[r * n_ + c]; }
    const T& operator()(std::size_t r, std::size_t c) const { return a_[r * n_ + c]; }
    std::span<T> row(std::size_t r) { return {a_.data() + r * n_, n_}; }
    std::span<const T> row(std::size_t r) const { return {a_.data() + r * n_, n_}; }
    std::span<T> all() { return a_; }
    std::span<const T> all() const { return a_; }

private:
    std::size_t n_ = 0;
    std::vector<T> a_;
};

/// out = a b. out is neither of them.
void multiply(const SquareMatrix<double>& a, const SquareMatrix<double>& b, SquareMatrix<double>& out);

/// P A = L U by Gauss' elimination with partial pivoting on rows scaled to their largest element.
template <class T>
class Factors
{
public:
    /// A view of the matrix to fill; factorise() then destroys it.
    SquareMatrix<T>& matrix() { return a_; }
    /// False if the matrix is singular or not finite, or `stop` says so, which is asked for each column.
    template <class Stop>
    bool factorise(Stop stop);
    bool factorise()
    {
        return factorise([] { return false; });
    }
    void solve(std::span<T> b) const;

private:
    SquareMatrix<T> a_;
    std::vector<std::size_t> pivot_;
    std::vector<double> scale_;
};

template <class T>
template <class Stop>
bool Factors<T>::factorise(Stop stop)
{
    const std::size_t n = a_.size();
    pivot_.resize(n), scale_.resize(n);
    for (std::size_t i = 0; i < n; ++i)
    {
        double largest = 0;
        for (const T& value : a_.row(i)) largest = std::fmax(largest, magnitude(value));
        if (!(largest > 0) || !std::isfinite(largest)) return false;
        scale_[i] = 1 / largest;
    }
    for (std::size_t k = 0; k < n; ++k)
    {
        if (stop()) return false;
        std::size_t best = k;
        for (std::size_t i = k + 1; i < n; ++i)
            if (scale_[i] * magnitude(a_(i, k)) > scale_[best] * magnitude(a_(best, k))) best = i;
        if (!(magnitude(a_(best, k)) > 0)) return false;
        pivot_[k] = best;
        if (best != k)
        {
            for (std::size_t j = 0; j < n; ++j) std::swap(a_(k, j), a_(best, j));
            std::swap(scale_[k], scale_[best]);
        }
        const T inverse = reciprocal(a_(k, k));
        for (std::size_t i = k + 1; i < n; ++i)
        {
            if (magnitude(a_(i, k)) == 0) continue;
            const T factor = a_(i, k) * inverse;
            a_(i, k) = factor;
            const auto from = a_.row(k);
            const auto to = a_.row(i);
            for (std::size_t j = k + 1; j < n; ++j) to[j] = to[j] - factor * from[j];
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
    for (std::size_t i = 1; i < n; ++i)
        for (std::size_t j = 0; j < i; ++j) b[i] = b[i] - a_(i, j) * b[j];
    for (std::size_t i = n; i-- > 0;)
    {
        for (std::size_t j = i + 1; j < n; ++j) b[i] = b[i] - a_(i, j) * b[j];
        b[i] = b[i] * reciprocal(a_(i, i));
    }
}

}  // namespace plab::solvers
