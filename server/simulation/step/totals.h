/// Mechanical totals of a world at one time.
#pragma once

#include "simulation/step/stepper.h"

namespace plab::simulation
{

struct Totals
{
    double kinetic = 0;         ///< J
    double stored = 0;          ///< J, of components that say so (Phase::Potential)
    double work = 0;            ///< J, done by all interactions since the run began
    Vec3 momentum;              ///< N s, of dynamic bodies
    Vec3 angular_momentum;      ///< N m s about the origin of W, of dynamic bodies
    double shaft_momentum = 0;  ///< N m s, sum over shafts about their own axles
};

/// Of whatever takes part in the stepper's schedule; `time` in s. Changes nothing in the world: commands are handed what they could write
/// to.
Totals totals_of(world::World& world, const Stepper& stepper, double time, Tick tick);
/// J, of components that say so (Phase::Potential).
double stored_energy_of(world::World& world, const Stepper& stepper, double time, Tick tick);
/// J: sum of 1/2 m v^2 of dynamic bodies that move by 0.03 of their radius in h (s), of shafts that turn by 0.03 rad:
/// energies below it are no motion that shows.
double least_energy(const world::HostTables& host, std::span<const double> radius_of_body, double h);

}  // namespace plab::simulation
