/// The plugin of constraints: couplings that keep the speeds of two shafts at a ratio, and joints. Each type is declared once, with the
/// phases in which the host calls it and what the manual says of it.
#include "plab/plugin.h"

#include "angular_velocity/couplings.h"
#include "grab/grab.h"
#include "joints/actuator.h"
#include "joints/coupler.h"
#include "joints/cylindrical.h"
#include "joints/distance.h"
#include "joints/gear.h"
#include "joints/limit.h"
#include "joints/motor.h"
#include "joints/pulley.h"
#include "joints/rigid_joints.h"
#include "joints/rolling.h"
#include "joints/snap.h"
#include "joints/universal.h"

namespace
{

using namespace plab::constraints;
using plab::Phase;
using plab::Registrar;

constexpr const char* kCouple = "Constraint/AngularVelocity";
constexpr const char* kRatioDoc = "the ratio from velocity_factor or tooth counts";
constexpr const char* kCouplingReport = "errors and transmitted torque of the step";

constexpr const char* kRows = "Constraint/Rows";
constexpr const char* kChange = "one row: how the force changes with position and speed, where a manager holds joints of its bodies";
constexpr const char* kPrepare = "Constraint/Prepare";
constexpr const char* kFinish = "Constraint/Finish";
constexpr const char* kPlaced = "takes points and axis from the present pose, if they are new";
constexpr const char* kReport = "force, torque and errors of the step";
constexpr const char* kFamily = "Constraint/Joint";
constexpr const char* kAsSolver = "the solver's order; position and speed to rounding after each step";
constexpr const char* kLimits =
    "index-1 formulation inside the stages, drift removed after the step; near a singular configuration "
    "steps must be short compared with the distance to it; contradictory rows are solved in the "
    "least-squares sense, with the event constraint.contradiction";
constexpr const char* kSource = "Baraff, Linear-time dynamics using Lagrange multipliers, 1996; Hairer, Wanner, Solving ODEs II, VII.2";

void register_couplings(Registrar& registrar)
{
    registrar
        .component<AssignRows>("Constraint/AngularVelocity/Assign",
                               "the driven shaft copies the driver's speed; the driver feels no reaction")
        .command<&prepare<AssignRows>>(Phase::Prepare, kPrepare, kRatioDoc)
        .command<&assign_driven>(Phase::Couple, kCouple, "gives driven the speed of driver times the factor")
        .command<&finish<AssignRows>>(Phase::Finish, kFinish, kCouplingReport)
        .accuracy("the ratio of speeds to rounding; no reaction torque on the driver")
        .strengths("one-way drives, at the cost of a copy")
        .cost("1 copy per row and sweep; a chain takes at most as many sweeps as it has drives")
        .limits("momentum and energy of the driven shaft are not conserved; loops are not allowed")
        .source("the paper's AngularVelocity constraint");

    registrar
        .component<ImpulseRows>("Constraint/AngularVelocity/Impulse", "the pair exchanges torques and impulses according to its inertias")
        .command<&prepare<ImpulseRows>>(Phase::Prepare, kPrepare, kRatioDoc)
        .command<&exchange_impulses>(Phase::Couple, kCouple, "corrects the pair's speeds by an impulse weighted by inertia")
        .command<&finish<ImpulseRows>>(Phase::Finish, kFinish, kCouplingReport)
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
        .command<&prepare<GraphRows>>(Phase::Prepare, kPrepare, kRatioDoc)
        .command<&connect>(Phase::Connect, "Constraint/Connect", "joins the two shafts in the constraint graph")
        .host_command(Phase::Couple, kCouple, "the host moves joined shafts as one degree of freedom")
        .command<&finish<GraphRows>>(Phase::Finish, kFinish, kCouplingReport)
        .accuracy("the solver's order; angles and speeds at the ratio by construction")
        .strengths("gear trains of any length and ratio at the cost of one shaft")
        .cost("a few ns per shaft and force evaluation, whatever the ratios; the graph is built when couplings change")
        .limits(
            "two shafts per coupling (no differentials); the ratios of a loop must multiply to 1; at most one "
            "prescribed shaft per train")
        .source("weighted union of ratios, d'Alembert's principle in one coordinate per train");
}

void register_rigid(Registrar& registrar)
{
    registrar.component<BallRows>("Constraint/Ball", "holds a point of b at a point of a, or of the world")
        .family(kFamily)
        .command<&prepare_ball>(Phase::Prepare, kPrepare, kPlaced)
        .command<&constrain_ball>(Phase::Constrain, kRows, "three rows: the points coincide")
        .command<&finish_reaction<BallRows>>(Phase::Finish, kFinish, kReport)
        .accuracy(kAsSolver)
        .strengths("no stiffness to tune; redundant rows are detected and counted")
        .cost("3 rows; linear in the number of joints for chains and trees")
        .limits(kLimits)
        .source(kSource);
    registrar.component<HingeRows>("Constraint/Hinge", "a ball joint that lets b rotate relative to a about one axis only")
        .family(kFamily)
        .command<&prepare_hinge>(Phase::Prepare, kPrepare, kPlaced)
        .command<&constrain_hinge>(Phase::Constrain, kRows, "five rows: the points coincide, the axes are parallel")
        .command<&finish_hinge>(Phase::Finish, kFinish, "angle, force, torque and errors of the step")
        .accuracy(kAsSolver)
        .strengths("no stiffness to tune; redundant rows are detected and counted")
        .cost("5 rows; linear in the number of joints for chains and trees")
        .limits(kLimits)
        .source(kSource);
    registrar.component<SliderRows>("Constraint/Slider", "b slides along an axis of a without rotating relative to it")
        .family(kFamily)
        .command<&prepare_slider>(Phase::Prepare, kPrepare, kPlaced)
        .command<&constrain_slider>(Phase::Constrain, kRows, "five rows: no displacement across the axis, no rotation")
        .command<&finish_slider>(Phase::Finish, kFinish, "travel, force, torque and errors of the step")
        .accuracy(kAsSolver)
        .strengths("no stiffness to tune; redundant rows are detected and counted")
        .cost("5 rows; linear in the number of joints for chains and trees")
        .limits(kLimits)
        .source(kSource);
    registrar.component<FixedRows>("Constraint/Fixed", "fixes b to a, or to the world, as if they were one body")
        .family(kFamily)
        .command<&prepare_fixed>(Phase::Prepare, kPrepare, kPlaced)
        .command<&constrain_fixed>(Phase::Constrain, kRows, "six rows: no displacement, no rotation")
        .command<&finish_reaction<FixedRows>>(Phase::Finish, kFinish, kReport)
        .accuracy(kAsSolver)
        .strengths("parts that are exchanged or released while the scene runs")
        .cost("6 rows; linear in the number of joints for chains and trees")
        .limits(kLimits)
        .source(kSource);
}

void register_two_motions(Registrar& registrar)
{
    registrar
        .component<UniversalRows>("Constraint/Universal", "a cross with one axis in a and one in b, as in the shafts of vehicles (Cardan)")
        .family(kFamily)
        .command<&prepare_universal>(Phase::Prepare, kPrepare, "takes points and axes from the present pose, if they are new")
        .command<&constrain_universal>(Phase::Constrain, kRows, "four rows: the points coincide, the axes keep their angle")
        .command<&finish_universal>(Phase::Finish, kFinish, "angles, force, torque and errors of the step")
        .accuracy(kAsSolver)
        .strengths("two axes without a body of next to no mass between them")
        .cost("4 rows; linear in the number of joints for chains and trees")
        .limits(kLimits)
        .source("Haug, Computer aided kinematics and dynamics, volume I, 1989, 9.4");
    registrar.component<CylindricalRows>("Constraint/Cylindrical", "b slides along an axis of a and turns about it")
        .family(kFamily)
        .command<&prepare_cylindrical>(Phase::Prepare, kPrepare, kPlaced)
        .command<&constrain_cylindrical>(Phase::Constrain, kRows, "four rows: no displacement across the axis, the axes are parallel")
        .command<&finish_cylindrical>(Phase::Finish, kFinish, "angle, travel, force, torque and errors of the step")
        .accuracy(kAsSolver)
        .strengths("pistons, pins in bores")
        .cost("4 rows; linear in the number of joints for chains and trees")
        .limits(kLimits)
        .source(kSource);
    registrar.component<ScrewRows>("Constraint/Screw", "b travels along an axis of a in proportion to its turns about it")
        .family(kFamily)
        .command<&prepare_screw>(Phase::Prepare, kPrepare, kPlaced)
        .command<&constrain_screw>(Phase::Constrain, kRows, "five rows: those of Cylindrical, and travel = lead angle / (2 pi)")
        .command<&finish_screw>(Phase::Finish, kFinish, "angle, travel, force, torque and errors of the step")
        .accuracy(kAsSolver)
        .strengths("lead screws, nuts and bolts: turns are counted, so the travel has no end")
        .cost("5 rows; linear in the number of joints for chains and trees")
        .limits(kLimits)
        .source(kSource);
    registrar.component<PlanarRows>("Constraint/Planar", "b moves in a plane of a and turns about its normal")
        .family(kFamily)
        .command<&prepare_planar>(Phase::Prepare, kPrepare, kPlaced)
        .command<&constrain_planar>(Phase::Constrain, kRows, "three rows: no displacement along the axis, the axes are parallel")
        .command<&finish_planar>(Phase::Finish, kFinish, "angle, force, torque and errors of the step")
        .accuracy(kAsSolver)
        .strengths("mechanisms in a plane, pucks on air")
        .cost("3 rows; linear in the number of joints for chains and trees")
        .limits(kLimits)
        .source(kSource);
}

void register_lengths(Registrar& registrar)
{
    constexpr const char* kLength = "Constraint/Length";
    registrar.component<DistanceRows>("Constraint/Distance", "keeps two points at a distance, like a massless rod")
        .family(kLength)
        .command<&prepare_distance>(Phase::Prepare, kPrepare, kPlaced)
        .command<&constrain_distance>(Phase::Constrain, kRows, "one row: the distance")
        .command<&finish_distance>(Phase::Finish, kFinish, kReport)
        .accuracy(kAsSolver)
        .strengths("massless rods: one row in place of a body and two joints")
        .cost("1 row")
        .limits(std::string("a length of 0 has no direction: use a ball; ") + kLimits)
        .source(kSource);
    registrar.component<SpringDamperRows>("Constraint/SpringDamper", "a spring with a damper between two points")
        .family(kLength)
        .command<&prepare_spring>(Phase::Prepare, kPrepare, kPlaced)
        .command<&apply_spring>(Phase::Force, "Constraint/Force", "adds -(k stretch + c rate) along the spring")
        .command<&linearize_spring>(Phase::Linearize, "Constraint/ForceChange", kChange)
        .command<&stored_by_spring>(Phase::Potential, "Constraint/Energy", "k stretch^2 / 2")
        .command<&finish_spring>(Phase::Finish, kFinish, "length, its rate and force at the end of the step")
        .accuracy("the solver's order; with Solver/Exponential exact along a line")
        .strengths("elastic: stores energy and damps")
        .cost("1 force; steps of explicit solvers shorter than 2 sqrt(m/k) and 2 m/c")
        .limits(
            "explicit solvers: unstable with longer steps; for a stiff spring use an implicit solver, or "
            "Constraint/Distance")
        .source("Hooke's law, Kelvin-Voigt body");
}

void register_pulley(Registrar& registrar)
{
    registrar.component<PulleyRows>("Constraint/Pulley", "a rope over two wheels: what one end gains, the other loses")
        .family("Constraint/Pulley")
        .command<&prepare_pulley>(Phase::Prepare, kPrepare, "places of the wheels, and the length if none is given, where they are new")
        .command<&constrain_pulley>(Phase::Constrain, kRows, "one row: the sum of two distances")
        .command<&finish_pulley>(Phase::Finish, kFinish, "lengths, tension and errors of the step")
        .accuracy(kAsSolver)
        .strengths("hoists, tackles and counterweights, without the bodies of the wheels and of the rope")
        .cost("1 row")
        .limits(
            "the rope pushes as well as it pulls, unless slack is true: then its bodies are stepped by a manager while it is taut; where "
            "an end reaches its wheel it has no direction; the "
            "rope has no mass, and the wheels have neither inertia nor friction nor radius")
        .source(kSource);
}

void register_coordinates(Registrar& registrar)
{
    constexpr const char* kStart = "Constraint/Start";
    constexpr const char* kStartDoc = "the initial angle, from which turns are counted";
    registrar.component<MotorRows>("Constraint/Motor", "rotates or slides b relative to a, or draws two points apart, at a speed or to a target")
        .family("Constraint/Motor")
        .command<&prepare_motor>(Phase::Prepare, kPrepare, kPlaced)
        .command<&begin_turning<MotorRows>>(Phase::Drive, kStart, kStartDoc)
        .command<&constrain_motor>(Phase::Constrain, kRows, "one row: the speed")
        .command<&finish_coordinate<MotorRows>>(Phase::Finish, kFinish, "position, effort and errors of the step")
        .accuracy("a speed: the solver's order; with max_effort order 1")
        .strengths("drives without a controller to tune")
        .cost("1 row; with max_effort its bodies are stepped by a manager")
        .limits(
            "max_effort needs a manager; the axis is fixed in b and should be that of a hinge or slider between "
            "the same bodies")
        .source(kSource);
    registrar.component<TorsionSpringRows>("Constraint/TorsionSpring", "a spring with a damper about a hinge's axis, or along a slider's")
        .family("Constraint/TorsionSpring")
        .command<&prepare_coordinate<TorsionSpringRows>>(Phase::Prepare, kPrepare, kPlaced)
        .command<&begin_turning<TorsionSpringRows>>(Phase::Drive, kStart, kStartDoc)
        .command<&apply_torsion>(Phase::Force, "Constraint/Force", "adds -(k (x - rest) + c x') along the coordinate")
        .command<&linearize_torsion>(Phase::Linearize, "Constraint/ForceChange", kChange)
        .command<&stored_by_torsion>(Phase::Potential, "Constraint/Energy", "k (x - rest)^2 / 2")
        .command<&finish_torsion>(Phase::Finish, kFinish, "position, rate and effort at the end of the step")
        .accuracy("the solver's order")
        .strengths("elastic about an axis: stores energy and damps")
        .cost("1 force")
        .limits("explicit solvers: unstable for steps beyond 2 sqrt(J/k) and 2 J/c")
        .source("Hooke's law, Kelvin-Voigt body");
    registrar.component<ActuatorRows>("Constraint/Actuator", "a force about a hinge's axis, along a slider's, or between two points, as a control demands")
        .family("Constraint/Actuator")
        .command<&prepare_actuator>(Phase::Prepare, kPrepare, kPlaced)
        .command<&begin_turning<ActuatorRows>>(Phase::Drive, kStart, kStartDoc)
        .command<&apply_actuator>(Phase::Force, "Constraint/Force", "adds gear (gain u + bias) along the coordinate")
        .command<&linearize_actuator>(Phase::Linearize, "Constraint/ForceChange", kChange)
        .command<&finish_actuator>(Phase::Finish, kFinish, "position, rate and effort at the end of the step")
        .accuracy("the solver's order")
        .strengths("motors, servos and pistons of a robot, with gear ratio and limits; its input is one number that requests and scripts set")
        .cost("1 force")
        .limits("explicit solvers: unstable for steps beyond 2 sqrt(J/k) and 2 J/c, k and c the negative biases times gear^2")
        .source("MuJoCo's actuation model (E. Todorov, T. Erez, Y. Tassa, MuJoCo, IROS 2012)");
    registrar.component<LimitRows>("Constraint/Limit", "keeps an angle, a travel or a distance within bounds")
        .family("Constraint/Limit")
        .command<&prepare_limit>(Phase::Prepare, kPrepare, kPlaced)
        .command<&begin_turning<LimitRows>>(Phase::Drive, kStart, kStartDoc)
        .command<&constrain_limit>(Phase::Constrain, kRows, "a one-sided row when a bound is near")
        .command<&finish_coordinate<LimitRows>>(Phase::Finish, kFinish, "position, force and errors of the step")
        .accuracy("its bound is met at the end of a step: order 1")
        .strengths("stops that cost nothing until they are reached")
        .cost("nothing away from its bounds; there its bodies are stepped by a manager")
        .limits("needs a manager; a bound is met at the end of the step that reaches it")
        .source("Signorini's conditions; Newton's law of restitution");
}

void register_gears(Registrar& registrar)
{
    constexpr const char* kStart = "Constraint/Start";
    constexpr const char* kStartDoc = "angles and phase when it engaged";
    registrar.component<GearRows>("Constraint/Gear", "keeps the angles of two bodies or shafts at a ratio, over any number of turns")
        .family("Constraint/Gear")
        .command<&prepare_gear>(Phase::Prepare, kPrepare, "the ratio, and the axles where they are new")
        .command<&begin_gear>(Phase::Drive, kStart, kStartDoc)
        .command<&constrain_gear>(Phase::Constrain, kRows, "one row: the phase")
        .command<&finish_gear>(Phase::Finish, kFinish, "phase, torque and errors of the step")
        .accuracy(kAsSolver)
        .strengths("gears on moving bodies; reports the forces between the teeth")
        .cost("1 row")
        .limits(
            "bodies need bearings of their own, which do not feel the forces between the teeth as the row is a "
            "pure couple; within a step, a body must not deviate by half a turn from its mean speed")
        .source(kSource);
    registrar.component<PlanetaryRows>("Constraint/Planetary", "sun, ring and carrier of a planetary train, as bodies or shafts")
        .family("Constraint/Planetary")
        .command<&prepare_planetary>(Phase::Prepare, kPrepare, "the axles, where they are new")
        .command<&begin_planetary>(Phase::Drive, kStart, kStartDoc)
        .command<&constrain_planetary>(Phase::Constrain, kRows, "one row: Willis' equation")
        .command<&finish_planetary>(Phase::Finish, kFinish, "phase, torque and errors of the step")
        .accuracy(kAsSolver)
        .strengths("differentials: three shafts with two degrees of freedom")
        .cost("1 row; the inertia of the planets is neglected")
        .limits("bodies need bearings of their own, on one axis")
        .source("R. Willis, Principles of mechanism, 1841");
    registrar.component<CouplerRows>("Constraint/Coupler", "keeps two coordinates at a ratio: turns of bodies or shafts, slides of bodies")
        .family("Constraint/Coupler")
        .command<&prepare_coupled<CouplerRows>>(Phase::Prepare, kPrepare, "axes, where they are new")
        .command<&begin_coupled<CouplerRows>>(Phase::Drive, kStart, kStartDoc)
        .command<&constrain_coupled<CouplerRows>>(Phase::Constrain, kRows, "one row: driven = factor driver")
        .command<&finish_coupled<CouplerRows>>(Phase::Finish, kFinish, "positions, efforts and errors of the step")
        .accuracy(kAsSolver)
        .strengths("grippers whose fingers close together, joints that mimic another one")
        .cost("1 row")
        .limits("each coordinate needs a hinge or a slider of its own; both are relative to one body, or in a chain")
        .source(kSource);
    registrar.component<RackRows>("Constraint/Rack", "a rack travels in proportion to the turns of its pinion, a body or a shaft")
        .family("Constraint/Rack")
        .command<&prepare_coupled<RackRows>>(Phase::Prepare, kPrepare, "axes, where they are new")
        .command<&begin_coupled<RackRows>>(Phase::Drive, kStart, kStartDoc)
        .command<&constrain_coupled<RackRows>>(Phase::Constrain, kRows, "one row: travel = radius angle")
        .command<&finish_coupled<RackRows>>(Phase::Finish, kFinish, "positions, efforts and errors of the step")
        .accuracy(kAsSolver)
        .strengths("turns into travel: steering, gates, linear drives; turns are counted, so the travel has no end")
        .cost("1 row")
        .limits(
            "the rack needs a slider, and a pinion that is a body a hinge, on the same carrier; the pinion gets a pure couple and the rack "
            "a "
            "force through its origin, so their bearings do not feel where the teeth mesh")
        .source(kSource);
}

void register_rolling(Registrar& registrar)
{
    registrar
        .component<RollingRows>("Constraint/Rolling",
                                "an ellipsoid rolls on a plane, a ball on a sphere or cylinder, outside or inside, without slipping")
        .family("Constraint/Rolling")
        .command<&prepare_rolling>(Phase::Prepare, kPrepare, "transforms the plane, sphere or cylinder to the frame of a, if it is new")
        .command<&constrain_rolling>(Phase::Constrain, kRows,
                                     "three rows: no velocity at the contact point, and no gap along the normal; parallel: two more rows "
                                     "keep the axes parallel")
        .command<&finish_rolling>(Phase::Finish, kFinish, "contact point, forces and errors of the step")
        .accuracy(kAsSolver)
        .strengths("rolls without slip over any length of time, at the order of the solver")
        .cost("3 rows; parallel: 5")
        .limits(
            "holds unconditionally: it neither slips nor lifts off; check normal_force, and the friction force "
            "along the plane")
        .source(
            "Kane, Levinson, Realistic mathematical modeling of the rattleback, 1982; Neimark, Fufaev, Dynamics of nonholonomic systems, "
            "1972");
}

void register_grab(Registrar& registrar)
{
    registrar.component<GrabRows>("Constraint/Grab", "a hand that holds a body by a damped spring with limited force")
        .family("Constraint/Grab")
        .command<&open_and_close>(Phase::Drive, "Grab/Close", "closes on what the hand touches, and opens")
        .command<&pull>(Phase::Force, "Constraint/Force", "spring and damper to the hand, at the point by which it holds")
        .command<&finish_grab>(Phase::Finish, kFinish, "force, torque and distance; what the hand touches; the load of the user")
        .accuracy("the solver's order")
        .strengths("holds what a user grabs, by touch, within reach or by name; force and torque are limited")
        .cost("1 force on the held body; the listed bodies are advanced in one batch with the hand")
        .limits("explicit solvers: unstable for steps beyond 2 / w; a load of m g pulls the body g / w^2 out of the hand")
        .source("E. Catto, Soft constraints, GDC 2011");
}

void register_snap(Registrar& registrar)
{
    constexpr const char* kSnapSource = "Witkin, Gleicher, Welch, Interactive dynamics, SIGGRAPH 1990; R. Smith, Dynamics simulation, 2001";
    registrar
        .component<SnapRows>("Constraint/Snap/Force", "draws two frames together by a force, critically damped if nothing else holds them")
        .command<&draw_together>(Phase::Force, "Constraint/Force", "forces that make the distance and the angle die away")
        .command<&finish_snap>(Phase::Finish, kFinish, "distance and angle at the end of the step")
        .accuracy("the solver's order")
        .strengths("brings free bodies together without a jump, also where contacts are near; momentum is kept, the work is booked")
        .cost("5 or 6 equations for each pair and force evaluation")
        .limits("explicit solvers: unstable for steps beyond 2 / w; bodies that others hold come more slowly, and overshoot")
        .source(kSnapSource);
    registrar.component<SnapRows>("Constraint/Snap/Acceleration", "draws two frames together, critically damped whatever else holds them")
        .command<&constrain_snap>(Phase::Constrain, kRows,
                                  "five or six rows: the accelerations that make the distance and the angle die away")
        .command<&finish_snap>(Phase::Finish, kFinish, "distance and angle at the end of the step")
        .accuracy("the solver's order")
        .strengths("brings bodies and mechanisms together without a jump; momentum is kept, the work is booked")
        .cost("5 or 6 rows")
        .limits("bodies that a manager steps, because they touch others, are not drawn: use Constraint/Snap/Force")
        .source(kSnapSource);
}

}  // namespace

PLAB_PLUGIN("constraints", registrar)
{
    register_couplings(registrar);
    register_rigid(registrar);
    register_two_motions(registrar);
    register_lengths(registrar);
    register_pulley(registrar);
    register_coordinates(registrar);
    register_gears(registrar);
    register_rolling(registrar);
    register_grab(registrar);
    register_snap(registrar);
}
