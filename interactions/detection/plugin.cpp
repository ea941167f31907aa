#include "plab/plugin.h"
#include "ode_detection.h"

PLAB_PLUGIN("detection", registrar)
{
    using namespace plab;
    registrar
        .component<detection::OdeRows>("CDetection/ODE", "finds contacts of rigid bodies with the Open Dynamics Engine's collision spaces")
        .command<detection::prepare>(Phase::Prepare, "CDetection/Prepare", "forgets the geometries; they are made anew at the next look")
        .host_command(Phase::Prepare, "CDetection/Add", "adds the bodies' shapes to the space; done inside Handle")
        .host_command(Phase::Advance, "CDetection/Update", "moves the geometries with their bodies; done inside Handle")
        .command<detection::detect>(Phase::Detect, "CDetection/Handle", "finds where bodies touch")
        .command<detection::measure_gap>(Phase::Gap, "CDetection/Gap", "measures how far two bodies are apart")
        .cost("one bounding volume per shape; hash and sweep_and_prune about linear in bodies")
        .limits(
            "half-spaces and surfaces meet neither one another nor themselves; meshes collide as their convex hulls or as surfaces; no "
            "continuous collision")
        .source("ODE 0.16.2 (box-box, spaces); Snethen, XenoCollide, Game Programming Gems 7 (2008) for hulls");
}
