#include "simulation/shafts/shaft_reactions.h"

#include <algorithm>
#include <cassert>

namespace plab::simulation
{

void ShaftTorques::clear() { std::fill(torque_.begin(), torque_.end(), std::nullopt); }

void ShaftTorques::set(std::uint32_t component, double torque)
{
    if (component >= torque_.size()) torque_.resize(component + 1);
    torque_[component] = torque;
}

void ShaftTorques::add(const ShaftCoupling& coupling)
{
    assert(coupling.at_accelerations());
    for (const std::uint32_t c : coupling.participants()) set(c, coupling.reaction(c));
    own_.resize(coupling.graph().nodes().size());
    sums_.resize(own_.size());
    coupling.for_each_tree([&](const ShaftTree& tree) { add_tree(coupling, tree); });
}

// Let A be the inertia and B the torque, both reduced to the root; subscript in: on the node's own side of its coupling, out: on the
// other side. The coupling transmits to the node's side S = A_in B/A - B_in = (A_in B_out - A_out B_in) / A. The last form loses no
// digits where a coupling transmits only a small part of a large torque.
void ShaftTorques::add_tree(const ShaftCoupling& coupling, const ShaftTree& tree)
{
    const auto nodes = coupling.graph().nodes();
    const std::uint32_t end = tree.first + tree.count;
    for (std::uint32_t k = tree.first; k < end; ++k) own_[k] = nodes[k].ratio * coupling.total_torque(nodes[k].shaft);
    coupling.graph().sum_sides(tree, own_, sums_);
    for (std::uint32_t k = tree.first + 1; k < end; ++k)
    {
        const ShaftNode& n = nodes[k];
        if (!coupling.takes_part(n.shaft)) continue;  // a branch of a prescribed shaft in another group
        const double side = (n.inertia_inside * sums_.outside[k] - n.inertia_outside * sums_.inside[k]) / tree.inertia;
        set(n.component, n.drives_parent ? -side / nodes[n.parent].ratio : side / n.ratio);
    }
}

std::optional<double> ShaftTorques::torque(std::uint32_t component) const
{
    return component < torque_.size() ? torque_[component] : std::nullopt;
}

}  // namespace plab::simulation
