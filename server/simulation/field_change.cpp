#include "simulation/field_change.h"

#include <cmath>

#include "model/values.h"

namespace plab::simulation
{

void keep_motion(world::World& world, std::uint32_t component, const Bodies& before)
{
    const world::Component& c = world.component(component);
    if (c.facet != Facet::Body) return;
    const std::uint32_t b = c.host_index;
    world::HostTables& host = world.host();
    const Bodies& now = host.bodies;
    if (now.motion[b] == before.motion[b] && now.center_B[b] == before.center_B[b] && now.inertia_B[b] == before.inertia_B[b]) return;
    world::HostTables old = host;
    old.bodies = before;
    for (const char* name : {"orientation", "position", "angular_velocity", "linear_velocity"})
        world::set_hosted(host, Facet::Body, b, name, world::get_hosted(old, Facet::Body, b, name));
    if (now.motion[b] == Motion::Static) host.bodies.velocity[b] = host.bodies.angular_velocity[b] = host.bodies.angular_momentum[b] = {};
}

Result<void> prepare_dependents(world::World& world, std::uint32_t component, std::set<std::uint32_t>& prepared)
{
    if (world.component(component).facet != Facet::Shape) return {};
    for (const std::uint32_t who : world.referrers(component))
    {
        const Bodies before = world.host().bodies;
        prepared.insert(who);
        if (auto done = world.prepare(who); !done) return done;
        keep_motion(world, who, before);
        if (auto done = prepare_dependents(world, who, prepared); !done) return done;
    }
    return {};
}

Result<void> set_field(world::World& world, std::uint32_t component, const std::string& name, Value value,
                       std::set<std::uint32_t>& prepared)
{
    const model::ComponentType* type = world.type_of(component);
    if (!type) return reason("is a group");
    const Field* field = type->schema.find_field(name);
    if (!field) return reason("has no field '" + name + "'");
    if (const auto* number = std::get_if<double>(&value); number && field->type == FieldType::Integer && std::nearbyint(*number) == *number)
        value = static_cast<std::int64_t>(*number);
    if (auto fits = model::check_value(value, *field); !fits) return reason(name + ": " + fits.error().reason);
    const Bodies before = world.host().bodies;
    const bool quarantined = world.component(component).quarantined;
    if (auto done = world.set(component, name, value); !done) return done;
    world.quarantine(component, false);  // a mended component gets another chance
    if (field->kind == FieldKind::State && !quarantined) return {};
    prepared.insert(component);
    const world::HostTables moved = world.host();
    if (auto done = world.prepare(component); !done) return done;
    keep_motion(world, component, field->kind == FieldKind::State ? moved.bodies : before);
    return prepare_dependents(world, component, prepared);
}

}  // namespace plab::simulation
