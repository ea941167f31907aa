#include "plab/plugin.h"
#include "manager_rows.h"

PLAB_PLUGIN("managers", registrar)
{
    using namespace plab;
    using namespace plab::managers;
    registrar
        .component<SequentialRows>("Manager/SequentialImpulse",
                                   "sequential impulses, started from those of the last step, then sweeps that correct overlap by "
                                   "displacements")
        .command<solve_all_sequentially>(Phase::Solve, "Manager/Solve", "advances islands of contacts and one-sided rows")
        .order(1)
        .pivots_up_to(SIZE_MAX)
        .strengths("large piles that change little, thanks to warm starting")
        .cost("sweeps x contact points, no matrix; with warm starting few sweeps suffice where little changes")
        .limits(
            "first order. The number of sweeps needed grows with the square of a stack's height and with the "
            "mass ratio of heavy bodies on light ones: beyond about 50:1 or 20 bodies high a stack sinks or "
            "leans unless max_iterations grows too. `residual` shows what is left. Friction is isotropic (a "
            "disc, not a box)")
        .source("Catto, Iterative Dynamics with Temporal Coherence, GDC (2005); Moreau (1988)");
    registrar
        .component<SoftStepRows>("Manager/SoftStep",
                                 "sub-steps with soft contacts, each followed by a relaxation sweep; restitution at the end of the "
                                 "step")
        .command<solve_all_softly>(Phase::Solve, "Manager/Solve", "advances islands of contacts and one-sided rows")
        .order(1)
        .strengths("a fixed cost per step; joints and contacts between bodies of similar mass")
        .cost("substeps x (1 + relax_iterations) sweeps over the contact points")
        .limits(
            "first order in the sub-step. Contacts yield under load, by about the load over their stiffness, and "
            "recover over some steps; light bodies under heavy ones yield most. Bounces lose energy because "
            "impacts are answered only at sub-steps")
        .source("Catto, Solver2D (2024), Soft Step; Macklin et al., Small Steps in Physics Simulation (2019)");
    registrar
        .component<DirectRows>("Manager/Direct",
                               "solves the exact contact law of the whole island by Newton's method with a sparse factorisation")
        .command<solve_all_directly>(Phase::Solve, "Manager/Solve", "advances islands of contacts and one-sided rows")
        .order(1)
        .pivots_up_to(SIZE_MAX)
        .strengths("mass ratios up to 1e8, stacks of 100, exact friction cone; bodies at rest stay at rest to rounding")
        .cost(
            "one check of the contacts if the impulses of the last step still fit; otherwise some Newton steps, "
            "each with one factorisation of 6 x 6 blocks over the contact graph: O(n) for stacks, about O(n^1.5) "
            "for walls")
        .limits(
            "accurate to `tolerance` for mass ratios up to 1e8, with Coulomb's exact cone. Where the split of a "
            "load is undetermined (four legs on a floor), the impulses are those nearest to the last step's, and "
            "equal at first. Violent impacts of many bodies with friction above about 0.5 may not converge: "
            "sweeps then finish, and `fallbacks` counts it; the same holds for islands with more than "
            "max_contacts. Time stepping: an impact is answered at the start of the next step unless a "
            "resolution locates it")
        .source("Alart, Curnier, CMAME 92 (1991); Acary, Cadoux, Lemarechal, Malick, ZAMM 91 (2011); Castro et al., IEEE T-RO 38 (2022)");
    registrar
        .component<AutomaticRows>("Manager/Automatic",
                                  "Direct for islands that are small or hold heavy bodies or joints, otherwise SoftStep")
        .command<solve_all_automatically>(Phase::Solve, "Manager/Solve", "advances islands of contacts and one-sided rows")
        .order(1)
        .pivots_up_to(kSolvedExactly)
        .accuracy("exact to 1e-12 m/s where `resolved` says Direct, otherwise that of SoftStep")
        .strengths("no choice has to be made: few contacts are exact, and thousands run in time")
        .cost("that of the method in use, by island")
        .limits("an island whose size is near the bound changes between the two methods")
        .source("the two methods; server/docs/pace.md for the bound");
}
