#include "publish/figures.h"

namespace plab::publish
{

bool is_object(const world::Component& c) { return c.facet == Facet::Body || c.facet == Facet::Shaft; }

bool is_interaction(const world::Component& c) { return c.table != kNoIndex && c.facet == Facet::Component; }

bool is_solver(const world::World& world, std::uint32_t component)
{
    const model::ComponentType* type = world.type_of(component);
    return type && type->info.name.starts_with("Solver/");
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
