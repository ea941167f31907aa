#include "simulation/shafts/constraint_graph.h"

#include <algorithm>
#include <cassert>

namespace plab::simulation
{

void ConstraintGraph::clear() { edges_.clear(), drives_.clear(), without_factor_.clear(); }

void ConstraintGraph::add(std::uint32_t component, Ref driver, Ref driven, const Ratio& ratio)
{
    assert(driver.facet == Facet::Shaft && driven.facet == Facet::Shaft);
    if (const auto factor = ExactRatio::from(ratio))
        edges_.push_back({component, driver.index, driven.index, *factor});
    else
        without_factor_.push_back(component);
}

void ConstraintGraph::drive(std::uint32_t component, Ref driver, Ref driven)
{
    assert(driver.facet == Facet::Shaft && driven.facet == Facet::Shaft);
    drives_.push_back({component, driver.index, driven.index});
}

Result<void> ConstraintGraph::build(Shafts& shafts, const ShaftDirectory& directory)
{
    Errors errors;
    for (const std::uint32_t c : without_factor_)
        errors.push_back({{}, directory.component_id(c), "the velocity factor must be finite and other than 0"});
    if (!errors.empty()) return errors;

    std::vector<std::uint8_t> prescribed(shafts.size());
    for (std::uint32_t i = 0; i < shafts.size(); ++i) prescribed[i] = shafts.dynamic(i) ? 0 : 1;
    const auto forest = grow_ratio_forest(edges_, prescribed, directory);
    if (!forest) return forest.errors();
    Built built = reduce(*forest, shafts);
    std::vector<std::uint32_t> root(shafts.size());
    for (std::uint32_t i = 0; i < shafts.size(); ++i) root[i] = built.tree_of[i] == kNoIndex ? i : built.trees[built.tree_of[i]].root;
    errors = check_drives(drives_, root, prescribed, directory);
    if (!errors.empty()) return errors;

    trees_ = std::move(built.trees), nodes_ = std::move(built.nodes);
    tree_of_ = std::move(built.tree_of), redundant_ = std::move(built.redundant);
    weigh();
    write(shafts);
    return {};
}

ConstraintGraph::Built ConstraintGraph::reduce(const RatioForest& forest, const Shafts& shafts)
{
    Built b;
    b.tree_of.assign(shafts.size(), kNoIndex);
    b.nodes.reserve(forest.nodes.size());
    for (std::uint32_t t = 0; t + 1 < forest.tree_begin.size(); ++t)
    {
        const std::uint32_t first = forest.tree_begin[t];
        const std::uint32_t root = forest.nodes[first].shaft;
        b.trees.push_back({root, first, forest.tree_begin[t + 1] - first, 0, !shafts.dynamic(root), 0});
        for (std::uint32_t k = first; k < forest.tree_begin[t + 1]; ++k) b.tree_of[forest.nodes[k].shaft] = t;
    }
    for (const ForestNode& f : forest.nodes)
    {
        ShaftNode& n = b.nodes.emplace_back();
        n.shaft = f.shaft, n.parent = f.parent, n.ratio = f.ratio.value(), n.dynamic = shafts.dynamic(f.shaft);
        n.inertia = n.dynamic ? n.ratio * n.ratio * shafts.inertia[f.shaft] : 0.0;
        if (f.edge == kNoIndex) continue;
        n.component = forest.edges[f.edge].component, n.drives_parent = forest.edges[f.edge].driver == f.shaft;
    }
    for (const std::uint32_t e : forest.redundant)
    {
        b.redundant.push_back(forest.edges[e].component);
        ++b.trees[b.tree_of[forest.edges[e].driver]].redundant;
    }
    return b;
}

void ConstraintGraph::weigh()
{
    std::vector<double> own(nodes_.size());
    for (std::size_t k = 0; k < nodes_.size(); ++k) own[k] = nodes_[k].inertia;
    momentum_.resize(nodes_.size());
    sums_.resize(nodes_.size());
    for (ShaftTree& tree : trees_)
    {
        sum_sides(tree, own, sums_);
        tree.inertia = sums_.inside[tree.first];
        for (std::uint32_t k = tree.first; k < tree.first + tree.count; ++k)
            nodes_[k].inertia_inside = sums_.inside[k], nodes_[k].inertia_outside = sums_.outside[k];
    }
}

void ConstraintGraph::write(Shafts& shafts) const
{
    const auto place = [&shafts](std::uint32_t i, std::uint32_t root, double ratio)
    {
        const bool same = shafts.root[i] == root && shafts.ratio[i] == ratio;
        // If the angle does not follow, it was set or the row belongs to another shaft now: the teeth mesh at the present angles, and new
        // anchors record that.
        const bool follows = i == root || shafts.anchor[i] + ratio * (shafts.angle[root] - shafts.root_anchor[i]) == shafts.angle[i];
        if (same && follows) return;
        shafts.root[i] = root, shafts.ratio[i] = ratio;
        shafts.anchor[i] = shafts.angle[i], shafts.root_anchor[i] = shafts.angle[root];
    };
    for (std::uint32_t i = 0; i < shafts.size(); ++i)
        if (tree_of_[i] == kNoIndex) place(i, i, 1.0);
    for (const ShaftTree& tree : trees_)
        for (const ShaftNode& n : nodes(tree)) place(n.shaft, tree.root, n.ratio);
}

void ConstraintGraph::sum_sides(const ShaftTree& tree, std::span<const double> own, SideSums& sums) const
{
    const std::uint32_t first = tree.first;
    const std::uint32_t end = tree.first + tree.count;
    const auto parent = [this](std::uint32_t k) { return nodes_[k].parent; };
    for (std::uint32_t k = first; k < end; ++k) sums.inside[k] = own[k], sums.outside[k] = 0;
    for (std::uint32_t k = end; --k > first;) sums.inside[parent(k)] += sums.inside[k];

    // First add the siblings before a node, then those after it, then the parent and everything beyond the parent.
    std::fill_n(sums.passed.begin() + first, tree.count, 0.0);
    for (std::uint32_t k = first + 1; k < end; ++k) sums.outside[k] = sums.passed[parent(k)], sums.passed[parent(k)] += sums.inside[k];
    std::fill_n(sums.passed.begin() + first, tree.count, 0.0);
    for (std::uint32_t k = end; --k > first;) sums.outside[k] += sums.passed[parent(k)], sums.passed[parent(k)] += sums.inside[k];
    for (std::uint32_t k = first + 1; k < end; ++k) sums.outside[k] += own[parent(k)] + sums.outside[parent(k)];
}

bool ConstraintGraph::consistent(const ShaftTree& tree, const Shafts& shafts) const
{
    const double w = shafts.speed[tree.root];
    const auto members = nodes(tree);
    return std::all_of(members.begin(), members.end(), [&](const ShaftNode& n) { return shafts.speed[n.shaft] == n.ratio * w; });
}

bool ConstraintGraph::consistent(const Shafts& shafts) const
{
    return std::all_of(trees_.begin(), trees_.end(), [&](const ShaftTree& t) { return consistent(t, shafts); });
}

double ConstraintGraph::engage(Shafts& shafts, std::vector<double>* work)
{
    double change = 0;
    for (const ShaftTree& tree : trees_)
        if (!consistent(tree, shafts)) change += engage(tree, shafts, work);
    return change;
}

double ConstraintGraph::engage(const ShaftTree& tree, Shafts& shafts, std::vector<double>* work)
{
    double momentum = 0;  // at the root
    for (const ShaftNode& n : nodes(tree))
        if (n.dynamic) momentum += n.ratio * shafts.inertia[n.shaft] * shafts.speed[n.shaft];
    const double w = tree.prescribed ? shafts.speed[tree.root] : momentum / tree.inertia;
    if (work) book_engagement(tree, shafts, w, *work);

    // dE = -1/2 sum J d^2 + w sum rho J d, with d = rho w - speed; the second sum vanishes where angular momentum is conserved.
    double change = 0;
    for (const ShaftNode& n : nodes(tree))
    {
        const double d = n.ratio * w - shafts.speed[n.shaft];
        if (n.dynamic) change -= 0.5 * shafts.inertia[n.shaft] * d * d;
        if (n.dynamic && tree.prescribed) change += n.ratio * shafts.inertia[n.shaft] * d * w;
        shafts.speed[n.shaft] = n.ratio * w;
    }
    return change;
}

// Computes for each coupling the impulse S on its child's side, reduced to the root. The work is S/2 times the sum of the speeds before
// and after, and it is booked for dynamic shafts only.
void ConstraintGraph::book_engagement(const ShaftTree& tree, const Shafts& shafts, double speed, std::vector<double>& work)
{
    double total = 0;
    for (std::uint32_t k = tree.first; k < tree.first + tree.count; ++k)
    {
        const ShaftNode& n = nodes_[k];
        momentum_[k] = n.dynamic ? n.ratio * shafts.inertia[n.shaft] * shafts.speed[n.shaft] : 0.0;
        total += momentum_[k];
    }
    if (tree.prescribed) momentum_[tree.first] = tree.inertia * speed - total;  // impulse of whatever prescribes the motion
    sum_sides(tree, momentum_, sums_);
    for (std::uint32_t k = tree.first + 1; k < tree.first + tree.count; ++k)
    {
        const ShaftNode& n = nodes_[k];
        const ShaftNode& p = nodes_[n.parent];
        const double impulse = (n.inertia_inside * sums_.outside[k] - n.inertia_outside * sums_.inside[k]) / tree.inertia;
        const double child = 0.5 * impulse / n.ratio * (shafts.speed[n.shaft] + n.ratio * speed);
        const double parent = 0.5 * impulse / p.ratio * (shafts.speed[p.shaft] + p.ratio * speed);
        work[n.component] += child;  // only a root can be non-dynamic
        if (p.dynamic) work[n.component] -= parent;
    }
}

void ConstraintGraph::derive(Shafts& shafts, std::span<const std::uint8_t> active) const
{
    for (const ShaftTree& tree : trees_)
    {
        // Branches of a prescribed shaft may belong to several groups; all other trees are active as a whole.
        if (!active.empty() && !tree.prescribed && active[tree.root] == 0) continue;
        const double angle = shafts.angle[tree.root];
        const double speed = shafts.speed[tree.root];
        for (const ShaftNode& n : nodes(tree).subspan(1))
        {
            if (!active.empty() && active[n.shaft] == 0) continue;
            shafts.angle[n.shaft] = shafts.anchor[n.shaft] + n.ratio * (angle - shafts.root_anchor[n.shaft]);
            shafts.speed[n.shaft] = n.ratio * speed;
        }
    }
}

}  // namespace plab::simulation
