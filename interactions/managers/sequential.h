/// Sequential impulses: point after point and row after row, each with the others held (projected Gauss-Seidel).
///
///   j_n <- max(0, j_n - omega (u_n - least) / K_nn)
///   j_t <- the point of the disc |j_t| <= mu j_n nearest to j_t - omega u_t / k_t      a disc, not a box: isotropic
///
/// Sources: Catto, Iterative Dynamics with Temporal Coherence, GDC (2005); Moreau (1988) for the law.
#pragma once

#include "problem.h"

namespace plab::managers
{

struct Sweeping
{
    int most = 10;          ///< sweeps
    double tolerance = 0;   ///< m/s: ends when no impulse changes its own speed by more
    double relaxation = 1;  ///< omega, 0..2
};
struct Swept
{
    int sweeps = 0;
    double change = 0;  ///< m/s, largest of the last sweep
    bool converged = false;
};

/// The movers' speeds must hold what the present impulses do (Problem::apply_impulses), and do so afterwards.
Swept sweep(Problem& problem, const Sweeping& how);
/// The same, and once more from nothing where the guess made kinetic energy: contacts without restitution never do, and
/// sweeps from nothing only take it away.
Swept sweep_without_gain(Problem& problem, const Sweeping& how);
/// Whether somebody else's motion, restitution or a motor may put energy in.
bool is_driven(const Problem& problem);
/// Whether the present impulses raise the kinetic energy, beyond rounding, where nothing (restitution, a motor, a body that moves
/// as told) may.
bool makes_energy(const Problem& problem);
/// One sweep; the largest change of speed that an impulse made to its own point, m/s.
double sweep_once(Problem& problem, double relaxation, bool backwards);

}  // namespace plab::managers
