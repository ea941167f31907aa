#include "ode_detection.h"

namespace plab::detection
{
namespace
{
void report_complaints(const StepContext& context, Row row, const OdeScene& scene)
{
    if (!context.events) return;
    for (std::size_t i = 0; i < scene.colliders().size(); ++i)
    {
        const std::string& why = scene.colliders()[i].complaint();
        if (why.empty()) continue;
        Event e;
        e.tick = context.tick, e.time = context.time, e.kind = "detection.shape", e.severity = Severity::Warning;
        e.component = row < context.component_of_row.size() ? context.component_of_row[row] : kNoIndex;
        e.a = {Facet::Shape, scene.shapes()[i]};
        e.message = "the shape does not collide: " + why;
        context.events->emit(std::move(e));
    }
}

/// A bowl, a room or a ground with hills would otherwise show as a block on which bodies lie in the air.
void report_filled_hollows(const StepContext& context, Row row, OdeScene& scene)
{
    if (!context.events) return;
    for (const auto& [body, shape] : scene.fresh_filled_hollows())
    {
        Event e;
        e.tick = context.tick, e.time = context.time, e.kind = "detection.hull", e.severity = Severity::Warning;
        e.component = row < context.component_of_row.size() ? context.component_of_row[row] : kNoIndex;
        e.a = {Facet::Shape, shape}, e.b = {Facet::Body, body};
        e.message =
            "this mesh of a body that does not move collides as its convex hull, which covers its hollows or openings; "
            "surface_collides=\"true\" lets it collide as its triangles";
        context.events->emit(std::move(e));
    }
}

/// A misspelt role or a forgotten shape would otherwise show in bodies that fall through one another alone.
void report_idle(const StepContext& context, Row row, const OdeScene& scene)
{
    const OdeScene::Participants p = scene.participants();
    if (p.any_pair() || p.dynamic == 0) return;
    const auto bodies = [](std::size_t n) { return std::to_string(n) + (n == 1 ? " body" : " bodies"); };
    context.emit(row, "detection.idle", Severity::Warning,
                 "no two bodies can collide: `between` has " + bodies(p.between) + " with a shape, and `against` has " + bodies(p.against));
}
}  // namespace

void OdeRows::describe(Schema& s)
{
    s.role(between, "between", {Facet::Body}, "bodies that collide with one another").writes().independent();
    s.role(against, "against", {Facet::Body}, "bodies that collide with those in `between`, not with one another")
        .optional()
        .writes()
        .independent();
    s.role(resolution, "resolution", {Facet::Component}, "finds the time of an impact")
        .family("Resolution/")
        .default_type("Resolution/Automatic");
    s.role(response, "response", {Facet::Component}, "answers contacts").family("Response/").default_type("Response/Automatic");
    s.param(space, "space", unit::one,
            "broad-phase search: pLab's tree of boxes (hash, in older scenes, means the same) or one of ODE's "
            "spaces; the choice changes no result")
        .or_else("tree")
        .one_of({"tree", "hash", "simple", "sweep_and_prune", "quadtree"});
    s.output(pairs, "pairs", unit::one, "number of shape pairs with overlapping bounding boxes in the last detection pass");
    s.output(penetration, "penetration", unit::metre, "deepest overlap in the last detection pass").reported_as_error();
    s.scratch(scene, "scene", "collision geometry, one per body and shape; rebuilt from bodies and shapes when needed");
}

void prepare(Row row, OdeRows& rows) { rows.scene[row].reset(); }

Result<void> detect(const StepContext& context, Row row, OdeRows& rows, const Bodies& bodies, const Shapes& shapes,
                    const CollisionFilter& filter, ContactSink& sink)
{
    if (!start_ode()) return reason("the ODE library could not be initialised");
    auto& scene = rows.scene[row];
    if (!scene) scene = std::make_unique<OdeScene>();
    if (scene->update(context, rows.space[row], rows.between[row], rows.against[row], bodies, shapes, sink))
    {
        report_complaints(context, row, *scene), report_idle(context, row, *scene);
        report_filled_hollows(context, row, *scene);
    }
    scene->detect(context, bodies, filter, sink);
    if (!sink.motion_margin().empty()) return {};  // this query asked for candidate pairs, not for contacts
    if (!sink.only_persistent()) rows.pairs[row] = static_cast<std::int64_t>(scene->pairs());
    rows.penetration[row] = scene->penetration();
    return {};
}

Result<void> measure_gap(Row row, OdeRows& rows, const Bodies& bodies, const CollisionFilter& filter, GapQuery& query)
{
    if (!start_ode()) return reason("the ODE library could not be initialised");
    if (!rows.scene[row]) return reason("a gap can be measured only after a detection pass");
    rows.scene[row]->measure(query, bodies, filter);
    return {};
}

}  // namespace plab::detection
