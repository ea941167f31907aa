#include "publish/figures.h"

#include <numeric>

namespace plab::publish
{

bool is_object(const world::Component& c) { return c.facet == Facet::Body || c.facet == Facet::Shaft; }

bool is_interaction(const world::Component& c) { return c.table != kNoIndex && c.facet == Facet::Component; }

bool is_solver(const world::World& world, std::uint32_t component)
{
    const model::ComponentType* type = world.type_of(component);
    return type && type->info.name.starts_with("Solver/");
}

std::vector<double> cost_of_rows(const simulation::Simulation& simulation, const simulation::CostBook& since)
{
    const simulation::CostBook& book = simulation.stepper().cost();
    std::vector<double> out(book.by_table.size(), 0.0);
    if (book.steps <= since.steps) return out;
    const auto steps = static_cast<double>(book.steps - since.steps);
    const auto sum = [](const auto& phases) { return std::accumulate(phases.begin(), phases.end(), std::uint64_t{0}); };
    for (std::size_t t = 0; t < out.size(); ++t)
    {
        double rows = 0;
        for (const std::uint32_t owner : simulation.world().tables()[t]->component_of_row()) rows += owner != kNoIndex ? 1 : 0;
        const std::uint64_t before = t < since.by_table.size() ? sum(since.by_table[t]) : 0;
        if (rows > 0) out[t] = static_cast<double>(sum(book.by_table[t]) - before) / rows / steps;
    }
    return out;
}

double cost_of(const std::vector<double>& cost_of_rows, const world::Component& c)
{
    return c.table < cost_of_rows.size() ? cost_of_rows[c.table] : 0.0;
}

double unexplained(const simulation::Simulation& simulation, const simulation::Totals& totals)
{
    return totals.kinetic - simulation.kinetic_at_start() - totals.work;
}

std::string answer_of(const simulation::Simulation& s, const simulation::Detector& d)
{
    std::string out = d.resolution == kNoIndex ? "no resolution" : s.world().type_of(d.resolution)->info.name;
    out += d.locates ? (d.local ? " (rewinds who is touched)" : " (rewinds the whole world)") : " (no rewinding)";
    out += ", " + (d.response == kNoIndex ? std::string("no response") : s.world().type_of(d.response)->info.name);
    return out + (d.responds ? "" : " (a sensor: nobody is pushed)");
}

}  // namespace plab::publish
