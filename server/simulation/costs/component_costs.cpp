#include "simulation/costs/component_costs.h"

#include <algorithm>

namespace plab::simulation
{

ComponentCosts::ComponentCosts(const world::World& world, const CostBook& book) : world_(world), book_(book)
{
    const auto& tables = world.tables();
    by_table_.resize(tables.size());
    for (std::uint32_t t = 0; t < tables.size(); ++t)
    {
        const auto owners = tables[t]->component_of_row();
        const auto rows = std::count_if(owners.begin(), owners.end(), [](std::uint32_t owner) { return owner != kNoIndex; });
        if (rows == 0) continue;
        const double share = 1 / static_cast<double>(rows);
        ComponentCost& cost = by_table_[t];
        cost.last = book.of_table(t);
        cost.last.median *= share, cost.last.low *= share, cost.last.high *= share;
        cost.mean = book.mean_of_table(t) * share, cost.shared = static_cast<std::uint32_t>(rows);
    }
}

ComponentCost ComponentCosts::of(std::uint32_t component) const
{
    const world::Component& c = world_.component(component);
    if (book_.owns(component)) return {book_.of_component(component), book_.mean_of_component(component), 1};
    return c.table < by_table_.size() ? by_table_[c.table] : ComponentCost{};
}

}  // namespace plab::simulation
