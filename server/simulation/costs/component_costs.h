/// What each component costs in a step, from the accounts of types and of components that are timed on their own.
#pragma once

#include <vector>

#include "simulation/costs/cost_book.h"
#include "world/world.h"

namespace plab::simulation
{

/// CPU time of a component per step, ns.
struct ComponentCost
{
    Spread last;               ///< of the last steps; no samples: no step has been made yet
    double mean = 0;           ///< since the scene was built
    std::uint32_t shared = 1;  ///< number of components of the type that share the cost of the type; 1: measured individually
};

/// By directory index; empty for groups.
class ComponentCosts
{
public:
    ComponentCosts(const world::World& world, const CostBook& book);
    ComponentCost of(std::uint32_t component) const;

private:
    const world::World& world_;
    const CostBook& book_;
    std::vector<ComponentCost> by_table_;  ///< of one row
};

}  // namespace plab::simulation
