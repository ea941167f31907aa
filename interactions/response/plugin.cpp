#include "plab/plugin.h"
#include "impulse.h"
#include "penalty.h"
#include "rows.h"

PLAB_PLUGIN("response", registrar)
{
    using namespace plab;
    using namespace plab::response;
    registrar.component<NoneRows>("Response/None", "a sensor: contacts are reported, bodies pass through one another")
        .host_command(Phase::Respond, "Response/Respond", "nothing: the host reports the contacts")
        .accuracy("the solver's order: bodies move as if alone")
        .strengths("sensors, and what may pass through")
        .cost("nothing")
        .limits("holds nothing: contact.begin and contact.end are told, no momentum changes")
        .source("none: it states no law");
    registrar
        .component<ImpulseRows>("Response/Impulse", "impulses with Coulomb friction and restitution; contacts that no longer bounce rest")
        .command<respond>(Phase::Respond, "Response/Respond", "applies the impulses of an impact, or of resting contacts over a step")
        .accuracy("an impact that is located: to rounding; contacts that stay: order 1")
        .strengths("impacts, one pair after the other, without a manager")
        .cost("one 3x3 solve per contact and sweep")
        .limits(
            "Gauss-Seidel: sweeps grow with the height of a stack and the mass ratio within it; impacts of several "
            "pairs at one time happen one after the other")
        .source("Mirtich (1996) chapter 3; Stronge (2000) chapter 5; Moreau (1988)");
    registrar.component<PenaltyRows>("Response/Penalty", "contacts are linear springs and dampers, with stiction springs along the surface")
        .command<touch_penalty>(Phase::Touch, "Response/Touch", "adds the forces of contacts at a solver stage")
        .command<stored_penalty>(Phase::Potential, "Response/Potential", "energy in the springs")
        .by_force()
        .accuracy("the solver's order in pieces of the contact's duration")
        .strengths("forces over time: durations, depths, waves through a row of balls")
        .cost(
            "while something touches: the step in pieces of pi / (rate * steps_per_contact), one look at the contacts per force evaluation")
        .limits(
            "bodies overlap by force / stiffness; a high stiffness costs sub-steps for as long as a contact lasts "
            "(contact.stiff); restitution is exact for one central contact point, and no law for several at once")
        .source("Cundall and Strack, Geotechnique 29 (1979); Schwager and Poeschel, Granular Matter 9 (2007)");
    registrar
        .component<HuntCrossleyRows>("Response/HuntCrossley", "contacts are Hertz's springs with Hunt and Crossley's damping: never pull")
        .command<touch_hunt_crossley>(Phase::Touch, "Response/Touch", "adds the forces of contacts at a solver stage")
        .command<stored_hunt_crossley>(Phase::Potential, "Response/Potential", "energy in the springs")
        .by_force()
        .accuracy("the solver's order up to 3, in pieces of the contact's duration")
        .strengths("as Response/Penalty, for round bodies, with restitution that depends on speed")
        .cost("as Response/Penalty; pow() per contact and evaluation")
        .limits("as Response/Penalty; the force has no third derivative where a contact begins: methods above order 3 lose order there")
        .source("Hunt and Crossley, J. Appl. Mech. 42 (1975); Hertz (1882)");
    registrar
        .component<RowsRows>("Response/Rows",
                             "contacts are rows of an island that a manager advances; impacts of one instant are answered together")
        .command<respond_rows>(Phase::Respond, "Response/Respond", "applies the impulses of a located impact to all its contacts at once")
        .by_rows()
        .accuracy("an impact that is located: to rounding; contacts that stay: that of its manager")
        .strengths("stacks, heavy on light, many bodies hit at once")
        .cost("that of its manager; a located impact: some sweeps over the contacts that take part")
        .limits(
            "without a resolution that locates impacts they are answered at the start of the step after, with the overlap that came about; "
            "bodies that touch "
            "share an impact at once (Newton's cradle with no gaps: all move). Newton's restitution gives back less where friction would "
            "make energy of it")
        .source("Moreau, Unilateral contact and dry friction (1988); Glocker, Set-Valued Force Laws (2001)");
}
