#include "geometry/box_tree.h"

#include <algorithm>
#include <cmath>

namespace plab::geometry
{
namespace
{
/// The tree is worth a new build if the surface of its inner nodes has grown to this many times what it was when built.
constexpr double kMostGrowth = 1.3;

/// Twice the centre along an axis; 0 if that is NaN, so that sorting by it remains a valid order.
double place(const Box& box, int axis)
{
    const double sum = box.lower[axis] + box.upper[axis];
    return std::isnan(sum) ? 0 : sum;
}

int longest_axis(const Box& box)
{
    const Vec3 d = box.upper - box.lower;
    if (d.x >= d.y && d.x >= d.z) return 0;
    return d.y >= d.z ? 1 : 2;
}
}  // namespace

void BoxTree::build(std::span<const Box> boxes, std::span<const std::uint32_t> items)
{
    root_ = kNone;
    nodes_.clear();
    if (items.empty()) return;
    nodes_.reserve(2 * items.size() - 1);
    leaf_of_item_.assign(boxes.size(), kNone);
    order_.assign(items.begin(), items.end());
    node_pairs_.reserve(256), inner_pairs_.reserve(256), stack_.reserve(256);
    root_ = 0;
    nodes_.emplace_back();
    tasks_.assign(1, {0, 0, static_cast<std::uint32_t>(order_.size())});
    while (!tasks_.empty())
    {
        const Task task = tasks_.back();
        tasks_.pop_back();
        split(task, boxes);
    }
    built_surface_ = surface_of_branches();
}

void BoxTree::split(const Task& task, std::span<const Box> boxes)
{
    Box all = boxes[order_[task.first]];
    for (std::uint32_t i = task.first + 1; i < task.end; ++i) all = joined(all, boxes[order_[i]]);
    nodes_[task.node].box = all;
    if (task.end - task.first == 1)
    {
        nodes_[task.node].item = order_[task.first];
        leaf_of_item_[order_[task.first]] = task.node;
        return;
    }
    const int axis = longest_axis(all);
    const std::uint32_t middle = task.first + (task.end - task.first) / 2;
    std::nth_element(order_.begin() + task.first, order_.begin() + middle, order_.begin() + task.end,
                     [&](std::uint32_t i, std::uint32_t j)
                     {
                         const double a = place(boxes[i], axis), b = place(boxes[j], axis);
                         return a < b || (a == b && i < j);
                     });
    const auto left = static_cast<std::uint32_t>(nodes_.size()), right = left + 1;
    nodes_.emplace_back().parent = task.node;
    nodes_.emplace_back().parent = task.node;
    nodes_[task.node].left = left, nodes_[task.node].right = right;
    tasks_.push_back({left, task.first, middle});
    tasks_.push_back({right, middle, task.end});
}

void BoxTree::move(std::uint32_t item, const Box& box)
{
    const std::uint32_t leaf = leaf_of_item_[item];
    if (leaf == root_)
    {
        nodes_[leaf].box = box;
        return;
    }
    const std::uint32_t free_node = take_out(leaf);
    nodes_[leaf].box = box;
    put_in(leaf, free_node);
}

/// The leaf's sibling replaces their common parent, whose node is returned for reuse.
std::uint32_t BoxTree::take_out(std::uint32_t leaf)
{
    const std::uint32_t parent = nodes_[leaf].parent, above = nodes_[parent].parent;
    const std::uint32_t sibling = nodes_[parent].left == leaf ? nodes_[parent].right : nodes_[parent].left;
    nodes_[sibling].parent = above;
    if (above == kNone)
        root_ = sibling;
    else
    {
        (nodes_[above].left == parent ? nodes_[above].left : nodes_[above].right) = sibling;
        refit_upwards(above);
    }
    return parent;
}

/// Descends towards the child that grows less, until a new parent at this place costs no more than descending further.
std::uint32_t BoxTree::best_sibling(const Box& box) const
{
    std::uint32_t at = root_;
    while (nodes_[at].left != kNone)
    {
        const Node& node = nodes_[at];
        const double here = half_surface(joined(node.box, box));
        const double inherited = here - half_surface(node.box);  // growth of all nodes passed on the way down
        const auto cost = [&](std::uint32_t child)
        {
            const Node& c = nodes_[child];
            const double with = half_surface(joined(c.box, box));
            return inherited + (c.left == kNone ? with : with - half_surface(c.box));
        };
        const double left = cost(node.left), right = cost(node.right);
        if (here < left && here < right) break;
        at = left <= right ? node.left : node.right;
    }
    return at;
}

void BoxTree::put_in(std::uint32_t leaf, std::uint32_t free_node)
{
    const std::uint32_t sibling = best_sibling(nodes_[leaf].box);
    const std::uint32_t above = nodes_[sibling].parent;
    Node& parent = nodes_[free_node];
    parent.parent = above, parent.left = sibling, parent.right = leaf;
    nodes_[sibling].parent = nodes_[leaf].parent = free_node;
    if (above == kNone)
        root_ = free_node;
    else
        (nodes_[above].left == sibling ? nodes_[above].left : nodes_[above].right) = free_node;
    refit_upwards(free_node);
}

void BoxTree::refit_upwards(std::uint32_t node)
{
    for (; node != kNone; node = nodes_[node].parent)
        nodes_[node].box = joined(nodes_[nodes_[node].left].box, nodes_[nodes_[node].right].box);
}

double BoxTree::surface_of_branches() const
{
    double sum = 0;
    for (const Node& node : nodes_)
        if (node.left != kNone) sum += half_surface(node.box);
    return sum;
}

bool BoxTree::refit(std::span<const Box> boxes, std::span<const std::uint32_t> items)
{
    if (root_ == kNone) return true;
    for (const std::uint32_t i : items) nodes_[leaf_of_item_[i]].box = boxes[i];
    // Parents before their children, then backwards.
    order_.clear();
    stack_.assign(1, root_);
    while (!stack_.empty())
    {
        const std::uint32_t at = stack_.back();
        stack_.pop_back();
        if (nodes_[at].left == kNone) continue;
        order_.push_back(at);
        stack_.push_back(nodes_[at].left), stack_.push_back(nodes_[at].right);
    }
    for (std::size_t i = order_.size(); i-- > 0;)
    {
        Node& node = nodes_[order_[i]];
        node.box = joined(nodes_[node.left].box, nodes_[node.right].box);
    }
    return surface_of_branches() <= kMostGrowth * built_surface_;  // false for NaN
}

std::span<const BoxTree::NodePair> BoxTree::divide_pairs(std::size_t parts)
{
    node_pairs_.clear();
    if (root_ == kNone) return {};
    node_pairs_.push_back({root_, root_});
    const auto is_of_leaves = [&](const NodePair& p) { return nodes_[p.first].left == kNone && nodes_[p.second].left == kNone; };
    while (node_pairs_.size() < parts)
    {
        inner_pairs_.clear();
        bool divides = false;
        for (const NodePair& p : node_pairs_)
        {
            if (p.first != p.second && !overlap(nodes_[p.first].box, nodes_[p.second].box)) continue;
            if (is_of_leaves(p))
            {
                if (p.first != p.second) inner_pairs_.push_back(p);
                continue;
            }
            divides = true;
            push_inner_pairs(p, inner_pairs_);
        }
        node_pairs_.swap(inner_pairs_);
        if (!divides) break;
    }
    return node_pairs_;
}

}  // namespace plab::geometry
