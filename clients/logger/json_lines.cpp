// Each line is an object whose "type" is one of event, collision, metrics, status, gap, run, server. The other keys are the
// names of idl/plab.idl.
#include "link/json_text.h"
#include "logger/lines.h"

namespace plab::logger
{
namespace
{

using link::JsonWriter;

JsonWriter begin(const char* type)
{
    JsonWriter json;
    json.open('{').key("type").value(type);
    return json;
}

template <class T>
void put(JsonWriter& json, const char* key, const T& value)
{
    json.key(key).value(value);
}
void put(JsonWriter& json, const char* key, const plab_v2_Vector& v)
{
    json.key(key).open('[').value(v.x).value(v.y).value(v.z).close(']');
}

std::string end(JsonWriter& json) { return json.close('}').take(); }

class JsonLines final : public Lines
{
public:
    std::string event(const plab_v2_Events& sample, std::uint32_t index) const override
    {
        const plab_v2_EventInfo& e = sample.entries._buffer[index];
        JsonWriter json = begin("event");
        put_place(json, sample, index);
        put(json, "time", e.time);
        put(json, "kind", e.kind);
        put(json, "severity", e.severity);
        put(json, "component", e.component_id);
        put(json, "a", e.a);
        put(json, "b", e.b);
        put(json, "message", e.message);
        json.key("values").open('[');
        for (std::uint32_t i = 0; i < e.values._length; ++i) json.value(e.values._buffer[i]);
        json.close(']');
        return end(json);
    }

    std::string collision(const plab_v2_Collisions& sample, std::uint32_t index) const override
    {
        const plab_v2_CollisionInfo& c = sample.entries._buffer[index];
        JsonWriter json = begin("collision");
        put_place(json, sample, index);
        put(json, "time", c.time);
        put(json, "kind", c.kind);
        put(json, "detector", c.detector);
        put(json, "a", c.a);
        put(json, "b", c.b);
        put(json, "position", c.position);
        put(json, "normal", c.normal);
        put(json, "impulse", c.impulse);
        put(json, "depth", c.depth);
        return end(json);
    }

    std::string metrics(const plab_v2_Metrics& m) const override
    {
        JsonWriter json = begin("metrics");
        put(json, "run", m.run);
        put(json, "revision", m.revision);
        put(json, "step", m.step);
        put(json, "time", m.time);
        put(json, "step_ns", m.step_ns);
        put(json, "real_time_factor", m.real_time_factor);
        json.key("ledger").open('{');
        put(json, "kinetic", m.ledger.kinetic);
        put(json, "stored", m.ledger.stored);
        put(json, "work", m.ledger.work);
        put(json, "of_requests", m.ledger.of_requests);
        put(json, "unexplained", m.ledger.unexplained);
        json.close('}');
        put(json, "momentum", m.momentum);
        put(json, "angular_momentum", m.angular_momentum);
        put(json, "residual", m.residual);
        put(json, "deepest", m.deepest);
        put(json, "contacts", m.contacts);
        json.key("interactions").open('[');
        for (std::uint32_t i = 0; i < m.interactions._length; ++i) put_interaction(json, m.interactions._buffer[i]);
        json.close(']');
        return end(json);
    }

    std::string status(const plab_v2_Server& s) const override
    {
        JsonWriter json = begin("status");
        put_server(json, link::server_of(s));
        return end(json);
    }

    std::string gap(const Gap& gap) const override
    {
        JsonWriter json = begin("gap");
        put(json, "topic", gap.topic);
        put(json, "missed", gap.missed);
        put(json, "first", gap.first);
        put(json, "last", gap.first + gap.missed - 1);
        return end(json);
    }

    std::string run(std::uint64_t run) const override
    {
        JsonWriter json = begin("run");
        put(json, "run", run);
        return end(json);
    }

    std::string server(ServerChange change, const link::ServerInfo& info) const override
    {
        JsonWriter json = begin("server");
        put(json, "change", change == ServerChange::Found ? "found" : change == ServerChange::Gone ? "gone" : "back");
        if (change == ServerChange::Gone)
            put(json, "name", info.name);
        else
            put_server(json, info);
        return end(json);
    }

private:
    template <class Sample>
    static void put_place(JsonWriter& json, const Sample& sample, std::uint32_t index)
    {
        put(json, "run", sample.run);
        put(json, "sequence_number", sample.sequence_number + index);
        put(json, "step", sample.step);
    }

    static void put_interaction(JsonWriter& json, const plab_v2_InteractionMetrics& i)
    {
        json.open('{');
        put(json, "component", i.component_id);
        put(json, "requested", i.requested);
        put(json, "resolved", i.resolved);
        put(json, "cost_ns", i.cost_ns);
        put(json, "error", i.error);
        put(json, "work", i.work);
        put(json, "quarantined", i.quarantined);
        json.key("outputs").open('{');
        for (std::uint32_t k = 0; k < i.outputs._length; ++k) put(json, i.outputs._buffer[k].name, i.outputs._buffer[k].text);
        json.close('}').close('}');
    }

    static void put_server(JsonWriter& json, const link::ServerInfo& s)
    {
        put(json, "name", s.name);
        put(json, "version", s.version);
        put(json, "host", s.host);
        put(json, "process", s.process);
        put(json, "started_ns", s.started_ns);
        put(json, "scene_file", s.scene_file);
        put(json, "run", s.run);
        put(json, "revision", s.revision);
        put(json, "step", s.step);
        put(json, "time", s.time);
        put(json, "paused", s.paused);
        put(json, "rate_asked", s.rate_asked);
        put(json, "rate_reached", s.rate_reached);
        put(json, "slipped", s.slipped);
        put(json, "overload", s.overload);
        json.key("dropped").open('{');
        for (const auto& [topic, samples] : s.dropped) put(json, topic.c_str(), samples);
        json.close('}');
    }
};

}  // namespace

std::unique_ptr<Lines> make_json_lines() { return std::make_unique<JsonLines>(); }

}  // namespace plab::logger
