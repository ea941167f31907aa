/// Single entries of the catalogue, with the current values of the world.
#pragma once

#include "publish/records.h"
#include "publish/roster.h"
#include "simulation/simulation.h"

namespace plab::publish
{

/// Fields of these kinds (one bit per FieldKind) as text that a request may send back.
std::vector<Parameter> parameters_of(const world::World& world, std::uint32_t component, unsigned kinds);

ObjectEntry object_entry(const simulation::Simulation& simulation, const Roster::Member& member, const std::string& name);
ShapeEntry shape_entry(const simulation::Simulation& simulation, const Roster::Member& member);
InteractionEntry interaction_entry(const simulation::Simulation& simulation, const Roster::Member& member, const std::string& name);
SceneEntry scene_entry(const simulation::Simulation& simulation, const Roster& roster);

}  // namespace plab::publish
