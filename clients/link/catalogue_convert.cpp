#include "link/catalogue_convert.h"

#include <algorithm>
#include <span>

namespace plab::link
{
namespace
{

/// A sequence of the C mapping.
template <class Sequence>
auto items(const Sequence& s)
{
    return std::span(s._buffer, s._buffer == nullptr ? 0 : s._length);
}

template <class Sequence, class Convert>
auto list(const Sequence& s, Convert convert)
{
    std::vector<decltype(convert(*s._buffer))> out;
    out.reserve(s._length);
    for (const auto& item : items(s)) out.push_back(convert(item));
    return out;
}

Vec3 vector(const plab_v2_Vector& v) { return {v.x, v.y, v.z}; }
Quat rotation(const plab_v2_Rotation& q) { return {q.w, q.x, q.y, q.z}; }
std::string text(const char* t) { return t; }
Parameter parameter(const plab_v2_Parameter& p) { return {p.name, p.text, p.unit, p.kind}; }
Participants participants(const plab_v2_Participants& p) { return {p.role, list(p.members, text)}; }
Camera camera(const plab_v2_View& v) { return {v.name, vector(v.position), vector(v.look_at), vector(v.up), v.field_of_view}; }
RoleInfo role(const plab_v2_RoleInfo& r) { return {r.name, r.accepts, r.doc, r.least, r.most}; }
FieldInfo field(const plab_v2_FieldInfo& f) { return {f.name, f.kind, f.value_type, f.unit, f.fallback, f.rule, f.doc, f.required}; }

InteractionMetrics interaction_metrics(const plab_v2_InteractionMetrics& m)
{
    return {m.component_id, m.requested, m.resolved, m.cost_ns, m.error, m.work, m.quarantined, list(m.outputs, parameter)};
}

}  // namespace

Scene scene_of(const plab_v2_Scene& s)
{
    return {s.run, s.file, s.title, s.dt, s.seed, s.objects, s.interactions, list(s.cameras, camera)};
}

Object object_of(const plab_v2_SceneObject& o)
{
    Object out;
    out.id = o.component_id, out.name = o.name, out.type = o.type_name;
    out.handle = o.handle, out.run = o.run, out.is_shaft = text(o.shape_of) == "shaft";
    out.motion = o.motion, out.mass = o.mass;
    out.position = vector(o.position), out.orientation = rotation(o.orientation);
    if (o.color.x >= 0 && o.color.y >= 0 && o.color.z >= 0) out.color = vector(o.color);
    out.shapes = list(o.shapes, text), out.quarantined = o.quarantined, out.parameters = list(o.parameters, parameter);
    return out;
}

Shape shape_of(const plab_v2_Shape& s)
{
    Shape out;
    out.id = s.component_id, out.type = s.type_name, out.form = s.form;
    out.position = vector(s.position), out.orientation = rotation(s.orientation), out.size = vector(s.size);
    out.vertices = list(s.vertices, vector);
    const auto indices = items(s.triangles);
    out.triangles.reserve(indices.size() / 3);
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
        if (std::max({indices[i], indices[i + 1], indices[i + 2]}) < out.vertices.size())
            out.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    return out;
}

Interaction interaction_of(const plab_v2_Interaction& i)
{
    return {i.component_id,
            i.name,
            i.type_name,
            i.family,
            i.run,
            i.since,
            list(i.roles, participants),
            i.quarantined,
            list(i.parameters, parameter)};
}

Type type_of(const plab_v2_Type& t)
{
    Type out;
    out.name = t.type_name, out.family = t.family, out.doc = t.doc, out.plugin = t.plugin;
    out.loaded = t.is_loaded, out.order = t.order;
    out.accuracy = t.accuracy, out.strengths = t.strengths, out.cost = t.cost, out.limits = t.limits, out.source = t.source;
    out.roles = list(t.roles, role), out.fields = list(t.fields, field);
    return out;
}

Metrics metrics_of(const plab_v2_Metrics& m)
{
    Metrics out;
    out.run = m.run, out.revision = m.revision, out.step = m.step, out.time = m.time;
    out.step_ns = m.step_ns, out.real_time_factor = m.real_time_factor;
    out.kinetic = m.ledger.kinetic, out.stored = m.ledger.stored, out.work = m.ledger.work;
    out.of_requests = m.ledger.of_requests, out.unexplained = m.ledger.unexplained;
    out.momentum = vector(m.momentum), out.angular_momentum = vector(m.angular_momentum);
    out.residual = m.residual, out.deepest = m.deepest, out.contacts = m.contacts;
    out.interactions = list(m.interactions, interaction_metrics);
    return out;
}

}  // namespace plab::link
