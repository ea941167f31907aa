// The order of elimination, the fill that it causes, and the storage of the blocks.
#include <algorithm>
#include <cassert>
#include <functional>
#include <iterator>

#include "linear/sparse_blocks.h"

namespace plab::linear
{
namespace
{

constexpr std::uint32_t kNotYet = UINT32_MAX;

}  // namespace

void SparseBlocks::analyse(std::span<const SparseNode> nodes, std::span<const SparseEdge> edges)
{
    nodes_.assign(nodes.begin(), nodes.end());
    order_nodes(edges);
    lay_out();
    find_targets();
    find_places(edges);
}

/// The pivot of a joint is regular once enough of its bodies have been eliminated: in a tree at least one and all but one, in a loop all.
bool SparseBlocks::eligible(std::uint32_t i) const
{
    const SparseNode& node = nodes_[i];
    if (!node.negative) return true;
    if (regular_[i] == 0) return false;
    std::uint32_t bodies = 0, remaining = SparseNode::kAnyBody;
    for (const std::uint32_t j : neighbours_[i])
        if (!nodes_[j].negative) ++bodies, remaining = j;
    return bodies == 0 || (bodies == 1 && node.early && (node.last == SparseNode::kAnyBody || node.last == remaining));
}

/// The heap has the least degree on top, and the lower number among equals. A node has one entry for each degree that it has had, and
/// outdated entries are skipped.
void SparseBlocks::note(std::uint32_t i)
{
    if (!eligible(i)) return;
    heap_.emplace_back(static_cast<std::uint32_t>(neighbours_[i].size()), i);
    std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
}

void SparseBlocks::start_order(std::span<const SparseEdge> edges)
{
    const std::size_t n = nodes_.size();
    if (neighbours_.size() < n) neighbours_.resize(n);
    for (std::size_t i = 0; i < n; ++i) neighbours_[i].clear();
    for (const SparseEdge& e : edges) neighbours_[e.a].push_back(e.b), neighbours_[e.b].push_back(e.a);
    for (std::size_t i = 0; i < n; ++i) std::sort(neighbours_[i].begin(), neighbours_[i].end());
    pivots_.clear(), below_.clear(), heap_.clear();
    rank_.assign(n, kNotYet), regular_.assign(n, 0);
    for (std::uint32_t i = 0; i < n; ++i) note(i);
}

/// The remaining neighbours of an eliminated node are its blocks below the diagonal, and become connected to one another.
void SparseBlocks::eliminate_from_graph(std::uint32_t node)
{
    rank_[node] = static_cast<std::uint32_t>(pivots_.size());
    const std::vector<std::uint32_t>& around = neighbours_[node];
    pivots_.push_back({node, static_cast<std::uint32_t>(below_.size()), static_cast<std::uint32_t>(around.size()), 0});
    for (const std::uint32_t i : around)
    {
        below_.push_back({i, 0, nodes_[i].size});
        if (!nodes_[node].negative) regular_[i] = 1;
        merged_.clear();
        std::set_union(neighbours_[i].begin(), neighbours_[i].end(), around.begin(), around.end(), std::back_inserter(merged_));
        std::erase_if(merged_, [i, node](std::uint32_t k) { return k == i || k == node; });
        neighbours_[i].assign(merged_.begin(), merged_.end());
        note(i);
    }
}

/// Minimum degree: always eliminates the node with the fewest remaining neighbours, because n neighbours become n (n - 1) / 2 pairs, and
/// each pair without an edge is a new block. The elimination is carried out on the graph, so the blocks of the factor are known before
/// any number is. Joints wait for their bodies (eligible): the diagonal block of a joint is 0, or a small compliance, until a body beside
/// it has been eliminated, which subtracts J M^-1 J^T from it. In a tree of joints, the leaves have the least degree and are eliminated
/// first, without any fill.
void SparseBlocks::order_nodes(std::span<const SparseEdge> edges)
{
    start_order(edges);
    while (!heap_.empty())
    {
        std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
        const auto [degree, node] = heap_.back();
        heap_.pop_back();
        if (rank_[node] == kNotYet && degree == neighbours_[node].size() && eligible(node)) eliminate_from_graph(node);
    }
    assert(pivots_.size() == nodes_.size());
}

void SparseBlocks::lay_out()
{
    offset_.resize(nodes_.size()), diagonal_.resize(nodes_.size());
    std::uint32_t unknowns = 0, used = 0;
    for (std::uint32_t i = 0; i < nodes_.size(); ++i)
    {
        assert(nodes_[i].size >= (kind_ == Kind::General ? kMostSize : 1) && nodes_[i].size <= kMostSize);
        offset_[i] = unknowns, unknowns += nodes_[i].size;
    }
    for (const Pivot& p : pivots_)
    {
        const auto begin = below_.begin() + p.first, end = begin + p.count;
        std::sort(begin, end, [this](const Below& x, const Below& y) { return rank_[x.node] < rank_[y.node]; });
        const std::uint32_t size = nodes_[p.node].size;
        diagonal_[p.node] = used, used += size * size;
        for (auto b = begin; b != end; ++b) b->offset = used, used += b->size * size;
    }
    make_room(unknowns, used);
}

void SparseBlocks::make_room(std::uint32_t unknowns, std::uint32_t used)
{
    values_.assign(used, 0.0);
    if (kind_ == Kind::General) upper_.assign(used, 0.0);
    std::size_t widest = 1;
    for (const Pivot& p : pivots_) widest = std::max<std::size_t>(widest, p.count);
    scratch_.assign(widest * kMostSize * kMostSize, 0.0);
    for (auto* v : {&inverse_, &pivot_, &floor_, &lift_}) v->assign(unknowns, 0.0);
    small_.assign(unknowns, 0);
}

std::uint32_t SparseBlocks::find(std::uint32_t i, std::uint32_t j) const
{
    const std::uint32_t later = std::max(rank_[i], rank_[j]);
    const Pivot& p = pivots_[std::min(rank_[i], rank_[j])];
    const auto begin = below_.begin() + p.first, end = begin + p.count;
    const auto found = std::lower_bound(begin, end, later, [this](const Below& b, std::uint32_t r) { return rank_[b.node] < r; });
    assert(found != end && rank_[found->node] == later);
    return static_cast<std::uint32_t>(found - below_.begin());
}

/// Lists the blocks that each elimination changes, so that the numeric factorisation needs no search.
void SparseBlocks::find_targets()
{
    targets_.clear();
    for (Pivot& p : pivots_)
    {
        p.targets = static_cast<std::uint32_t>(targets_.size());
        const Below* below = below_.data() + p.first;
        for (std::uint32_t i = 0; i < p.count; ++i)
        {
            for (std::uint32_t j = 0; j < i; ++j) targets_.push_back(below_[find(below[i].node, below[j].node)].offset);
            targets_.push_back(diagonal_[below[i].node]);
        }
    }
}

void SparseBlocks::find_places(std::span<const SparseEdge> edges)
{
    place_.clear();
    for (const SparseEdge& e : edges)
    {
        const std::uint32_t at = below_[find(e.a, e.b)].offset;
        place_.push_back(rank_[e.a] < rank_[e.b] ? BlockStrides{at, 1, nodes_[e.a].size} : BlockStrides{at, nodes_[e.b].size, 1});
    }
}

std::size_t SparseBlocks::products() const
{
    std::size_t sum = 0;
    for (const Pivot& p : pivots_) sum += std::size_t{p.count} * (p.count + 1);
    return sum;
}

}  // namespace plab::linear
