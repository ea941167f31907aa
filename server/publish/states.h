/// Fills frames with the poses and velocities of all moving objects.
#pragma once

#include "publish/records.h"
#include "publish/roster.h"
#include "simulation/simulation.h"

namespace plab::publish
{

/// Pose and velocity of the frame B that the author defined; the tables keep those of the centre of mass.
wire::BodyState state_of(const Bodies& bodies, std::uint32_t row, std::uint32_t handle);

/// Bodies that are not static, and shafts. Does not allocate if the frame held as many before.
void fill_frame(const simulation::Simulation& simulation, const Roster& roster, wire::Frame& frame);

}  // namespace plab::publish
