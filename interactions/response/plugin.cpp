/// The plugin of responses: what contacts do to bodies. A function for each type, with what the host and the manual need to know.
#include "plab/plugin.h"

#include "impulse.h"
#include "penalty.h"
#include "rows.h"

namespace
{

using namespace plab::response;
using plab::Phase;
using plab::Registrar;

constexpr const char* kRespond = "Response/Respond";
constexpr const char* kTouch = "Response/Touch";
constexpr const char* kForces = "adds the forces of contacts at a solver stage";
constexpr const char* kPotential = "Response/Potential";
constexpr const char* kStored = "energy in the springs";

void add_none(Registrar& registrar)
{
    registrar.component<NoneRows>("Response/None", "a sensor: contacts are reported, bodies pass through one another")
        .host_command(Phase::Respond, kRespond, "does nothing: the host reports the contacts")
        .accuracy("the solver's order, as bodies move independently")
        .strengths("sensors, and bodies that may pass through one another")
        .cost("nothing")
        .limits("holds nothing: contact.begin and contact.end are reported, but no momentum changes")
        .source("none: it has no law of its own");
}

void add_impulse(Registrar& registrar)
{
    registrar
        .component<ImpulseRows>("Response/Impulse",
                                "impulses with Coulomb friction and restitution; contacts that no longer bounce become resting "
                                "contacts")
        .command<respond>(Phase::Respond, kRespond, "applies the impulses of an impact, or of resting contacts over a step")
        .accuracy("located impacts: to rounding; persistent contacts: order 1")
        .strengths("impacts, answered one pair after the other, without a manager")
        .cost("one 3x3 solve per contact and sweep")
        .limits(
            "Gauss-Seidel: the number of sweeps grows with the height of a stack and the mass ratio within it; "
            "simultaneous impacts of several pairs are answered one after the other; forces between joined bodies that touch something "
            "are explicit: with stiff servos take Response/Automatic or Response/Rows")
        .source("Mirtich (1996) chapter 3; Stronge (2000) chapter 5; Moreau (1988)");
}

void add_penalty(Registrar& registrar)
{
    registrar.component<PenaltyRows>("Response/Penalty", "contacts are linear springs and dampers, with stiction springs along the surface")
        .command<evaluate_penalty>(Phase::Touch, kTouch, kForces)
        .command<stored_penalty>(Phase::Potential, kPotential, kStored)
        .by_force()
        .accuracy("the solver's order in pieces of the contact's duration")
        .strengths("forces over time: durations, depths, waves through a row of balls")
        .cost(
            "while bodies touch, the step is split into pieces of pi / (rate * steps_per_contact), with one "
            "detection pass per force evaluation")
        .limits(
            "bodies overlap by force / stiffness; a high stiffness costs sub-steps for as long as a contact "
            "lasts (contact.stiff); restitution is exact for a single central contact point, and undefined for "
            "several at once")
        .source("Cundall and Strack, Geotechnique 29 (1979); Schwager and Poeschel, Granular Matter 9 (2007)");
}

void add_hunt_crossley(Registrar& registrar)
{
    registrar
        .component<HuntCrossleyRows>("Response/HuntCrossley",
                                     "contacts are Hertzian springs with Hunt and Crossley's damping; they never pull")
        .command<evaluate_hunt_crossley>(Phase::Touch, kTouch, kForces)
        .command<stored_hunt_crossley>(Phase::Potential, kPotential, kStored)
        .by_force()
        .accuracy("the solver's order up to 3, in pieces of the contact's duration")
        .strengths("as Response/Penalty, for round bodies, with restitution that depends on speed")
        .cost("as Response/Penalty; pow() per contact and evaluation")
        .limits("as Response/Penalty; the force has no third derivative where a contact begins: methods above order 3 lose order there")
        .source("Hunt and Crossley, J. Appl. Mech. 42 (1975); Hertz (1882)");
}

void add_rows(Registrar& registrar)
{
    registrar
        .component<RowsRows>("Response/Rows",
                             "contacts become rows of an island that a manager advances; simultaneous impacts are answered "
                             "together")
        .command<respond_rows>(Phase::Respond, kRespond, "applies the impulses of a located impact to all its contacts at once")
        .by_rows()
        .accuracy("located impacts: to rounding; persistent contacts: that of its manager")
        .strengths("stacks, heavy bodies on light ones, impacts of many bodies at once")
        .cost("that of its manager; a located impact: some sweeps over the contacts involved")
        .limits(
            "without a resolution that locates them, impacts are answered at the start of the next step, with "
            "the overlap that has developed; touching bodies share an impact simultaneously (Newton's cradle "
            "without gaps: all balls move). Newton's restitution returns less where friction would otherwise add "
            "energy")
        .source("Moreau, Unilateral contact and dry friction (1988); Glocker, Set-Valued Force Laws (2001)");
}

void add_automatic(Registrar& registrar)
{
    registrar
        .component<AutomaticRows>("Response/Automatic",
                                  "impulses for located impacts, one pair after the other; a manager for contacts that persist")
        .command<respond_automatically>(Phase::Respond, kRespond, "applies the impulses of a located impact")
        .by_rows()
        .accuracy("located impacts: to rounding; persistent contacts: that of its manager")
        .strengths("no choice has to be made: bounces, sequences of impacts, stacks and heaps")
        .cost("one 3x3 solve per contact of an impact; for persistent contacts that of its manager")
        .limits(
            "impacts that the resolution does not locate are answered by the manager at the start of the next step, all of an island "
            "together")
        .source("as Response/Impulse for impacts, and as its manager for contacts that persist");
}

}  // namespace

PLAB_PLUGIN("response", registrar)
{
    add_none(registrar);
    add_impulse(registrar);
    add_penalty(registrar);
    add_hunt_crossley(registrar);
    add_rows(registrar);
    add_automatic(registrar);
}
