#include "link/json.h"

#include "link/json_text.h"

namespace plab::link
{
namespace
{

Json outcome(const StepOutcome& o)
{
    return {{"energy", o.energy}, {"momentum", {o.momentum[0], o.momentum[1], o.momentum[2]}}, {"error", o.error}, {"cost_ns", o.cost_ns}};
}

Json roles(const std::vector<Participants>& participants)
{
    Json out = Json::object();
    for (const Participants& p : participants) out[p.role] = p.members;
    return out;
}

Json field(const FieldInfo& f)
{
    return {{"name", f.name},
            {"kind", f.kind},
            {"value_type", f.value_type},
            {"unit", f.unit},
            {"fallback", f.fallback},
            {"required", f.required},
            {"rule", f.rule},
            {"doc", f.doc}};
}

Json role(const RoleInfo& r)
{
    const Json most = r.most == kAnyNumber ? Json() : Json(r.most);
    return {{"name", r.name}, {"accepts", r.accepts}, {"least", r.least}, {"most", most}, {"doc", r.doc}};
}

template <class T, class Convert>
Json array(const std::vector<T>& items, Convert convert)
{
    Json out = Json::array();
    for (const T& item : items) out.push_back(convert(item));
    return out;
}

Json kept(const ServerInfo::KeptSnapshot& s)
{
    return {{"name", s.name}, {"run", s.run}, {"step", s.step}, {"time", s.time}, {"bytes", s.bytes}};
}

/// Null where nothing is recorded.
Json recording(const ServerInfo::Recording& r)
{
    if (r.file.empty()) return {};
    return {{"file", r.file}, {"trouble", r.trouble}, {"bytes", r.bytes}, {"messages", r.messages}, {"dropped", r.dropped}};
}

Json triple(const plab_v2_Vector& v) { return Json::array({v.x, v.y, v.z}); }

/// What the entries of events and of collisions begin with.
template <class Sample>
Json place(const Sample& sample, std::uint32_t entry)
{
    return {{"run", sample.run}, {"sequence_number", sample.sequence_number + entry}, {"step", sample.step}};
}

}  // namespace

Json json_of(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }
Json json_of(const Quat& q) { return Json::array({q.w, q.x, q.y, q.z}); }

Json json_of(const ServerInfo& s)
{
    Json dropped = Json::object();
    for (const auto& [topic, samples] : s.dropped) dropped[topic] = samples;
    return {{"name", s.name},
            {"version", s.version},
            {"host", s.host},
            {"process", s.process},
            {"started_ns", s.started_ns},
            {"scene_file", s.scene_file},
            {"run", s.run},
            {"revision", s.revision},
            {"step", s.step},
            {"time", s.time},
            {"dt", s.dt},
            {"paused", s.paused},
            {"rate_asked", s.rate_asked},
            {"rate_reached", s.rate_reached},
            {"slipped", s.slipped},
            {"overload", s.overload},
            {"states_per_second", s.states_per_second},
            {"threads", s.threads},
            {"last_event", s.last_event},
            {"last_collision", s.last_collision},
            {"requests_done", s.requests_done},
            {"requests_refused", s.requests_refused},
            {"dropped", dropped},
            {"playback", s.playback},
            {"rewind_from", s.rewind_from < 0 ? Json() : Json(s.rewind_from)},
            {"snapshots", array(s.snapshots, kept)},
            {"recording", recording(s.recording)}};
}

Json json_of(const std::vector<Parameter>& parameters)
{
    Json out = Json::object();
    for (const Parameter& p : parameters) out[p.name] = {{"text", p.text}, {"unit", p.unit}, {"kind", p.kind}};
    return out;
}

Json json_of(const Object& o)
{
    return {{"id", o.id},
            {"name", o.name},
            {"type", o.type},
            {"kind", o.is_shaft ? "shaft" : "body"},
            {"motion", o.motion},
            {o.is_shaft ? "inertia" : "mass", o.mass},
            {"position", json_of(o.position)},
            {"orientation", json_of(o.orientation)},
            {"color", o.color ? json_of(*o.color) : Json()},
            {"shapes", o.shapes},
            {"handle", o.handle},
            {"run", o.run},
            {"quarantined", o.quarantined},
            {"parameters", json_of(o.parameters)}};
}

Json json_of(const Shape& s)
{
    return {{"id", s.id},
            {"type", s.type},
            {"form", s.form},
            {"position", json_of(s.position)},
            {"orientation", json_of(s.orientation)},
            {"size", json_of(s.size)},
            {"vertices", s.vertices.size()},
            {"triangles", s.triangles.size()}};
}

Json json_of(const Interaction& i)
{
    return {{"id", i.id},
            {"name", i.name},
            {"type", i.type},
            {"family", i.family},
            {"run", i.run},
            {"since", i.since},
            {"roles", roles(i.roles)},
            {"quarantined", i.quarantined},
            {"parameters", json_of(i.parameters)}};
}

Json json_of(const InteractionMetrics& m)
{
    return {{"requested", m.requested}, {"resolved", m.resolved}, {"cost_ns", m.cost_ns},
            {"error", m.error},         {"work", m.work},         {"outputs", json_of(m.outputs)}};
}

Json json_of(const Metrics& m)
{
    Json interactions = Json::object();
    for (const InteractionMetrics& i : m.interactions)
    {
        interactions[i.component] = json_of(i);
        interactions[i.component]["quarantined"] = i.quarantined;
    }
    return {
        {"run", m.run},
        {"revision", m.revision},
        {"step", m.step},
        {"time", m.time},
        {"step_ns", m.step_ns},
        {"real_time_factor", m.real_time_factor},
        {"energy",
         {{"kinetic", m.kinetic}, {"stored", m.stored}, {"work", m.work}, {"of_requests", m.of_requests}, {"unexplained", m.unexplained}}},
        {"momentum", json_of(m.momentum)},
        {"angular_momentum", json_of(m.angular_momentum)},
        {"residual", m.residual},
        {"deepest", m.deepest},
        {"contacts", m.contacts},
        {"interactions", interactions}};
}

Json json_of(const Type& t)
{
    return {{"name", t.name},
            {"family", t.family},
            {"doc", t.doc},
            {"plugin", t.plugin},
            {"loaded", t.loaded},
            {"order", t.order},
            {"accuracy", t.accuracy},
            {"strengths", t.strengths},
            {"cost", t.cost},
            {"limits", t.limits},
            {"source", t.source},
            {"roles", array(t.roles, role)},
            {"fields", array(t.fields, field)}};
}

Json json_of(const SwapReport& s)
{
    Json fields = Json::object();
    for (const TransferredField& f : s.fields) fields[f.name] = f.transfer;
    return {{"component", s.component},
            {"from", s.from},
            {"to", s.to},
            {"fields", fields},
            {"energy_before", s.energy_before},
            {"with_old", outcome(s.with_old)},
            {"with_new", outcome(s.with_new)}};
}

Json json_of(const Reply& r)
{
    return {{"outcome", r.outcome},
            {"repeated", r.repeated},
            {"reasons", r.reasons},
            {"run", r.run},
            {"revision", r.revision},
            {"step", r.step},
            {"time", r.time},
            {"pause_ns", r.pause_ns},
            {"waited_ns", r.waited_ns},
            {"trial", r.trial},
            {"swaps", array(r.swaps, [](const SwapReport& s) { return json_of(s); })}};
}

Json json_of(const plab_v2_Events& sample, std::uint32_t entry)
{
    const plab_v2_EventInfo& e = sample.entries._buffer[entry];
    Json out = place(sample, entry);
    out.update({{"time", e.time},
                {"kind", e.kind},
                {"severity", e.severity},
                {"component", e.component_id},
                {"a", e.a},
                {"b", e.b},
                {"message", e.message},
                {"values", std::vector<double>(e.values._buffer, e.values._buffer + e.values._length)}});
    return out;
}

Json json_of(const plab_v2_Collisions& sample, std::uint32_t entry)
{
    const plab_v2_CollisionInfo& c = sample.entries._buffer[entry];
    Json out = place(sample, entry);
    out.update({{"time", c.time},
                {"kind", c.kind},
                {"detector", c.detector},
                {"a", c.a},
                {"b", c.b},
                {"position", triple(c.position)},
                {"normal", triple(c.normal)},
                {"impulse", triple(c.impulse)},
                {"depth", c.depth}});
    return out;
}

std::string line_of(const Json& json) { return safe_json(json.dump(-1, ' ', false, Json::error_handler_t::replace)); }

}  // namespace plab::link
