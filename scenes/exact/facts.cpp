#include "exact/facts.h"

namespace plab::exact
{

State present(const SceneFacts& facts, std::uint32_t i)
{
    State out;
    const world::Component& c = facts.world().component(i);
    if (c.facet == Facet::Shaft)
    {
        out.angle = facts.shafts().angle[c.host_index], out.speed = facts.shafts().speed[c.host_index];
        return out;
    }
    const Bodies& b = facts.bodies();
    out.position = b.position[c.host_index], out.velocity = b.velocity[c.host_index];
    out.orientation = b.orientation[c.host_index], out.angular_velocity = b.angular_velocity[c.host_index];
    return out;
}

Result<std::uint32_t> only_object(const SceneFacts& facts)
{
    const auto bodies = facts.dynamic(Facet::Body), shafts = facts.dynamic(Facet::Shaft);
    if (bodies.size() + shafts.size() != 1)
        return reason("it has " + std::to_string(bodies.size() + shafts.size()) + " moving objects ; this form is for one");
    return bodies.empty() ? shafts.front() : bodies.front();
}

std::vector<std::uint32_t> participants(const SceneFacts& facts, std::uint32_t component, const std::string& name)
{
    std::vector<std::uint32_t> out;
    const world::World& world = facts.world();
    for (const Role& role : world.table_of(component).schema().roles())
        if (role.name == name)
            for (const Ref ref : world.participants(component, role)) out.push_back(world.host().component_of(ref));
    return out;
}

double real_of(const SceneFacts& facts, std::uint32_t component, const std::string& field)
{
    const Value v = facts.world().get(component, field);
    const auto* real = std::get_if<double>(&v);
    return real ? *real : 0.0;
}

Vec3 vector_of(const SceneFacts& facts, std::uint32_t component, const std::string& field)
{
    const Value v = facts.world().get(component, field);
    const auto* vector = std::get_if<Vec3>(&v);
    return vector ? *vector : Vec3{};
}

Error missing_number(const std::string& name, const std::string& what)
{
    return reason("no component has a number '" + name + "' (" + what + "); give it as exact:NAME:" + name + "=VALUE");
}

Result<OnPlane> body_and_plane(const SceneFacts& facts)
{
    const auto bodies = facts.dynamic(Facet::Body);
    if (bodies.size() != 1) return reason("it has " + std::to_string(bodies.size()) + " moving bodies ; this form is for one");
    if (!facts.collides()) return reason("nothing collides: it has no CDetection/...");
    OnPlane out;
    out.body = bodies.front();
    int planes = 0;
    const world::HostTables& host = facts.world().host();
    for (const std::uint32_t i : facts.world().in_id_order())
    {
        const world::Component& c = facts.world().component(i);
        if (c.facet != Facet::Body || i == out.body) continue;
        for (const Ref shape : host.bodies.shapes[c.host_index])
        {
            if (host.shapes.geometry[shape.index].kind != GeometryKind::Plane)
                return reason(c.id + " is not a plane; only one plane is allowed");
            const Pose pose = host.bodies.pose(c.host_index) * host.shapes.geometry[shape.index].pose;
            out.plane = i, out.point = pose.p, out.normal = rotate(pose.q, Vec3{0, 0, 1});
            ++planes;
        }
    }
    if (planes != 1) return reason("it has " + std::to_string(planes) + " planes ; this form is for one");
    if (const std::string other = facts.foreign_force({"Field/Gravity"}); !other.empty())
        return reason(other + " acts too; only Field/Gravity may");
    return out;
}

Result<Geometry> only_shape(const SceneFacts& facts, std::uint32_t body, GeometryKind kind, const std::string& name)
{
    const world::HostTables& host = facts.world().host();
    const RefList& shapes = host.bodies.shapes[facts.world().component(body).host_index];
    if (shapes.size() != 1 || host.shapes.geometry[shapes.front().index].kind != kind)
        return reason(facts.world().id_of(body) + " is no " + name);
    return host.shapes.geometry[shapes.front().index];
}

Result<double> law_of(const SceneFacts& facts, const std::string& name)
{
    if (!facts.of_type("Material/Pair").empty()) return reason("materials set " + name + "; give it as exact:...:" + name + "=VALUE");
    const auto value = facts.number(name);
    if (!value) return reason("its response has no '" + name + "'; give it as exact:...:" + name + "=VALUE");
    return *value;
}

}  // namespace plab::exact
