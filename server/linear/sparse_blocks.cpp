#include "linear/sparse_blocks.h"

#include <algorithm>
#include <cmath>

#include "plab/eigen.h"

namespace plab::linear
{
namespace
{

constexpr int kMost = static_cast<int>(SparseBlocks::kMostSize);

/// A row of a block. All arithmetic is on whole rows of fixed length, which Eigen keeps in registers. Each element has a sum of its own
/// in a fixed order, which does not depend on the number of doubles that are computed at a time.
template <int C>
using BlockRow = Eigen::Array<double, C, 1>;
template <int C>
Eigen::Map<BlockRow<C>> row_at(double* at)
{
    return Eigen::Map<BlockRow<C>>(at);
}
template <int C>
Eigen::Map<const BlockRow<C>> row_at(const double* at)
{
    return Eigen::Map<const BlockRow<C>>(at);
}

/// A row of zeros gets a pivot of 1, since its multiplier has no effect.
double raised(double pivot, double entry, double lift)
{
    const double p = std::fmax(pivot, 0.0) + lift + SparseBlocks::kRaised * std::fmax(entry, 0.0);
    return p > 0 ? p : 1.0;
}

/// Gauss-Jordan elimination with row pivoting. Returns false if the block is singular. Eigen's inverse of a 6 x 6 matrix uses its
/// triangular solver for large matrices and takes 1.8 times as long (tests/unit/simulation_rows/small_blocks_test.cpp).
bool invert(double* a)
{
    constexpr int n = kMost;
    double inverse[n * n] = {};
    for (int i = 0; i < n; ++i) inverse[i * (n + 1)] = 1;
    for (int k = 0; k < n; ++k)
    {
        int pivot = k;
        for (int i = k + 1; i < n; ++i)
            if (std::fabs(a[i * n + k]) > std::fabs(a[pivot * n + k])) pivot = i;
        const double p = a[pivot * n + k];
        if (!(std::fabs(p) > 0) || !std::isfinite(p)) return false;
        auto row = row_at<n>(a + k * n), inverse_row = row_at<n>(inverse + k * n);
        if (pivot != k) row.swap(row_at<n>(a + pivot * n)), inverse_row.swap(row_at<n>(inverse + pivot * n));
        const double f = 1 / p;
        row *= f, inverse_row *= f;
        for (int i = 0; i < n; ++i)
        {
            const double g = a[i * n + k];
            if (i == k || g == 0) continue;
            row_at<n>(a + i * n) -= g * row, row_at<n>(inverse + i * n) -= g * inverse_row;
        }
    }
    std::copy(inverse, inverse + n * n, a);
    return true;
}

/// The sum of w_k U_k over the K rows of U, in this order.
template <int K, int C>
BlockRow<C> combined(const double* w, const double* u)
{
    BlockRow<C> sum = w[0] * row_at<C>(u);
    for (int k = 1; k < K; ++k) sum += w[k] * row_at<C>(u + k * C);
    return sum;
}

/// A -= W U: A (rows x C), W (rows x K), U (K x C). Two rows at a time, for which a row of U is read once.
template <int K, int C>
void subtract_product(double* a, const double* w, const double* u, std::uint32_t rows)
{
    for (; rows > 1; rows -= 2, a += 2 * C, w += 2 * K)
    {
        BlockRow<C> first = w[0] * row_at<C>(u), second = w[K] * row_at<C>(u);
        for (int k = 1; k < K; ++k) first += w[k] * row_at<C>(u + k * C), second += w[K + k] * row_at<C>(u + k * C);
        row_at<C>(a) -= first, row_at<C>(a + C) -= second;
    }
    if (rows == 1) row_at<C>(a) -= combined<K, C>(w, u);
}

/// The same for a symmetric A, of which only the lower triangle is read. Eigen does not vectorise rows of odd length, and then computing
/// half of A is faster.
template <int K, int C>
void subtract_symmetric(double* a, const double* w, const double* u)
{
    if constexpr (C % 2 == 0)
        return subtract_product<K, C>(a, w, u, C);
    else
        for (int r = 0; r < C; ++r, a += C, w += K)
            for (int c = 0; c <= r; ++c)
            {
                double sum = w[0] * u[c];
                for (int k = 1; k < K; ++k) sum += w[k] * u[k * C + c];
                a[c] -= sum;
            }
}

/// B = D B, of blocks of full size.
void multiply_from_left(const double* d, double* b)
{
    double product[kMost * kMost];
    for (int r = 0; r < kMost; ++r) row_at<kMost>(product + r * kMost) = combined<kMost, kMost>(d + r * kMost, b);
    std::copy(product, product + kMost * kMost, b);
}

/// U = L^-1 A^T and W = U^T D^-1, of a block A (R x K) below the pivot; A becomes W.
template <int K, int R>
void divide(double* w, const double* l, const double* inverse, double* u)
{
    for (int c = 0; c < K; ++c)
    {
        auto row = row_at<R>(u + c * R);
        for (int r = 0; r < R; ++r) row[r] = w[r * K + c];
        for (int k = 0; k < c; ++k) row -= l[c * K + k] * row_at<R>(u + k * R);
    }
    for (int r = 0; r < R; ++r)
        for (int c = 0; c < K; ++c) w[r * K + c] = u[c * R + r] * inverse[c];
}

/// The sum of a_k b_k over a row of a block, in this order.
template <int K>
double dot_of(const double* a, const double* b)
{
    double sum = a[0] * b[0];
    for (int k = 1; k < K; ++k) sum += a[k] * b[k];
    return sum;
}

/// Calls f<size>(), so that loops over a block have a fixed length.
template <class F>
auto with_size(std::uint32_t size, F f)
{
    switch (size)
    {
        case 1:
            return f.template operator()<1>();
        case 2:
            return f.template operator()<2>();
        case 3:
            return f.template operator()<3>();
        case 4:
            return f.template operator()<4>();
        case 5:
            return f.template operator()<5>();
        default:
            return f.template operator()<6>();
    }
}

}  // namespace

void SparseBlocks::clear()
{
    std::fill(values_.begin(), values_.end(), 0.0);
    std::fill(upper_.begin(), upper_.end(), 0.0);
}

/// L D L^T of the pivot block, right-looking: after column c the rest of the block is the remaining matrix.
///
/// The pivots of a quasi-definite matrix have known signs, + for masses and - for joints; `p` is the pivot times its sign. In exact
/// arithmetic it is not negative. It becomes 0 if the other rows of a joint imply this row, and then only rounding errors of the entries
/// that cancelled are left of it, with any sign: dividing by them would give arbitrary multipliers. Such a pivot is recognised by its size
/// relative to the entry before the elimination of the block, and raised. A raised pivot is a compliance in that row: its multiplier stays
/// small, and the caller removes the error by iterative refinement against the original matrix (row_equations.h).
template <int K>
void SparseBlocks::factor_pivot(std::uint32_t node, double* d)
{
    const double sign = nodes_[node].negative ? -1.0 : 1.0;
    const std::uint32_t base = offset_[node];
    double entry[K];
    for (int c = 0; c < K; ++c) entry[c] = sign * d[c * K + c];
    for (int c = 0; c < K; ++c)
    {
        const std::uint32_t u = base + static_cast<std::uint32_t>(c);
        double p = sign * d[c * K + c];
        pivot_[u] = p;
        small_[u] = p > floor_[u] && p > kDependent * entry[c] ? 0 : 1;
        if (small_[u] != 0) p = raised(p, entry[c], lift_[u]);
        const double inverse = sign / p;
        inverse_[u] = inverse;
        // The column before its division by the pivot: the update needs l_r d l_k, and left[k] is d l_k.
        double left[K];
        for (int r = c + 1; r < K; ++r) left[r] = d[r * K + c];
        for (int r = c + 1; r < K; ++r)
        {
            const double l = left[r] * inverse;
            for (int k = c + 1; k <= r; ++k) d[r * K + k] -= l * left[k];
            d[r * K + c] = l;
        }
    }
}

/// A_ij -= W_i U_j for i >= j, because the remaining matrix is symmetric.
template <int K>
void SparseBlocks::update(const Pivot& p)
{
    const Below* below = below_.data() + p.first;
    const double* u = scratch_.data();
    for (std::uint32_t j = 0; j < p.count; ++j, u += kMost * K)
        with_size(below[j].size,
                  [&]<int C>()
                  {
                      subtract_symmetric<K, C>(&values_[target(p, j, j)], &values_[below[j].offset], u);
                      for (std::uint32_t i = j + 1; i < p.count; ++i)
                          subtract_product<K, C>(&values_[target(p, i, j)], &values_[below[i].offset], u, below[i].size);
                  });
}

/// A_ij -= L_i U_j on both sides of the diagonal, after U has become D^-1 U.
void SparseBlocks::eliminate_general(const Pivot& p)
{
    const double* d = &values_[diagonal_[p.node]];
    const Below* below = below_.data() + p.first;
    const auto subtract = [&](double* a, std::uint32_t i, std::uint32_t j)
    { subtract_product<kMost, kMost>(a, &values_[below[i].offset], &upper_[below[j].offset], kMostSize); };
    for (std::uint32_t i = 0; i < p.count; ++i) multiply_from_left(d, &upper_[below[i].offset]);
    for (std::uint32_t i = 0; i < p.count; ++i)
    {
        for (std::uint32_t j = 0; j < i; ++j) subtract(&values_[target(p, i, j)], i, j), subtract(&upper_[target(p, i, j)], j, i);
        subtract(&values_[target(p, i, i)], i, i);
    }
}

template <int K>
void SparseBlocks::eliminate(const Pivot& p)
{
    double* d = &values_[diagonal_[p.node]];
    const Below* below = below_.data() + p.first;
    // Block elimination of this node: D = L_p D_p L_p^T here, then W = A L_p^-T D_p^-1 for each block A below, and at last the Schur
    // complement, A_ij - A_i D^-1 A_j^T for each pair of blocks below. The order of elimination has made room for its fill.
    factor_pivot<K>(p.node, d);
    const double* inverse = &inverse_[offset_[p.node]];
    double* u = scratch_.data();
    for (std::uint32_t i = 0; i < p.count; ++i, u += kMost * K)
        with_size(below[i].size, [&]<int R>() { divide<K, R>(&values_[below[i].offset], d, inverse, u); });
    update<K>(p);
}

void SparseBlocks::add_outer(double* block, std::span<const double, kMostSize> x, std::span<const double, kMostSize> y, double g)
{
    const BlockRow<kMost> row = row_at<kMost>(y.data());
    for (std::size_t r = 0; r < kMostSize; ++r) row_at<kMost>(block + r * kMostSize) += g * x[r] * row;
}

bool SparseBlocks::factor(const Interruption* interruption)
{
    for (const Pivot& p : pivots_)
    {
        if (interruption && interruption->due()) return false;
        if (kind_ == Kind::General)
        {
            if (!invert(&values_[diagonal_[p.node]])) return false;
            eliminate_general(p);
        }
        else
            with_size(nodes_[p.node].size, [&]<int K>() { eliminate<K>(p); });
    }
    return true;
}

template <int K>
void SparseBlocks::forward(const Pivot& p, double* x) const
{
    // y = L^-1 x for the pivot block, or D^-1 x if the matrix is general; then W y is subtracted from the later blocks.
    const double* d = &values_[diagonal_[p.node]];
    double* y = x + offset_[p.node];
    if (kind_ == Kind::General)
    {
        BlockRow<K> whole;
        for (int r = 0; r < K; ++r) whole[r] = dot_of<K>(d + r * K, y);
        row_at<K>(y) = whole;
    }
    else
        for (int c = 0; c < K; ++c)
            for (int r = c + 1; r < K; ++r) y[r] -= d[r * K + c] * y[c];
    for (std::uint32_t i = 0; i < p.count; ++i)
    {
        const Below& b = below_[p.first + i];
        const double* w = &values_[b.offset];
        double* z = x + offset_[b.node];
        for (std::uint32_t r = 0; r < b.size; ++r, w += K) z[r] -= dot_of<K>(w, y);
    }
}

template <int K>
void SparseBlocks::backward(const Pivot& p, double* x) const
{
    double* y = x + offset_[p.node];
    if (kind_ == Kind::General)
    {
        for (std::uint32_t i = 0; i < p.count; ++i)
        {
            const Below& b = below_[p.first + i];
            for (int r = 0; r < K; ++r) y[r] -= dot_of<K>(&upper_[b.offset + static_cast<std::uint32_t>(r * K)], x + offset_[b.node]);
        }
        return;
    }
    const double* d = &values_[diagonal_[p.node]];
    row_at<K>(y) *= row_at<K>(&inverse_[offset_[p.node]]);
    for (std::uint32_t i = 0; i < p.count; ++i)
    {
        const Below& b = below_[p.first + i];
        const double* z = x + offset_[b.node];
        for (std::uint32_t r = 0; r < b.size; ++r) row_at<K>(y) -= z[r] * row_at<K>(&values_[b.offset + r * K]);
    }
    for (int c = K - 1; c > 0; --c)
        for (int k = 0; k < c; ++k) y[k] -= d[c * K + k] * y[c];
}

void SparseBlocks::solve(std::span<double> x) const
{
    for (const Pivot& p : pivots_) with_size(nodes_[p.node].size, [&]<int K>() { forward<K>(p, x.data()); });
    for (std::size_t i = pivots_.size(); i-- > 0;)
        with_size(nodes_[pivots_[i].node].size, [&]<int K>() { backward<K>(pivots_[i], x.data()); });
}

}  // namespace plab::linear
