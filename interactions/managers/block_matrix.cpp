#include "block_matrix.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace plab::managers
{
namespace
{

enum Kind : std::uint8_t
{
    kDiagonal,
    kUpper,
    kLower,
};

/// Explicit pairs of doubles, since the compiler does not vectorise these loops by itself. Each sum keeps its order, and so its
/// result.
using Two = double __attribute__((vector_size(16)));

Two load_two(const double* from)
{
    Two out;
    std::memcpy(&out, from, sizeof out);
    return out;
}

void store_two(double* to, Two value) { std::memcpy(to, &value, sizeof value); }

/// Two rows of a, from row i, times b; the sums run in the order of b's rows.
struct TwoRows
{
    Two first[3], second[3];

    [[gnu::always_inline]] TwoRows(const Block& a, std::size_t i, const Block& b) : first{}, second{}
    {
#pragma GCC unroll 6
        for (std::size_t k = 0; k < 6; ++k)
        {
            const double f = a[6 * i + k], g = a[6 * i + 6 + k];
            const Two both_f = {f, f}, both_g = {g, g};
#pragma GCC unroll 3
            for (std::size_t j = 0; j < 3; ++j)
            {
                const Two row = load_two(b.data() + 6 * k + 2 * j);
                first[j] += both_f * row, second[j] += both_g * row;
            }
        }
    }
};

/// c -= a b.
void subtract_product(Block& c, const Block& a, const Block& b)
{
    for (std::size_t i = 0; i < 6; i += 2)
    {
        const TwoRows rows(a, i, b);
#pragma GCC unroll 3
        for (std::size_t j = 0; j < 3; ++j)
        {
            double* to = c.data() + 6 * i + 2 * j;
            store_two(to, load_two(to) - rows.first[j]);
            store_two(to + 6, load_two(to + 6) - rows.second[j]);
        }
    }
}

Block product(const Block& a, const Block& b)
{
    Block c;
    for (std::size_t i = 0; i < 6; i += 2)
    {
        const TwoRows rows(a, i, b);
#pragma GCC unroll 3
        for (std::size_t j = 0; j < 3; ++j)
            store_two(c.data() + 6 * i + 2 * j, rows.first[j]), store_two(c.data() + 6 * i + 6 + 2 * j, rows.second[j]);
    }
    return c;
}

void subtract_product(Column6& y, const Block& a, const Column6& x)
{
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j) y[i] -= a[6 * i + j] * x[j];
}

Column6 product(const Block& a, const Column6& x)
{
    Column6 y{};
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j) y[i] += a[6 * i + j] * x[j];
    return y;
}

void swap_rows(Block& a, std::size_t i, std::size_t j)
{
    if (i != j)
        std::swap_ranges(a.begin() + static_cast<std::ptrdiff_t>(6 * i), a.begin() + static_cast<std::ptrdiff_t>(6 * i + 6),
                         a.begin() + static_cast<std::ptrdiff_t>(6 * j));
}

/// Gauss-Jordan elimination with row pivoting. Returns false if the block is singular.
bool invert(Block& a)
{
    Block inverse{};
    for (std::size_t i = 0; i < 6; ++i) inverse[7 * i] = 1;
    for (std::size_t k = 0; k < 6; ++k)
    {
        std::size_t pivot = k;
        for (std::size_t i = k + 1; i < 6; ++i)
            if (std::fabs(a[6 * i + k]) > std::fabs(a[6 * pivot + k])) pivot = i;
        if (!(std::fabs(a[6 * pivot + k]) > 0) || !std::isfinite(a[6 * pivot + k])) return false;
        swap_rows(a, k, pivot), swap_rows(inverse, k, pivot);
        const double f = 1 / a[7 * k];
        for (std::size_t j = 0; j < 6; ++j) a[6 * k + j] *= f, inverse[6 * k + j] *= f;
        for (std::size_t i = 0; i < 6; ++i)
        {
            const double g = a[6 * i + k];
            if (i == k || g == 0) continue;
            for (std::size_t j = 0; j < 6; ++j) a[6 * i + j] -= g * a[6 * k + j], inverse[6 * i + j] -= g * inverse[6 * k + j];
        }
    }
    a = inverse;
    return true;
}

}  // namespace

void BlockMatrix::shape(std::uint32_t n, std::span<const Edge> edges)
{
    if (n == size_ && std::equal(edges.begin(), edges.end(), edges_.begin(), edges_.end())) return;
    size_ = n;
    edges_.assign(edges.begin(), edges.end());
    order_nodes();
    plan_updates();
    diagonal_.resize(n), upper_.resize(earlier_.size()), lower_.resize(earlier_.size());
}

