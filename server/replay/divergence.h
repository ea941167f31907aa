/// Finds where a replay differs from its recording, after a hash has shown that it does.
#pragma once

#include <functional>

#include "record/run_log.h"
#include "replay/mismatch.h"
#include "simulation/simulation.h"

namespace plab::replay
{

/// Fills in the differences: from the recorded frame of this step (or the next one that exists), and from the next recorded
/// snapshot of the run, up to which the simulation is stepped. `ask` carries out the requests that are due before a step.
Result<void> find_differences(record::RunLog& log, simulation::Simulation& simulation, model::TypeSource& types, Mismatch& mismatch,
                              const std::function<Result<void>()>& ask);

}  // namespace plab::replay
