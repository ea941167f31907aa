/// The final state that plabd writes, as JSON, and what its files say of which component.
#pragma once

#include <string>

#include "simulation/simulation.h"
#include "world/world.h"

namespace plab::daemon
{

/// The state of the scene as JSON; numbers read back to the same bits. Keys are documented in server/docs/output.md.
std::string end_state_json(const simulation::Simulation& simulation);

/// Writes it to a file; "-" is standard output. False if that failed; the log contains the reason.
bool write_end_state(const simulation::Simulation& simulation, const std::string& file);

// What the trace (trace.h) has in common with it.

/// 17 significant digits; "null" for what is not finite.
std::string number(double v);

/// Components with motion or values of their own.
bool is_shown(const world::Component& component);
/// Components listed under "interactions"; solvers appear with their groups (--explain).
bool is_listed(const world::World& world, std::uint32_t component);

}  // namespace plab::daemon
