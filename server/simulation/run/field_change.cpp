#include "simulation/run/field_change.h"

#include <cmath>

#include "model/values.h"

namespace plab::simulation
{

BodyMotion motion_of(const world::World& world, std::uint32_t component)
{
    const world::Component& c = world.component(component);
    if (c.facet != Facet::Body) return {};
    const std::uint32_t b = c.host_index;
    const world::HostTables& host = world.host();
    const auto value = [&](const char* name) { return world::get_hosted(host, Facet::Body, b, name); };
    return {true,
            host.bodies.motion[b],
            host.bodies.center_B[b],
            host.bodies.inertia_B[b],
            value("orientation"),
            value("position"),
            value("angular_velocity"),
            value("linear_velocity")};
}

void keep_motion(world::World& world, std::uint32_t component, const BodyMotion& before)
{
    if (!before.is_body) return;
    const std::uint32_t b = world.component(component).host_index;
    world::HostTables& host = world.host();
    Bodies& now = host.bodies;
    if (now.motion[b] == before.motion && now.center_B[b] == before.center_B && now.inertia_B[b] == before.inertia_B) return;
    world::set_hosted(host, Facet::Body, b, "orientation", before.orientation);
    world::set_hosted(host, Facet::Body, b, "position", before.position);
    world::set_hosted(host, Facet::Body, b, "angular_velocity", before.angular_velocity);
    world::set_hosted(host, Facet::Body, b, "linear_velocity", before.linear_velocity);
    if (now.motion[b] == Motion::Static) now.velocity[b] = now.angular_velocity[b] = now.angular_momentum[b] = {};
}

Result<void> prepare_dependents(world::World& world, std::uint32_t component, std::set<std::uint32_t>& prepared)
{
    if (world.component(component).facet != Facet::Shape) return {};
    for (const std::uint32_t referrer : world.referrers(component))
    {
        const BodyMotion before = motion_of(world, referrer);
        prepared.insert(referrer);
        if (auto done = world.prepare(referrer); !done) return done;
        keep_motion(world, referrer, before);
        if (auto done = prepare_dependents(world, referrer, prepared); !done) return done;
    }
    return {};
}

Result<Value> value_for(const Field& field, const GivenValue& given)
{
    if (const auto* text = std::get_if<std::string>(&given)) return model::parse_value(*text, field);
    Value value = std::get<Value>(given);
    if (const auto* integer = std::get_if<std::int64_t>(&value); integer && field.type == FieldType::Real)
        value = static_cast<double>(*integer);
    if (auto fits = model::check_value(value, field); !fits) return fits.errors();
    return value;
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
    const BodyMotion before = motion_of(world, component);
    const bool quarantined = world.component(component).quarantined;
    if (auto done = world.set(component, name, value); !done) return done;
    world.quarantine(component, false);  // a corrected component is tried again
    if (field->kind == FieldKind::State && !quarantined) return {};
    prepared.insert(component);
    const BodyMotion moved = motion_of(world, component);
    if (auto done = world.prepare(component); !done) return done;
    keep_motion(world, component, field->kind == FieldKind::State ? moved : before);
    return prepare_dependents(world, component, prepared);
}

}  // namespace plab::simulation
