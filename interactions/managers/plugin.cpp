#include "plab/plugin.h"
#include "manager_rows.h"

PLAB_PLUGIN("managers", registrar)
{
    using namespace plab;
    using namespace plab::managers;
    registrar
        .component<SequentialRows>("Manager/SequentialImpulse",
                                   "sweeps of sequential impulses from the last step's, then overlap parted by sweeps of positions")
        .command<solve_sequential>(Phase::Solve, "Manager/Solve", "advances an island of contacts and one-sided rows")
        .order(1)
        .strengths("large piles that change little: warm starts")
        .cost("sweeps x contact points, no matrix; from warm starts few sweeps are needed where little changes")
        .limits(
            "first order. Sweeps that are needed grow with the square of a stack's height and with its mass ratio, heavy on light: beyond "
            "about 50:1 or "
            "20 high it sinks or leans unless max_iterations grows too. What is left is in `residual`; friction is isotropic (a disc, not "
            "a box)")
        .source("Catto, Iterative Dynamics with Temporal Coherence, GDC (2005); Moreau (1988)");
    registrar
        .component<SoftStepRows>("Manager/SoftStep", "sub-steps with soft contacts, a relaxing sweep after each, restitution at the end")
        .command<solve_soft_step>(Phase::Solve, "Manager/Solve", "advances an island of contacts and one-sided rows")
        .order(1)
        .strengths("the same cost in each step, whatever happens; joints and contacts of like masses")
        .cost("substeps x (1 + relax_iterations) sweeps over the contact points")
        .limits(
            "first order in the sub-step. Contacts give way under load, by about the load over its stiffness, and come back over some "
            "steps; light things "
            "under heavy ones sag most. Bounces lose what the sub-step's timing loses")
        .source("Catto, Solver2D (2024), Soft Step; Macklin et al., Small Steps in Physics Simulation (2019)");
    registrar.component<DirectRows>("Manager/Direct", "the contact law of the island as it is, by Newton's method with sparse factors")
        .command<solve_direct>(Phase::Solve, "Manager/Solve", "advances an island of contacts and one-sided rows")
        .order(1)
        .strengths("mass ratios to 1e8, stacks of 100, friction by the cone; stands still to rounding")
        .cost(
            "nothing but a look where the last step's impulses still fit; else some Newton steps, each one factorisation of 6 x 6 blocks "
            "over the graph of who "
            "touches whom: O(n) for stacks, about O(n^1.5) for walls")
        .limits(
            "to `tolerance` for mass ratios to 1e8; Coulomb's cone exactly. Impulses that contacts share without being told how (four legs "
            "on a floor) are those "
            "nearest to the last step's, equal ones at first. Violent impacts of many bodies with friction above about 0.5 may not "
            "converge: then sweeps "
            "finish, `fallbacks` counts it; so do islands beyond max_contacts. Time stepping: an impact is answered at the start of the "
            "next step unless a "
            "resolution locates it")
        .source("Alart, Curnier, CMAME 92 (1991); Acary, Cadoux, Lemarechal, Malick, ZAMM 91 (2011); Castro et al., IEEE T-RO 38 (2022)");
}
