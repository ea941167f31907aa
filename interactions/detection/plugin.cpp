#include "plab/plugin.h"
#include "exclude.h"
#include "ode_detection.h"

PLAB_PLUGIN("detection", registrar)
{
    using namespace plab;
    registrar
        .component<detection::OdeRows>(
            "CDetection/ODE",
            "finds the contacts of rigid bodies: broad phase by pLab's own tree of boxes or by a collision space "
            "of the Open Dynamics Engine (ODE), narrow phase entirely by pLab")
        .command<detection::prepare>(Phase::Prepare, "CDetection/Prepare",
                                     "discards the collision geometry; the next detection pass rebuilds it")
        .host_command(Phase::Prepare, "CDetection/Add", "adds the bodies' shapes to the space; done inside Handle")
        .host_command(Phase::Advance, "CDetection/Update", "moves the geometries with their bodies; done inside Handle")
        .command<detection::detect>(Phase::Detect, "CDetection/Handle", "finds where bodies touch")
        .command<detection::measure_gap>(Phase::Gap, "CDetection/Gap", "measures the distance between two bodies")
        .cost(
            "one bounding box per shape; tree: about log n per moved shape; sweep_and_prune: about linear in the "
            "number of shapes")
        .limits(
            "half-spaces and surfaces do not collide with themselves or one another; meshes collide as their "
            "convex hulls or as surfaces; no continuous collision detection (a resolution locates impacts)")
        .source(
            "ODE 0.16.2 for its collision spaces; Gilbert, Johnson, Keerthi (1988) for distances; van den "
            "Bergen, GDC (2001) for depths; Gottschalk, Lin, Manocha, SIGGRAPH (1996) for box and box");

    registrar.component<detection::ExcludeRows>("Collision/Exclude", "bodies or shapes that do not collide, for all detections")
        .family("Collision/Exclude")
        .command<detection::prepare_exclude>(Phase::Prepare, "Collision/Check", "refuses an exclusion of nothing")
        .command<detection::connect_exclude>(Phase::Connect, "Collision/Connect", "registers the exclusion with the host")
        .cost("a search in two short lists for each pair of bodies whose boxes overlap");
}
