/// Where a replay differs from its recording, when a hash has shown that it does.
#pragma once

#include <functional>

#include "record/run_log.h"
#include "replay/mismatch.h"
#include "simulation/simulation.h"

namespace plab::replay
{

/// Fills in what differs: against the recorded frame of this step (or the next one that there is), and against the next
/// recorded snapshot of the run, to which the simulation is stepped on. `ask` carries out what is due before a step.
Result<void> find_differences(record::RunLog& log, simulation::Simulation& simulation, model::TypeSource& types, Mismatch& mismatch,
                              const std::function<Result<void>()>& ask);

}  // namespace plab::replay
