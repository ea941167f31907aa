#include "plab/plugin.h"

#include "viewers.h"

PLAB_PLUGIN("viewers", registrar)
{
    using namespace plab::viewers;
    constexpr const char* kLook = "Viewer/Look";
    constexpr const char* kStates = "states from where the scene is seen";
    registrar.component<FreeRows>("Viewer/Free", "somebody who looks at the scene from a place that requests set")
        .family("Viewer")
        .command<look_freely>(plab::Phase::View, kLook, kStates);
    registrar.component<AttachedRows>("Viewer/Attached", "somebody who looks at the scene from a body")
        .family("Viewer")
        .command<look_from_body>(plab::Phase::View, kLook, kStates);
}
