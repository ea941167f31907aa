#include "publish/entries.h"

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

}  // namespace

std::vector<Parameter> parameters_of(const world::World& world, std::uint32_t component, unsigned kinds)
{
    std::vector<Parameter> out;
    for (const Field& field : world.table_of(component).schema().fields())
        if ((kinds & world::kind_bit(field.kind)) != 0 && field.type != FieldType::Opaque)
            out.push_back({field.name, model::format_value(world.get(component, field.name)), std::string(field.unit.symbol),
                           std::string(model::name_of(field.kind))});
    return out;
}

ObjectEntry object_entry(const simulation::Simulation& s, const Roster::Member& member, const std::string& name)
{
    const world::World& world = s.world();
    const world::Component& c = world.component(member.index);
    ObjectEntry out;
    out.component = c.id, out.name = name, out.type = member.type->info.name;
    out.handle = member.handle, out.run = s.run(), out.quarantined = c.quarantined;
    out.is_shaft = c.facet == Facet::Shaft;
    const std::uint32_t row = c.host_index;
    const Bodies& bodies = world.host().bodies;
    const Shafts& shafts = world.host().shafts;
    out.motion = out.is_shaft ? shafts.motion[row] : bodies.motion[row];
    out.mass = out.is_shaft ? shafts.inertia[row] : bodies.mass[row];
    out.pose = out.is_shaft ? shafts.axle[row] : bodies.pose(row);
    out.shapes = ids_of(world, out.is_shaft ? shafts.shapes[row] : bodies.shapes[row]);
    const Value color = world.get(member.index, "color");
    if (const auto* rgb = std::get_if<Vec3>(&color)) out.color = *rgb;
    out.parameters = parameters_of(world, member.index, kGivenKinds);
    return out;
}

ShapeEntry shape_entry(const simulation::Simulation& s, const Roster::Member& member)
{
    const world::Component& c = s.world().component(member.index);
    return {c.id, member.type->info.name, s.world().host().shapes.geometry[c.host_index]};
}

InteractionEntry interaction_entry(const simulation::Simulation& s, const Roster::Member& member, const std::string& name)
{
    const world::World& world = s.world();
    const world::Component& c = world.component(member.index);
    InteractionEntry out;
    out.component = c.id, out.name = name, out.type = member.type->info.name, out.family = member.type->info.family;
    out.run = s.run(), out.since = member.since, out.quarantined = c.quarantined;
    for (const Role& role : world.table_of(member.index).schema().roles())
        out.roles.push_back({role.name, ids_of(world, world.participants(member.index, role))});
    out.parameters = parameters_of(world, member.index, kGivenKinds);
    return out;
}

SceneEntry scene_entry(const simulation::Simulation& s, const Roster& roster)
{
    const model::SceneSettings& settings = s.world().scene().settings;
    SceneEntry out;
    out.run = s.run(), out.file = s.world().scene().file, out.title = settings.title;
    out.dt = s.dt(), out.seed = settings.seed, out.cameras = settings.cameras;
    out.objects = static_cast<std::uint32_t>(roster.count(Roster::Kind::Object));
    out.interactions = static_cast<std::uint32_t>(roster.count(Roster::Kind::Interaction));
    return out;
}

}  // namespace plab::publish
