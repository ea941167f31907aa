/// The plugin of triggers: what people do to objects, and the requests that follow.
#include "plab/plugin.h"

#include "trigger.h"

namespace
{

using namespace plab::triggers;
using plab::Phase;

template <auto Watch, class Table>
void add_trigger(plab::Registrar& registrar, std::string name, std::string doc, std::string limits)
{
    registrar.component<Table>(std::move(name), std::move(doc))
        .family("Trigger")
        .template command<&prepare<Table>>(Phase::Prepare, "Trigger/Prepare", "checks the verb")
        .template command<&ask<Table>>(Phase::Decide, "Trigger/Ask", "makes the request when it has happened")
        .template command<Watch>(Phase::Finish, "Trigger/Watch", "looks whether it happens at the end of the step")
        .strengths("makes an object react to people, without a script")
        .limits(std::move(limits));
}

}  // namespace

PLAB_PLUGIN("triggers", registrar)
{
    add_trigger<&watch_touch, TouchedRows>(registrar, "Trigger/Touched", "a user touches the object",
                                           "needs a detection that pairs them, which it does if one of the two is dynamic");
    add_trigger<&watch_nearness, NearRows>(registrar, "Trigger/Near", "a user is near the object",
                                           "of a mesh all triangles are looked at in each step");
    add_trigger<&watch_ray, PointedAtRows>(registrar, "Trigger/PointedAt", "a user points at the object",
                                           "other objects do not hide it; of a mesh all triangles are looked at");
    add_trigger<&watch_key, KeyRows>(registrar, "Trigger/Key", "a user presses buttons",
                                     "looked at once a step: a key that is pressed and released between two steps is missed");
}
