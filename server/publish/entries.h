/// Single entries of the catalogue, with the current values of the world.
#pragma once

#include "model/type_summary.h"
#include "publish/records.h"
#include "publish/roster.h"
#include "simulation/simulation.h"

namespace plab::publish
{

/// Fields of these kinds (one bit per FieldKind) as text that a request may send back.
std::vector<wire::Parameter> parameters_of(const world::World& world, std::uint32_t component, unsigned kinds);

wire::SceneObject object_entry(const simulation::Simulation& simulation, const Roster::Member& member, const std::string& name);
wire::Shape shape_entry(const simulation::Simulation& simulation, const Roster::Member& member);
wire::Interaction interaction_entry(const simulation::Simulation& simulation, const Roster::Member& member, const std::string& name);
wire::Scene scene_entry(const simulation::Simulation& simulation, const Roster& roster);
wire::Type type_entry(const model::TypeSummary& type);

}  // namespace plab::publish
