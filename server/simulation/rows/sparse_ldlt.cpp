#include "simulation/rows/sparse_ldlt.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace plab::simulation
{
namespace
{

/// sum a_k b_k over a whole row of a block, in one fixed order.
template <int K>
double dot_of(const double* a, const double* b)
{
    double sum = a[0] * b[0];
    for (int k = 1; k < K; ++k) sum += a[k] * b[k];
    return sum;
}

/// A row of zeros gets a pivot of 1: whatever its multiplier, it does nothing.
double raised(double pivot, double entry, double lift)
{
    const double p = std::fmax(pivot, 0.0) + lift + SparseLdlt::kRaised * std::fmax(entry, 0.0);
    return p > 0 ? p : 1.0;
}

}  // namespace

void SparseLdlt::analyse(std::span<const SparseNode> nodes, std::span<const SparseEdge> edges)
{
    nodes_.assign(nodes.begin(), nodes.end());
    order_ = order_of_elimination(nodes, edges);
    rank_.resize(nodes.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) rank_[order_[i]] = i;

    // Whoever comes later and is joined, by an edge or by fill.
    std::vector<std::vector<std::uint32_t>> later(nodes.size());
    for (const SparseEdge& e : edges) rank_[e.joint] < rank_[e.body] ? later[e.joint].push_back(e.body) : later[e.body].push_back(e.joint);
    const auto by_rank = [this](std::uint32_t a, std::uint32_t b) { return rank_[a] < rank_[b]; };
    for (const std::uint32_t k : order_)
    {
        auto& mine = later[k];
        std::sort(mine.begin(), mine.end(), by_rank);
        mine.erase(std::unique(mine.begin(), mine.end()), mine.end());
        // The first of them takes over all others; the rest follows from it in turn.
        if (mine.size() > 1) later[mine[0]].insert(later[mine[0]].end(), mine.begin() + 1, mine.end());
    }
    lay_out(edges, later);
}

void SparseLdlt::lay_out(std::span<const SparseEdge> edges, const std::vector<std::vector<std::uint32_t>>& later)
{
    offset_.resize(nodes_.size()), diagonal_.resize(nodes_.size());
    std::uint32_t unknowns = 0, used = 0;
    for (std::uint32_t i = 0; i < nodes_.size(); ++i)
    {
        assert(nodes_[i].size >= 1 && nodes_[i].size <= kMostSize);
        offset_[i] = unknowns, unknowns += nodes_[i].size;
    }
    pivots_.clear(), below_.clear(), targets_.clear();
    std::vector<std::uint32_t> first_below(nodes_.size());
    for (const std::uint32_t k : order_)
    {
        first_below[k] = static_cast<std::uint32_t>(below_.size());
        pivots_.push_back({k, first_below[k], static_cast<std::uint32_t>(later[k].size()), 0});
        diagonal_[k] = used, used += nodes_[k].size * nodes_[k].size;
        for (const std::uint32_t i : later[k]) below_.push_back({i, used, nodes_[i].size}), used += nodes_[i].size * nodes_[k].size;
    }
    // Block (i, j) is stored with j, the earlier one.
    const auto block_of = [&](std::uint32_t i, std::uint32_t j)
    {
        const auto begin = below_.begin() + first_below[j];
        const auto end = begin + static_cast<std::ptrdiff_t>(later[j].size());
        const auto found = std::lower_bound(begin, end, rank_[i], [this](const Below& b, std::uint32_t r) { return rank_[b.node] < r; });
        assert(found != end && found->node == i);
        return found->offset;
    };
    for (Pivot& p : pivots_)
    {
        p.targets = static_cast<std::uint32_t>(targets_.size());
        for (std::uint32_t i = 0; i < p.count; ++i)
            for (std::uint32_t j = 0; j <= i; ++j)
                targets_.push_back(i == j ? diagonal_[later[p.node][i]] : block_of(later[p.node][i], later[p.node][j]));
    }
    place_.clear();
    for (const SparseEdge& e : edges)
    {
        const bool joint_first = rank_[e.joint] < rank_[e.body];
        const std::uint32_t at = joint_first ? block_of(e.body, e.joint) : block_of(e.joint, e.body);
        place_.push_back(joint_first ? Place{at, 1, nodes_[e.joint].size} : Place{at, nodes_[e.body].size, 1});
    }
    values_.assign(used, 0.0);
    std::size_t widest = 0;
    for (const Pivot& p : pivots_) widest = std::max<std::size_t>(widest, p.count);
    scratch_.assign(widest * kMostSize * kMostSize, 0.0);
    for (auto* v : {&inverse_, &pivot_, &floor_, &lift_}) v->assign(unknowns, 0.0);
    small_.assign(unknowns, 0);
}

void SparseLdlt::clear() { std::fill(values_.begin(), values_.end(), 0.0); }

/// Right-looking: after column c the rest of the block is what is left of it.
template <int K>
void SparseLdlt::factor_pivot(std::uint32_t node, double* d)
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

template <int K>
void SparseLdlt::eliminate(const Pivot& p)
{
    double* d = &values_[diagonal_[p.node]];
    factor_pivot<K>(p.node, d);
    const double* inverse = &inverse_[offset_[p.node]];
    const Below* below = below_.data() + p.first;
    double* u = scratch_.data();
    for (std::uint32_t i = 0; i < p.count; ++i)
    {
        // U = A L^-T, W = U D^-1
        double* w = &values_[below[i].offset];
        for (std::uint32_t r = 0; r < below[i].size; ++r, w += K, u += K)
            for (int c = 0; c < K; ++c)
            {
                double x = w[c];
                for (int k = 0; k < c; ++k) x -= u[k] * d[c * K + k];
                u[c] = x;
            }
        w -= static_cast<std::ptrdiff_t>(below[i].size) * K, u -= static_cast<std::ptrdiff_t>(below[i].size) * K;
        for (std::uint32_t r = 0; r < below[i].size; ++r, w += K, u += K)
            for (int c = 0; c < K; ++c) w[c] = u[c] * inverse[c];
    }
    update<K>(p);
}

/// A_ij -= W_i U_j^T
template <int K>
void SparseLdlt::update(const Pivot& p)
{
    const std::uint32_t* target = targets_.data() + p.targets;
    const Below* below = below_.data() + p.first;
    for (std::uint32_t i = 0; i < p.count; ++i)
    {
        const double* u = scratch_.data();
        for (std::uint32_t j = 0; j <= i; ++j, ++target)
        {
            const double* w = &values_[below[i].offset];
            double* a = &values_[*target];
            const std::uint32_t columns = below[j].size;
            for (std::uint32_t r = 0; r < below[i].size; ++r, w += K, a += columns)
            {
                const std::uint32_t end = i == j ? r + 1 : columns;
                for (std::uint32_t c = 0; c < end; ++c) a[c] -= dot_of<K>(w, u + c * K);
            }
            u += static_cast<std::size_t>(columns) * K;
        }
    }
}

void SparseLdlt::factor()
{
    for (const Pivot& p : pivots_) switch (nodes_[p.node].size)
        {
            case 1:
                eliminate<1>(p);
                break;
            case 2:
                eliminate<2>(p);
                break;
            case 3:
                eliminate<3>(p);
                break;
            case 4:
                eliminate<4>(p);
                break;
            case 5:
                eliminate<5>(p);
                break;
            default:
                eliminate<6>(p);
                break;
        }
}

template <int K>
void SparseLdlt::forward(const Pivot& p, double* x) const
{
    // y = L^-1 x of this block; the later ones lose W y.
    const double* d = &values_[diagonal_[p.node]];
    double* y = x + offset_[p.node];
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
void SparseLdlt::backward(const Pivot& p, double* x) const
{
    const double* d = &values_[diagonal_[p.node]];
    double* y = x + offset_[p.node];
    const double* inverse = &inverse_[offset_[p.node]];
    for (int c = 0; c < K; ++c) y[c] *= inverse[c];
    for (std::uint32_t i = 0; i < p.count; ++i)
    {
        const Below& b = below_[p.first + i];
        const double* w = &values_[b.offset];
        const double* z = x + offset_[b.node];
        for (std::uint32_t r = 0; r < b.size; ++r, w += K)
            for (int c = 0; c < K; ++c) y[c] -= w[c] * z[r];
    }
    for (int c = K - 1; c > 0; --c)
        for (int k = 0; k < c; ++k) y[k] -= d[c * K + k] * y[c];
}

void SparseLdlt::solve(std::span<double> x) const
{
    for (const Pivot& p : pivots_) switch (nodes_[p.node].size)
        {
            case 1:
                forward<1>(p, x.data());
                break;
            case 2:
                forward<2>(p, x.data());
                break;
            case 3:
                forward<3>(p, x.data());
                break;
            case 4:
                forward<4>(p, x.data());
                break;
            case 5:
                forward<5>(p, x.data());
                break;
            default:
                forward<6>(p, x.data());
                break;
        }
    for (std::size_t i = pivots_.size(); i-- > 0;)
    {
        const Pivot& p = pivots_[i];
        switch (nodes_[p.node].size)
        {
            case 1:
                backward<1>(p, x.data());
                break;
            case 2:
                backward<2>(p, x.data());
                break;
            case 3:
                backward<3>(p, x.data());
                break;
            case 4:
                backward<4>(p, x.data());
                break;
            case 5:
                backward<5>(p, x.data());
                break;
            default:
                backward<6>(p, x.data());
                break;
        }
    }
}

}  // namespace plab::simulation
