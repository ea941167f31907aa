/// A binary bounding-volume tree of axis-aligned boxes: finds which of n boxes overlap a given one, in about log n tests.
///
/// It is built top-down by splitting at the median along the longest axis. A box that moves later is removed and reinserted
/// where it enlarges the tree least (surface area heuristic, Goldsmith and Salmon 1987); if many have moved, the boxes of the
/// inner nodes are fitted again instead. The shape of the tree depends on that history, but the set of boxes that a query finds
/// does not.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "geometry/box.h"

namespace plab::geometry
{

class BoxTree
{
public:
    /// Builds the tree of `items`; boxes[i] is the box of item i.
    void build(std::span<const Box> boxes, std::span<const std::uint32_t> items);
    /// Changes the box of an item that was passed to build().
    void move(std::uint32_t item, const Box& box);
    /// Changes the boxes of `items` at once and keeps the branches of the tree. False: it has become worth a new build().
    bool refit(std::span<const Box> boxes, std::span<const std::uint32_t> items);
    /// Calls found(item) for each item whose box overlaps `box`; the order is unspecified.
    template <class Found>
    void query(const Box& box, Found&& found)
    {
        query(box, stack_, found);
    }
    /// The same with scratch memory of the caller, so that several threads may search at a time.
    template <class Found>
    void query(const Box& box, std::vector<std::uint32_t>& stack, Found&& found) const
    {
        if (root_ == kNone) return;
        stack.assign(1, root_);
        while (!stack.empty())
        {
            const Node& node = nodes_[stack.back()];
            stack.pop_back();
            if (!overlap(node.box, box)) continue;
            if (node.left == kNone)
                found(node.item);
            else
                stack.push_back(node.left), stack.push_back(node.right);
        }
    }

    /// Two nodes between which pairs of items are searched for; twice the same: among its items.
    using NodePair = std::pair<std::uint32_t, std::uint32_t>;
    /// Divides the search for all pairs of items with overlapping boxes into at least `parts` parts, if there is as much to do. The
    /// division depends on the tree alone. Valid until the tree changes.
    std::span<const NodePair> divide_pairs(std::size_t parts);
    /// Calls found(i, j) once for each pair of items of one part whose boxes overlap; the order, also of i and j, is unspecified.
    /// `stack`: scratch memory.
    template <class Found>
    void query_pairs(const NodePair& part, std::vector<NodePair>& stack, Found&& found) const
    {
        stack.assign(1, part);
        while (!stack.empty())
        {
            const NodePair pair = stack.back();
            stack.pop_back();
            const Node &one = nodes_[pair.first], &other = nodes_[pair.second];
            if (pair.first != pair.second && !overlap(one.box, other.box)) continue;
            if (pair.first == pair.second || one.left != kNone || other.left != kNone)
                push_inner_pairs(pair, stack);
            else
                found(one.item, other.item);
        }
    }

private:
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};
    struct Node
    {
        Box box;
        std::uint32_t parent = kNone;
        std::uint32_t left = kNone, right = kNone;  // kNone: this is a leaf
        std::uint32_t item = 0;                     // of a leaf only
    };
    /// The pairs of children that a pair of nodes consists of; none for a leaf with itself.
    void push_inner_pairs(const NodePair& pair, std::vector<NodePair>& to) const
    {
        const auto [a, b] = pair;
        const Node &one = nodes_[a], &other = nodes_[b];
        if (a == b)
        {
            if (one.left != kNone) to.insert(to.end(), {{one.left, one.right}, {one.left, one.left}, {one.right, one.right}});
        }
        else if (other.left == kNone || (one.left != kNone && half_surface(one.box) >= half_surface(other.box)))
            to.insert(to.end(), {{one.left, b}, {one.right, b}});
        else
            to.insert(to.end(), {{a, other.left}, {a, other.right}});
    }
    struct Task  // items [first, end) become the subtree at `node`
    {
        std::uint32_t node, first, end;
    };
    void split(const Task& task, std::span<const Box> boxes);
    std::uint32_t take_out(std::uint32_t leaf);
    std::uint32_t best_sibling(const Box& box) const;
    void put_in(std::uint32_t leaf, std::uint32_t free_node);
    void refit_upwards(std::uint32_t node);
    double surface_of_branches() const;

    std::vector<Node> nodes_;
    std::uint32_t root_ = kNone;
    double built_surface_ = 0;  // m^2, of all inner nodes when the tree was built
    std::vector<std::uint32_t> leaf_of_item_;
    std::vector<std::uint32_t> stack_, order_;        // scratch
    std::vector<NodePair> node_pairs_, inner_pairs_;  // scratch
    std::vector<Task> tasks_;                         // scratch
};

}  // namespace plab::geometry
