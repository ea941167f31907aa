#include "plab/plugin.h"

#include "automatic.h"
#include "dormand_prince54.h"
#include "exact.h"
#include "exponential.h"
#include "fixed_step.h"
#include "implicit_midpoint.h"
#include "radau5.h"
#include "rotation_splitting.h"

namespace
{

using namespace plab::solvers;
using plab::Phase;

// `uniform` of a solver: under uniform forces alone it treats each body separately, so groups may be advanced together without changing a
// bit; `elementwise`: under any forces.
constexpr const char* kAdvance = "Solver/Advance";
constexpr const char* kAdvanceDoc = "advances its group over the step";

void declare_explicit(plab::Registrar& registrar)
{
    registrar.component<SemiImplicitEulerRows>("Solver/SemiImplicitEuler", "one force evaluation per step; order 1")
        .family("Solver")
        .command<advance_semi_implicit_euler>(Phase::Advance, kAdvance, kAdvanceDoc)
        .order(1)
        .elementwise()
        .strengths("one evaluation a step; energy of springs stays near its mean")
        .cost("1 force evaluation per step")
        .limits("errors shrink only with h; free rotation gains energy")
        .source("Hairer, Lubich, Wanner, Geometric numerical integration, eq. (I.1.9)");
    registrar.component<RungeKutta4Rows>("Solver/RungeKutta4", "the classical method; order 4")
        .family("Solver")
        .command<advance_runge_kutta4>(Phase::Advance, kAdvance, kAdvanceDoc)
        .order(4)
        .elementwise()
        .strengths("smooth forces at moderate steps, joints included: the least error for its cost")
        .cost("4 force evaluations per step")
        .limits("stiff forces: h below 2.8/w; fast spin: h below 0.05/w; energy drifts in very long runs")
        .source(
            "Hairer, Norsett, Wanner, Solving ordinary differential equations I, table II.1.2; "
            "Munthe-Kaas, Appl. Numer. Math. 29 (1999)");
    registrar
        .component<StoermerVerletRows>("Solver/StoermerVerlet",
                                       "half a kick, a drift, half a kick; order 2, symplectic for points and shafts")
        .family("Solver")
        .command<advance_stoermer_verlet>(Phase::Advance, kAdvance, kAdvanceDoc)
        .order(2)
        .elementwise()
        .strengths("energy of oscillators and orbits stays bounded over any number of steps; runs backwards")
        .cost("2 force evaluations per step")
        .limits("stiff forces: h below 2/w; drag is of order 2 but not dissipated exactly; the energy of free rotation drifts")
        .source("Hairer, Lubich, Wanner, Acta Numerica 12 (2003) 399, eq. (1.18)");
}

void declare_structure_preserving(plab::Registrar& registrar)
{
    registrar
        .component<RotationSplittingRows>(
            "Solver/RotationSplitting",
            "kicks and free flights, rotations split by principal axes; order 2 or 4; angular momentum to rounding")
        .family("Solver")
        .command<prepare_rotation_splitting>(Phase::Prepare, "Solver/Prepare", "checks the order")
        .command<advance_rotation_splitting>(Phase::Advance, kAdvance, kAdvanceDoc)
        .order(4)
        .strengths("fast spins and long runs: momentum to rounding, energy bounded")
        .cost("kicks per step: 1 (order 2), 6 (order 4), 1 where forces are uniform; 2 evaluations per kick, 4 if forces depend on speed")
        .limits("stiff forces: h below 2/w (order 2), 4/w (order 4); for one fast axle among slow ones RungeKutta4 is cheaper")
        .source(
            "McLachlan, SIAM J. Sci. Comput. 16 (1995) 151; Reich, Physica D 76 (1994) 375; Blanes, Moan, J. Comput. Appl. Math. 142 "
            "(2002) 313");
    registrar.component<ImplicitMidpointRows>("Solver/ImplicitMidpoint", "implicit, symplectic, A-stable; order 2")
        .family("Solver")
        .command<advance_implicit_midpoint>(Phase::Advance, kAdvance, kAdvanceDoc)
        .order(2)
        .strengths("stiff springs at long steps without damping them")
        .cost("5 to 13 force evaluations per step; 2 n + 5 for stiff groups of n coordinates, and dense LU")
        .limits(
            "oscillations that the step does not resolve stay, slowed down; cost grows with n^3; jumps of forces: parts of 1/64 step, then "
            "it fails")
        .source("Hairer, Lubich, Wanner, Geometric numerical integration, eq. (II.1.5) and section VIII.6");
    registrar.component<ExactRows>("Solver/Exact", "closed forms for free flight in a uniform field: machine precision at any step")
        .family("Solver")
        .command<advance_exact>(Phase::Advance, kAdvance, kAdvanceDoc)
        .order(4)
        .uniform()
        .strengths("free flight and spin without discretisation error, even in steps of minutes")
        .cost("2 force evaluations and about 1 us per body and step, whatever the step")
        .limits(
            "other forces: RotationSplitting of order 4 is used, joints: RungeKutta4, and an event reports it; a spin about an unstable "
            "axis amplifies rounding errors as the motion itself does")
        .source("Jacobi, Crelle 39 (1849); Celledoni, Fasso, Saefstroem, Zanna, SIAM J. Sci. Comput. 30 (2008) 2084");
}

void declare_error_controlled(plab::Registrar& registrar)
{
    registrar.component<DormandPrince54Rows>("Solver/DormandPrince54", "explicit with error control: chooses internal steps; order 5")
        .family("Solver")
        .command<advance_dormand_prince54>(Phase::Advance, kAdvance, kAdvanceDoc)
        .order(5)
        .strengths("a tolerance in place of a step: short where things change fast, long elsewhere")
        .cost("8 force evaluations per step where the whole step fits; 7 per internal step")
        .limits("stiff forces: many internal steps, then max_substeps ends the attempt; each step starts without history")
        .source(
            "Dormand, Prince, J. Comput. Appl. Math. 6 (1980) 19; Hairer, Norsett, Wanner, Solving ordinary differential equations I, "
            "II.4");
    registrar.component<ArticulatedRows>("Solver/Articulated", "DormandPrince54 in the coordinates of the joints; order 5")
        .family("Solver")
        .command<advance_articulated>(Phase::Advance, kAdvance, kAdvanceDoc)
        .order(5)
        .strengths("chains and trees of hinges, sliders, ball joints and welds: joints hold to rounding, at a cost linear in the bodies")
        .cost("evaluations as DormandPrince54, each without multipliers")
        .limits("loops, limits, motors and gears: DormandPrince54 is used on the rows, and an event reports it")
        .source("Featherstone, Rigid Body Dynamics Algorithms (2008), section 7.3; Dormand, Prince, J. Comput. Appl. Math. 6 (1980) 19");
    registrar.component<Radau5Rows>("Solver/Radau5", "stiff solver with error control: implicit, L-stable; order 5")
        .family("Solver")
        .command<advance_radau5>(Phase::Advance, kAdvance, kAdvanceDoc)
        .order(5)
        .strengths("stiff damping and stiff state of scripts, at a tolerance")
        .cost("about 2 n + 15 force evaluations per step for n coordinates, two dense LU of size 2 n; more with internal steps")
        .limits("cost grows with n^3; oscillations are resolved to the tolerance or damped away")
        .source("Hairer, Wanner, Solving ordinary differential equations II, section IV.8; program RADAU5");
}

void declare_exponential(plab::Registrar& registrar)
{
    registrar
        .component<ExponentialRows>("Solver/Exponential", "exponential Rosenbrock method: exact for linear forces at any step; order 4")
        .family("Solver")
        .command<advance_exponential>(Phase::Advance, kAdvance, kAdvanceDoc)
        .order(4)
        .strengths("stiff springs and drag at any step, with their oscillation")
        .cost(
            "2 n + 7 to 4 n + 7 force evaluations per step for n numbers that move, more if forces are nonlinear; an exponential of size n "
            "+ 3")
        .limits(
            "cost grows with n^3: above max_size, and where stiff forces change their direction (springs not guided along a line), Radau5 "
            "is used; where "
            "forces are nonlinear the energy ledger is sampled at most 128 times per step")
        .source("Luan, Appl. Numer. Math. 112 (2017) 91; Hochbruck, Ostermann, Acta Numerica 19 (2010) 209");
}

void declare_automatic(plab::Registrar& registrar)
{
    registrar
        .component<AutomaticRows>("Solver/Automatic",
                                  "picks a method for each group by measured spin and stiffness, and reports which and why")
        .family("Solver")
        .command<advance_together>(Phase::Advance, "Solver/AdvanceTogether",
                                   "advances several groups together if Exact or RungeKutta4 suits all of them")
        .command<advance_automatic>(Phase::Advance, kAdvance, kAdvanceDoc)
        .order(4)
        .uniform()
        .strengths("a suitable method for each group, selected automatically")
        .cost("that of the method; 7 evaluations more for stiff groups, 4 for fast spins")
        .limits(
            "a stiff force that no motion has excited yet is not detected; stiff groups of more than 200 numbers with nonlinear forces: "
            "short explicit steps")
        .source("Hairer, Wanner, Solving ordinary differential equations II, section IV.2");
}

}  // namespace

PLAB_PLUGIN("solvers", registrar)
{
    declare_explicit(registrar);
    declare_structure_preserving(registrar);
    declare_error_controlled(registrar);
    declare_exponential(registrar);
    declare_automatic(registrar);
}
