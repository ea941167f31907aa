#include "publish/entries.h"

#include <cmath>

#include "model/values.h"

namespace plab::publish
{
namespace
{

constexpr unsigned kGivenKinds = world::kind_bit(FieldKind::Param) | world::kind_bit(FieldKind::State);

std::vector<std::string> ids_of(const world::World& world, const std::vector<Ref>& refs)
{
    std::vector<std::string> out;
    for (const Ref ref : refs) out.push_back(world.id_of(ref));
    return out;
}

/// The word for an enumerator, in the order of its type.
template <class Enum, std::size_t N>
const char* word(Enum value, const char* const (&words)[N])
{
    return words[static_cast<std::size_t>(value)];
}
constexpr const char* kMotions[] = {"static", "kinematic", "dynamic"};
constexpr const char* kForms[] = {"none", "sphere", "box", "plane", "mesh", "capsule", "cylinder", "compound"};

}  // namespace

std::vector<wire::Parameter> parameters_of(const world::World& world, std::uint32_t component, unsigned kinds)
{
    std::vector<wire::Parameter> out;
    for (const Field& field : world.table_of(component).schema().fields())
        if ((kinds & world::kind_bit(field.kind)) != 0 && field.type != FieldType::Opaque)
            out.push_back({field.name, model::format_value(world.get(component, field.name)), std::string(field.unit.symbol),
                           std::string(model::name_of(field.kind))});
    return out;
}

namespace
{

/// What a governor has to do with the component, as parameters of the kind "level"; nothing if no governor watches it.
void add_level(const simulation::Simulation& s, std::uint32_t component, std::vector<wire::Parameter>& out)
{
    const auto level = s.levels().level(component);
    if (!level) return;
    const auto add = [&](const char* name, std::string text, const char* unit = "") {
        out.push_back({name, std::move(text), unit, "level"});
    };
    add("governor", s.world().id_of(level->governor));
    add("level", std::to_string(level->level)), add("levels", std::to_string(level->levels)), add("level_algorithm", level->text);
    add("level_every", model::format_value(level->every), "s");
    if (!std::isnan(level->error)) add("level_error", model::format_value(level->error), level->error_unit.c_str());
    if (!std::isnan(level->next_look)) add("level_next_look", model::format_value(level->next_look), "s");
    for (const simulation::LevelTrial& trial : level->trials)
    {
        const std::string of = "." + std::to_string(trial.level);
        const auto [error, unit] = simulation::error_of_trial(trial, level->error_unit);
        add(("level_name" + of).c_str(), trial.text);
        if (!std::isnan(error)) add(("level_error" + of).c_str(), model::format_value(error), unit);
        if (trial.seconds > 0) add(("level_cost" + of).c_str(), model::format_value(trial.seconds), "s");
    }
    if (level->reason.empty()) return;
    add("level_reason", level->reason), add("level_since", model::format_value(level->since), "s");
    const simulation::LevelChange& last = level->last;
    add("level_before", last.from);
    const auto add_figure = [&](const char* name, double value, const char* unit)
    {
        if (!std::isnan(value)) add(name, model::format_value(value), unit);
    };
    add_figure("level_cost_before", last.cost.before, "s"), add_figure("level_cost_after", last.cost.after, "s");
    add_figure("level_error_before", last.error.before, last.error.unit.c_str());
    add_figure("level_error_after", last.error.after, last.error.unit.c_str());
}

}  // namespace

wire::SceneObject object_entry(const simulation::Simulation& s, const Roster::Member& member, const std::string& name)
{
    const world::World& world = s.world();
    const world::Component& c = world.component(member.index);
    wire::SceneObject out;
    out.component_id = c.id, out.name = name, out.type_name = member.type->info.name;
    out.handle = member.handle, out.run = s.run(), out.quarantined = c.quarantined;
    const bool is_shaft = c.facet == Facet::Shaft;
    const std::uint32_t row = c.host_index;
    const Bodies& bodies = world.host().bodies;
    const Shafts& shafts = world.host().shafts;
    const Pose pose = is_shaft ? shafts.axle[row] : bodies.pose(row);
    out.shape_of = is_shaft ? "shaft" : "body";
    out.motion = word(is_shaft ? shafts.motion[row] : bodies.motion[row], kMotions);
    out.mass = is_shaft ? shafts.inertia[row] : bodies.mass[row];
    out.position = pose.p, out.orientation = pose.q;
    out.shapes = ids_of(world, is_shaft ? shafts.shapes[row] : bodies.shapes[row]);
    const Value color = world.get(member.index, "color");
    if (const auto* rgb = std::get_if<Vec3>(&color)) out.color = *rgb;
    out.parameters = parameters_of(world, member.index, kGivenKinds);
    add_level(s, member.index, out.parameters);
    return out;
}

wire::Shape shape_entry(const simulation::Simulation& s, const Roster::Member& member)
{
    const world::Component& c = s.world().component(member.index);
    const Geometry& g = s.world().host().shapes.geometry[c.host_index];
    return {c.id, member.type->info.name, word(g.kind, kForms), g.pose.p, g.pose.q, g.size, g.vertices, g.triangles};
}

wire::Interaction interaction_entry(const simulation::Simulation& s, const Roster::Member& member, const std::string& name)
{
    const world::World& world = s.world();
    const world::Component& c = world.component(member.index);
    wire::Interaction out;
    out.component_id = c.id, out.name = name, out.type_name = member.type->info.name, out.family = member.type->info.family;
    out.run = s.run(), out.since = member.since, out.quarantined = c.quarantined;
    for (const Role& role : world.table_of(member.index).schema().roles())
        out.roles.push_back({role.name, ids_of(world, world.participants(member.index, role))});
    out.parameters = parameters_of(world, member.index, kGivenKinds);
    add_level(s, member.index, out.parameters);
    return out;
}

wire::Scene scene_entry(const simulation::Simulation& s, const Roster& roster)
{
    const model::SceneSettings& settings = s.world().scene().settings;
    wire::Scene out;
    out.run = s.run(), out.file = s.world().scene().file, out.title = settings.title;
    out.dt = s.dt(), out.seed = settings.seed;
    for (const model::Camera& c : settings.cameras) out.cameras.push_back({c.name, c.position, c.look_at, c.up, c.field_of_view});
    out.objects = static_cast<std::uint32_t>(roster.count(Roster::Kind::Object));
    out.interactions = static_cast<std::uint32_t>(roster.count(Roster::Kind::Interaction));
    return out;
}

wire::Type type_entry(const model::TypeSummary& type)
{
    wire::Type out;
    out.type_name = type.name, out.family = type.family, out.doc = type.doc, out.plugin = type.plugin;
    out.is_loaded = type.loaded, out.order = type.order;
    out.accuracy = type.accuracy, out.strengths = type.strengths, out.cost = type.cost, out.limits = type.limits, out.source = type.source;
    for (const model::RoleSummary& r : type.roles) out.roles.push_back({r.name, r.accepts, r.least, r.most, r.doc});
    for (const model::FieldSummary& f : type.fields)
        out.fields.push_back({f.name, f.kind, f.value_type, f.unit, f.fallback, f.required, f.rule, f.doc});
    return out;
}

}  // namespace plab::publish
