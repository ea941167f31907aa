/// A binary bounding-volume tree of axis-aligned boxes: finds which of n boxes overlap a given one, in about log n tests.
///
/// It is built top-down by splitting at the median along the longest axis. A box that moves later is removed and reinserted
/// where it enlarges the tree least (surface area heuristic, Goldsmith and Salmon 1987). The shape of the tree depends on that
/// history, but the set of boxes that a query finds does not.
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
    /// Calls found(item) for each item whose box overlaps `box`; the order is unspecified.
    template <class Found>
    void query(const Box& box, Found&& found)
    {
        if (root_ == kNone) return;
        stack_.assign(1, root_);
        while (!stack_.empty())
        {
            const Node& node = nodes_[stack_.back()];
            stack_.pop_back();
            if (!overlap(node.box, box)) continue;
            if (node.left == kNone)
                found(node.item);
            else
                stack_.push_back(node.left), stack_.push_back(node.right);
        }
    }

    /// Calls found(i, j) once for each pair of items whose boxes overlap; the order, also of i and j, is unspecified.
    template <class Found>
    void query_pairs(Found&& found)
    {
        if (root_ == kNone) return;
        node_pairs_.assign(1, {root_, root_});
        while (!node_pairs_.empty())
        {
            const auto [a, b] = node_pairs_.back();
            node_pairs_.pop_back();
            const Node &one = nodes_[a], &other = nodes_[b];
            if (a == b)
            {
                if (one.left == kNone) continue;
                for (const auto& [x, y] : {std::pair{one.left, one.right}, {one.left, one.left}, {one.right, one.right}})
                    node_pairs_.emplace_back(x, y);
                continue;
            }
            if (!overlap(one.box, other.box)) continue;
            const bool leaf = one.left == kNone, other_leaf = other.left == kNone;
            if (leaf && other_leaf)
                found(one.item, other.item);
            else if (other_leaf || (!leaf && half_surface(one.box) >= half_surface(other.box)))
                node_pairs_.emplace_back(one.left, b), node_pairs_.emplace_back(one.right, b);
            else
                node_pairs_.emplace_back(a, other.left), node_pairs_.emplace_back(a, other.right);
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
    struct Task  // items [first, end) become the subtree at `node`
    {
        std::uint32_t node, first, end;
    };
    void split(const Task& task, std::span<const Box> boxes);
    std::uint32_t take_out(std::uint32_t leaf);
    std::uint32_t best_sibling(const Box& box) const;
    void put_in(std::uint32_t leaf, std::uint32_t free_node);
    void refit(std::uint32_t node);

    std::vector<Node> nodes_;
    std::uint32_t root_ = kNone;
    std::vector<std::uint32_t> leaf_of_item_;
    std::vector<std::uint32_t> stack_, order_;                         // scratch
    std::vector<std::pair<std::uint32_t, std::uint32_t>> node_pairs_;  // scratch
    std::vector<Task> tasks_;                                          // scratch
};

}  // namespace plab::geometry
