/// A run at the boundary between two steps, as those see it who watch and change nothing. (The world is no const one for commands of
/// Phase::Potential alone, which get tables that they could write to: totals.h.)
#pragma once

#include "simulation/step/stepper.h"

namespace plab::simulation
{

struct RunView
{
    world::World& world;
    const Stepper& stepper;
    Tick tick = 0;
    double time = 0, dt = 0;  ///< s
};

}  // namespace plab::simulation
