/// Frames: where everything is.
#pragma once

#include "publish/records.h"
#include "publish/roster.h"
#include "simulation/simulation.h"

namespace plab::publish
{

/// Bodies that are not static, and shafts. Allocates nothing where the frame held as many before.
void fill_frame(const simulation::Simulation& simulation, const Roster& roster, Frame& frame);

}  // namespace plab::publish
