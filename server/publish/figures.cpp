#include "publish/figures.h"

#include <algorithm>

namespace plab::publish
{

bool is_object(const world::Component& c) { return c.facet == Facet::Body || c.facet == Facet::Shaft; }

bool is_interaction(const world::Component& c) { return c.table != kNoIndex && c.facet == Facet::Component; }

bool is_solver(const world::World& world, std::uint32_t component)
{
    const model::ComponentType* type = world.type_of(component);
    return type && type->info.name.starts_with("Solver/");
}

Costs::Costs(const simulation::Simulation& simulation) : simulation_(&simulation)
{
    const simulation::CostBook& book = simulation.stepper().cost();
    const auto& tables = simulation.world().tables();
    by_table_.resize(tables.size());
    for (std::uint32_t t = 0; t < tables.size(); ++t)
    {
        const auto owners = tables[t]->component_of_row();
        const auto rows = std::count_if(owners.begin(), owners.end(), [](std::uint32_t owner) { return owner != kNoIndex; });
        if (rows == 0) continue;
        const double share = 1 / static_cast<double>(rows);
        Cost& cost = by_table_[t];
        cost.last = book.of_table(t);
        cost.last.median *= share, cost.last.low *= share, cost.last.high *= share;
        cost.mean = book.mean_of_table(t) * share, cost.shared = static_cast<std::uint32_t>(rows);
    }
}

Cost Costs::of(std::uint32_t component) const
{
    const world::Component& c = simulation_->world().component(component);
    const simulation::CostBook& book = simulation_->stepper().cost();
    if (book.owns(component)) return {book.of_component(component), book.mean_of_component(component), 1};
    return c.table < by_table_.size() ? by_table_[c.table] : Cost{};
}

double unexplained(const simulation::Simulation& simulation, const simulation::Totals& totals)
{
    return totals.kinetic - simulation.kinetic_at_start() - totals.work;
}

std::string answer_of(const simulation::Simulation& s, const simulation::Detector& d)
{
    std::string out = d.resolution == kNoIndex ? "no resolution" : s.world().type_of(d.resolution)->info.name;
    if (const std::string method = d.resolution == kNoIndex ? "" : chosen_method(s.world(), d.resolution); !method.empty())
        out += " by " + method;
    out += d.locates ? (d.local ? " (rewinds the bodies in contact)" : " (rewinds the whole world)") : " (no rewinding)";
    out += ", " + (d.response == kNoIndex ? std::string("no response") : s.world().type_of(d.response)->info.name);
    return out + (d.responds ? "" : " (a sensor: applies no forces)");
}

}  // namespace plab::publish
