/// A run at the boundary between two steps, as seen by observers that change nothing. (The world is not const only because commands of
/// Phase::Potential receive tables that they could write to: totals.h.)
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
