/// Events of a step as records: collisions to one stream, all others to the other, each numbered without gaps.
#pragma once

#include <span>

#include "publish/records.h"
#include "simulation/simulation.h"

namespace plab::publish
{

/// How many of the events go to which stream.
struct Counts
{
    std::uint64_t collisions = 0, others = 0;
};
Counts count(std::span<const Event> events);

wire::Collisions collisions_of(const simulation::Simulation& simulation, Tick step, std::uint64_t first);
wire::Events events_of(const simulation::Simulation& simulation, Tick step, std::uint64_t first);

}  // namespace plab::publish
