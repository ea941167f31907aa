/// Couplings that keep the speeds of two shafts at a ratio, and joints.
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

    registrar.component<AssignRows>("Constraint/AngularVelocity/Assign", "the driven shaft copies the driver's speed, which feels nothing")
        .command<&prepare<AssignRows>>(Phase::Prepare, "Constraint/Prepare", kPrepareDoc)
        .command<&assign_driven>(Phase::Couple, kCouple, "gives driven the speed of driver times the factor")
        .command<&finish<AssignRows>>(Phase::Finish, "Constraint/Finish", kFinishDoc)
        .accuracy("the ratio of speeds to rounding; no torque comes back")
        .strengths("one-way drives, at the cost of a copy")
        .cost("1 copy per row and sweep; a chain takes as many sweeps as it has drives, at worst")
        .limits("momentum and energy of the driven shaft are made up; no circles")
        .source("the paper's AngularVelocity constraint");

    registrar.component<ImpulseRows>("Constraint/AngularVelocity/Impulse", "the pair shares torques and impulses as its inertias demand")
        .command<&prepare<ImpulseRows>>(Phase::Prepare, "Constraint/Prepare", kPrepareDoc)
        .command<&exchange_impulses>(Phase::Couple, kCouple, "corrects the pair's speeds by an impulse weighted by inertia")
        .command<&finish<ImpulseRows>>(Phase::Finish, "Constraint/Finish", kFinishDoc)
        .accuracy("the ratio of speeds to rounding after enough sweeps, momentum shared; order 1")
        .strengths("pairs and short trains; contradictory loops run on")
        .cost("2 impulses per row and sweep; 2 sweeps for a pair, of the order of n^2 for a line of n")
        .limits(
            "long trains of light shafts converge slowly: what 1000 sweeps leave is told by the event coupling.not_converged; loops that "
            "contradict themselves brake towards rest, with the event constraint.contradiction; phase drifts by rounding")
        .source("Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems, 1996");

    registrar.component<GraphRows>("Constraint/AngularVelocity/Graph", "keeps the ratio exactly, solved with the whole graph of couplings")
        .command<&prepare<GraphRows>>(Phase::Prepare, "Constraint/Prepare", kPrepareDoc)
        .command<&connect>(Phase::Connect, "Constraint/Connect", "joins the two shafts in the constraint graph")
        .host_command(Phase::Couple, kCouple, "the host moves joined shafts as one degree of freedom")
        .command<&finish<GraphRows>>(Phase::Finish, "Constraint/Finish", kFinishDoc)
        .accuracy("the solver's order; angles and speeds at the ratio by construction")
        .strengths("trains of any length and ratio at the cost of one shaft")
        .cost("a few ns per shaft and force evaluation, whatever the ratios; the graph is built when couplings change")
        .limits(
            "two shafts per coupling (no differentials); loops must multiply to 1; at most one prescribed shaft per "
            "train")
        .source("weighted union of ratios, d'Alembert's principle in one coordinate per train");

    register_joints(registrar);
}
