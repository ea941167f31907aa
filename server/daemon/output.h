/// The final state that plabd writes, as JSON.
#pragma once

#include <string>

#include "simulation/simulation.h"

namespace plab::daemon
{

/// The state of the scene as JSON; numbers read back to the same bits. Keys are documented in server/docs/output.md.
std::string end_state_json(const simulation::Simulation& simulation);

/// Writes it to a file; "-" is standard output. False if that failed; the log contains the reason.
bool write_end_state(const simulation::Simulation& simulation, const std::string& file);

}  // namespace plab::daemon
