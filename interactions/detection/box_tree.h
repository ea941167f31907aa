/// A binary tree of boxes: which of n boxes overlap a given one, in about log n tests.
///
/// Built top-down by halving at the median of the longest axis; a box that moves afterwards is taken out and put back
/// where it enlarges the tree least (surface area heuristic, Goldsmith and Salmon 1987). The tree's form depends on that
/// history, the set of boxes that a query finds does not.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bounds.h"

namespace plab::detection
{

class BoxTree
{
public:
    /// Makes the tree of `items`, item i bounded by boxes[i].
    void build(std::span<const Box> boxes, std::span<const std::uint32_t> items);
    /// Gives an item that build() was given another box.
    void move(std::uint32_t item, const Box& box);
    /// Calls found(item) for each item whose box overlaps `box`, in no order that means anything.
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

private:
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};
    struct Node
    {
        Box box;
        std::uint32_t parent = kNone;
        std::uint32_t left = kNone, right = kNone;  // none: a leaf
        std::uint32_t item = 0;                     // of a leaf
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
    std::vector<std::uint32_t> stack_, order_;  // scratch
    std::vector<Task> tasks_;                   // scratch
};

}  // namespace plab::detection
