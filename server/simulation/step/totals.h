/// Mechanical totals of a world at one time: energy, work and momenta.
#pragma once

#include "simulation/step/stepper.h"

namespace plab::simulation
{

struct Totals
{
    double kinetic = 0;         ///< J
    double stored = 0;          ///< J, potential energy that components report (Phase::Potential)
    double work = 0;            ///< J, work of all interactions since the run began
    Vec3 momentum;              ///< N s, of dynamic bodies
    Vec3 angular_momentum;      ///< N m s about the origin of W, of dynamic bodies
    double shaft_momentum = 0;  ///< N m s, sum over shafts about their own axles
};

/// Totals over all components that take part in the stepper's steps; `time` in s. Does not change the world, although the commands are
/// called with tables that they could write to.
Totals totals_of(world::World& world, const Stepper& stepper, double time, Tick tick);
/// The energies of totals_of() alone, for less.
struct Energies
{
    double kinetic = 0, stored = 0;  ///< J
};
Energies energies_of(world::World& world, const Stepper& stepper, double time, Tick tick);
/// J, potential energy that components report (Phase::Potential).
double stored_energy_of(world::World& world, const Stepper& stepper, double time, Tick tick);
/// J: the kinetic energy if every dynamic one of these bodies moved by 0.03 of its radius in h (s) and every shaft turned by 0.03 rad.
/// Energies below this correspond to motion that is too small to be seen. `radius_of_body`: of all bodies.
double least_energy(const world::HostTables& host, std::span<const std::uint32_t> bodies, std::span<const std::uint32_t> shafts,
                    std::span<const double> radius_of_body, double h);

}  // namespace plab::simulation
