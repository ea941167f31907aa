/// Sub-steps with soft contacts: Soft Step.
///
/// Per sub-step of length h = step / n:
///
///   kick    v <- v + h a
///   solve   j_n <- max(0, j_n - m_eff mass_scale (u_n + bias) - impulse_scale j_n)     a spring and damper, implicitly
///   move    x <- x + h v
///   relax   the same without bias: takes out the speed that pushing overlap apart put in
///
/// with omega = 2 pi hertz, zeta the damping ratio, c = h omega (2 zeta + h omega):
///   bias = omega / (2 zeta + h omega) * overlap (not faster than push_speed),  mass_scale = c / (1 + c),
///   impulse_scale = 1 / (1 + c).   Gaps: bias = gap / h, hard.
/// Bodies turn freely in a move, which keeps their energy; K is that of the attitude they have come to.
/// Where speeds that pushed overlap apart are left over that make kinetic energy, hard sweeps follow; where those do not get it out, the
/// sub-step is made again without pushing apart: sweeps from nothing, which only take energy, then the move.
/// After the last sub-step restitution, where a contact or a limit pressed and met faster than it now parts; as much of it as the
/// energy at the start of the step allows, what gravity did on the way counted. Joints take part in what limits give back.
/// Source: Catto, Solver2D (2024), "Soft Step" (solve_soft_step.c); Macklin et al., Small Steps (2019), for sub-steps.
#pragma once

#include "stepping.h"

namespace plab::managers
{

struct SoftChoices
{
    int substeps = 8;
    int relax_iterations = 1;
    double hertz = 60;  ///< of a contact; not more than a quarter of the sub-steps' rate
    double damping_ratio = 10;
    double push_speed = 3;    ///< m/s
    double tolerance = 1e-2;  ///< m/s: overlap that closes faster than this is not held
};

struct SoftMemory
{
    StepMemory step;
    std::vector<double> depth, depth_before;  ///< m, of the contact points as they go; at the start of the sub-step
    std::vector<Vec3> moved_with;             ///< N s, by point: impulses of the sub-step's move
    std::vector<double> lines_moved_with;
    std::vector<double> greatest;  ///< N s, largest normal impulse of a sub-step
    std::vector<Vec3> sum;         ///< N s, over the step
    std::vector<double> line_sum;
    std::vector<double> line_closing;   ///< m/s or rad/s, at which limits with restitution were met when the step began; else 0
    std::vector<double> line_greatest;  ///< N s or N m s, largest impulse of a sub-step
    struct Kick
    {
        Vec3 push, turn;  ///< N s, N m s: by forces, in the sub-step
    };
    std::vector<Kick> kicks;
};

Verdict advance_softly(Island& island, Bodies& bodies, Shafts& shafts, const SoftChoices& choices, SoftMemory& memory);

}  // namespace plab::managers