/// Minimum-degree order, the lowest number first among equals. The neighbours of an eliminated node become neighbours of one
/// another.
void BlockMatrix::order_nodes()
{
    if (neighbours_.size() < size_) neighbours_.resize(size_);
    for (std::uint32_t i = 0; i < size_; ++i) neighbours_[i].clear();
    for (const auto& [i, j] : edges_) neighbours_[i].push_back(j), neighbours_[j].push_back(i);
    for (std::uint32_t i = 0; i < size_; ++i) std::sort(neighbours_[i].begin(), neighbours_[i].end());
    order_.clear(), begin_.clear(), earlier_.clear(), later_.clear();
    rank_.assign(size_, UINT32_MAX);
    // A heap with the smallest degree on top; a node has one entry for each degree that it has had, and outdated entries are
    // skipped.
    const auto later = [](const Degree& x, const Degree& y) { return x > y; };
    heap_.clear();
    const auto note = [&](std::uint32_t i)
    {
        heap_.emplace_back(static_cast<std::uint32_t>(neighbours_[i].size()), i);
        std::push_heap(heap_.begin(), heap_.end(), later);
    };
    for (std::uint32_t i = 0; i < size_; ++i) note(i);
    while (!heap_.empty())
    {
        std::pop_heap(heap_.begin(), heap_.end(), later);
        const auto [degree, node] = heap_.back();
        heap_.pop_back();
        if (rank_[node] != UINT32_MAX || degree != neighbours_[node].size()) continue;
        rank_[node] = static_cast<std::uint32_t>(order_.size());
        order_.push_back(node);
        begin_.push_back(static_cast<std::uint32_t>(earlier_.size()));
        const std::vector<std::uint32_t>& around = neighbours_[node];
        for (const std::uint32_t i : around)
        {
            earlier_.push_back(node), later_.push_back(i);
            merged_.clear();
            std::set_union(neighbours_[i].begin(), neighbours_[i].end(), around.begin(), around.end(), std::back_inserter(merged_));
            std::erase_if(merged_, [i, node = node](std::uint32_t k) { return k == i || k == node; });
            neighbours_[i].assign(merged_.begin(), merged_.end());
            note(i);
        }
    }
    begin_.push_back(static_cast<std::uint32_t>(earlier_.size()));
}

std::uint32_t BlockMatrix::find(std::uint32_t i, std::uint32_t j) const
{
    const std::uint32_t node = rank_[i] < rank_[j] ? i : j, other = node == i ? j : i;
    const auto from = later_.begin() + begin_[rank_[node]], to = later_.begin() + begin_[rank_[node] + 1];
    return static_cast<std::uint32_t>(std::lower_bound(from, to, other) - later_.begin());
}

void BlockMatrix::plan_updates()
{
    targets_.clear(), first_target_.clear();
    for (std::uint32_t place = 0; place < size_; ++place)
    {
        first_target_.push_back(targets_.size());
        for (std::uint32_t p = begin_[place]; p < begin_[place + 1]; ++p)
            for (std::uint32_t q = begin_[place]; q < begin_[place + 1]; ++q)
            {
                const std::uint32_t i = later_[p], j = later_[q];
                if (i == j)
                    targets_.push_back({i, kDiagonal});
                else
                    targets_.push_back({find(i, j), rank_[i] < rank_[j] ? kUpper : kLower});
            }
    }
}

void BlockMatrix::clear()
{
    for (auto* blocks : {&diagonal_, &upper_, &lower_})
        for (Block& b : *blocks) b.fill(0);
}

void BlockMatrix::eliminate(std::uint32_t place)
{
    // upper becomes D^-1 U; the remaining matrix becomes A_ij - L_i D^-1 U_j.
    const std::uint32_t from = begin_[place], to = begin_[place + 1];
    for (std::uint32_t q = from; q < to; ++q) upper_[q] = product(diagonal_[order_[place]], upper_[q]);
    const Target* target = targets_.data() + first_target_[place];
    for (std::uint32_t p = from; p < to; ++p)
        for (std::uint32_t q = from; q < to; ++q, ++target)
        {
            Block& b = target->kind == kDiagonal ? diagonal_[target->at] : target->kind == kUpper ? upper_[target->at] : lower_[target->at];
            subtract_product(b, lower_[p], upper_[q]);
        }
}

bool BlockMatrix::factor(const Interruption* interruption)
{
    for (std::uint32_t place = 0; place < size_; ++place)
    {
        if (interruption && interruption->due()) return false;
        if (!invert(diagonal_[order_[place]])) return false;
        eliminate(place);
    }
    return true;
}

void BlockMatrix::solve(std::span<Column6> x) const
{
    for (std::uint32_t place = 0; place < size_; ++place)
    {
        Column6& own = x[order_[place]];
        own = product(diagonal_[order_[place]], own);
        for (std::uint32_t p = begin_[place]; p < begin_[place + 1]; ++p) subtract_product(x[later_[p]], lower_[p], own);
    }
    for (std::uint32_t place = size_; place-- > 0;)
        for (std::uint32_t p = begin_[place]; p < begin_[place + 1]; ++p) subtract_product(x[order_[place]], upper_[p], x[later_[p]]);
}

}  // namespace plab::managers
