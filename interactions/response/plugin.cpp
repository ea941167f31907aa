#include "plab/plugin.h"
#include "impulse.h"

PLAB_PLUGIN("response", registrar)
{
    using namespace plab;
    using namespace plab::response;
    registrar.component<NoneRows>("Response/None", "a sensor: contacts are reported, bodies pass through one another")
        .host_command(Phase::Respond, "Response/Respond", "nothing: the host reports the contacts")
        .cost("nothing");
    registrar
        .component<ImpulseRows>("Response/Impulse", "impulses with Coulomb friction and restitution; contacts that no longer bounce rest")
        .command<respond>(Phase::Respond, "Response/Respond", "applies the impulses of an impact, or of resting contacts over a step")
        .cost("one 3x3 solve per contact and sweep")
        .limits(
            "Gauss-Seidel: sweeps grow with the height of a stack and the mass ratio within it; impacts of several "
            "pairs at one time happen one after the other")
        .source("Mirtich (1996) chapter 3; Stronge (2000) chapter 5; Moreau (1988)");
}
