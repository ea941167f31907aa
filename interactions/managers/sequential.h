/// Sequential impulses: one point or row after the other is solved while all others are held fixed (projected Gauss-Seidel).
///
///   j_n <- max(0, j_n - omega (u_n - least) / K_nn)
///   j_t <- the point of the disc |j_t| <= mu j_n nearest to j_t - omega u_t / k_t      a disc, not a box: isotropic
///
/// A sweep passes information only from a contact to those that share a body with it. Errors that vary slowly over a stack
/// therefore decay slowly: the number of sweeps grows with the square of the height, and also with the mass ratio where heavy
/// bodies rest on light ones. Starting from the impulses of the last step (warm start) is what makes few sweeps suffice in a
/// pile at rest.
///
/// Sources: Catto, Iterative Dynamics with Temporal Coherence, GDC (2005); Moreau (1988) for the law.
#pragma once

#include "problem.h"

namespace plab::managers
{

struct Sweeping
{
    int most = 10;              ///< maximum number of sweeps
    double tolerance = 0;       ///< m/s: stops when no impulse changes the velocity of its own point or row by more; 0: never
    double relaxation = 1;      ///< omega, 0..2
    double friction_scale = 1;  ///< 0: without friction
    bool loads_resist = false;  ///< the bounds of what resists rolling follow the normal impulses
};
struct Swept
{
    int sweeps = 0;
    double change = 0;  ///< m/s, largest change in the last sweep
    bool converged = false;
};

/// The movers' velocities must include the effect of the present impulses (Problem::apply_impulses), and do so afterwards.
Swept sweep(Problem& problem, const Sweeping& how);
/// The same with the points of `list` in place of those of `problem`.
template <int W>
Swept sweep(Problem& problem, PacketList<W>& list, const Sweeping& how);
/// The same as sweep(problem), but if the result has gained kinetic energy, starts again from zero impulses. Contacts without
/// restitution cannot add energy, but the initial guess may; sweeps that start from zero only remove energy.
Swept sweep_without_gain(Problem& problem, const Sweeping& how);
/// Whether the motion of other bodies, restitution or a motor may add energy.
bool is_driven(const Problem& problem);
bool is_driven(const Line& line);
/// Whether the present impulses raise the kinetic energy beyond rounding although nothing (restitution, a motor, a kinematic
/// body) is entitled to add any.
bool makes_energy(const Problem& problem);
/// Whether impulses of joints and contacts, which do no work in exact motion, give the bodies more than a small part of what they have:
/// where a contact can hardly move its bodies, large impulses along levers that turn within the step do. Problem::forget_turning() helps:
/// without turning, the solution is a projection.
bool gains_by_turning(const Problem& problem);

}  // namespace plab::managers
