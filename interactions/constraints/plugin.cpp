/// The plugin of constraints: couplings that keep the speeds of two shafts at a ratio, and joints.
#include "plab/plugin.h"

#include "angular_velocity/assign.h"
#include "angular_velocity/graph.h"
#include "angular_velocity/impulse.h"
#include "joints/register.h"

namespace
{

constexpr const char* kCouple = "Constraint/AngularVelocity";
constexpr const char* kPrepareDoc = "the ratio from velocity_factor or tooth counts";
constexpr const char* kFinishDoc = "errors and transmitted torque of the step";

}  // namespace

PLAB_PLUGIN("constraints", registrar)
{
    using namespace plab::constraints;
    using plab::Phase;

    registrar
        .component<AssignRows>("Constraint/AngularVelocity/Assign",
                               "the driven shaft copies the driver's speed; the driver feels no reaction")
        .command<&prepare<AssignRows>>(Phase::Prepare, "Constraint/Prepare", kPrepareDoc)
        .command<&assign_driven>(Phase::Couple, kCouple, "gives driven the speed of driver times the factor")
        .command<&finish<AssignRows>>(Phase::Finish, "Constraint/Finish", kFinishDoc)
        .accuracy("the ratio of speeds to rounding; no reaction torque on the driver")
        .strengths("one-way drives, at the cost of a copy")
        .cost("1 copy per row and sweep; a chain takes at most as many sweeps as it has drives")
        .limits("momentum and energy of the driven shaft are not conserved; loops are not allowed")
        .source("the paper's AngularVelocity constraint");

    registrar
        .component<ImpulseRows>("Constraint/AngularVelocity/Impulse", "the pair exchanges torques and impulses according to its inertias")
        .command<&prepare<ImpulseRows>>(Phase::Prepare, "Constraint/Prepare", kPrepareDoc)
        .command<&exchange_impulses>(Phase::Couple, kCouple, "corrects the pair's speeds by an impulse weighted by inertia")
        .command<&finish<ImpulseRows>>(Phase::Finish, "Constraint/Finish", kFinishDoc)
        .accuracy("the ratio of speeds to rounding after enough sweeps, momentum shared; order 1")
        .strengths("pairs and short trains; contradictory loops do not stop the simulation")
        .cost("2 impulses per row and sweep; 2 sweeps for a pair, about n^2 for a chain of n")
        .limits(
            "long trains of light shafts converge slowly: the event coupling.not_converged reports what 1000 "
            "sweeps leave; contradictory loops brake towards rest, with the event constraint.contradiction; the "
            "phase drifts by rounding")
        .source("Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems, 1996");

    registrar
        .component<GraphRows>("Constraint/AngularVelocity/Graph",
                              "keeps the ratio exactly; solved together with the whole graph of couplings")
        .command<&prepare<GraphRows>>(Phase::Prepare, "Constraint/Prepare", kPrepareDoc)
        .command<&connect>(Phase::Connect, "Constraint/Connect", "joins the two shafts in the constraint graph")
        .host_command(Phase::Couple, kCouple, "the host moves joined shafts as one degree of freedom")
        .command<&finish<GraphRows>>(Phase::Finish, "Constraint/Finish", kFinishDoc)
        .accuracy("the solver's order; angles and speeds at the ratio by construction")
        .strengths("gear trains of any length and ratio at the cost of one shaft")
        .cost("a few ns per shaft and force evaluation, whatever the ratios; the graph is built when couplings change")
        .limits(
            "two shafts per coupling (no differentials); the ratios of a loop must multiply to 1; at most one "
            "prescribed shaft per train")
        .source("weighted union of ratios, d'Alembert's principle in one coordinate per train");

    register_joints(registrar);
}
