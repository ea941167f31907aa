#include "web/translate.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "link/json.h"

namespace plab::web
{
namespace
{

Json object_entry(const link::Object& object)
{
    Json out = wire::json_of(object);
    out.erase("parameters"), out.erase("run");
    return out;
}

Json shape_entry(const link::Shape& shape)
{
    Json out = wire::json_of(shape);
    Json vertices = Json::array();
    for (const Vec3& v : shape.vertices) vertices.insert(vertices.end(), {v.x, v.y, v.z});
    out["vertices"] = std::move(vertices);
    out["triangles"] = wire::triangles_of(shape);
    return out;
}

/// Where a joint holds its members: of the parameters, those by which it is drawn.
bool is_drawn(const link::Parameter& p) { return p.name == "point_a" || p.name == "point_b" || p.name == "axis" || p.kind == "level"; }

Json interaction_entry(const link::Interaction& interaction)
{
    Json out{{"id", interaction.component_id}, {"name", interaction.name},   {"type", interaction.type_name},
             {"family", interaction.family},   {"since", interaction.since}, {"quarantined", interaction.quarantined}};
    for (const link::Participants& role : interaction.roles) out["roles"][role.role] = role.members;
    for (const link::Parameter& p : interaction.parameters)
        if (is_drawn(p)) out[p.kind == "level" ? "levels" : "joint"][p.name] = p.text;
    return out;
}

Json parameter_list(const std::vector<link::Parameter>& parameters)
{
    Json out = Json::array();
    for (const link::Parameter& p : parameters) out.push_back({{"name", p.name}, {"text", p.text}, {"unit", p.unit}, {"kind", p.kind}});
    return out;
}

bool same_entry(const link::Interaction& a, const link::Interaction& b)
{
    if (a.type_name != b.type_name || a.name != b.name || a.family != b.family || a.quarantined != b.quarantined || a.since != b.since ||
        a.roles != b.roles)
        return false;
    const auto drawn = [](const link::Interaction& i)
    {
        std::vector<link::Parameter> out;
        std::copy_if(i.parameters.begin(), i.parameters.end(), std::back_inserter(out), is_drawn);
        return out;
    };
    return drawn(a) == drawn(b);
}
template <class T>
bool same_entry(const T& a, const T& b)
{
    return a == b;
}

/// Adds to `out` what `now` has and `before` has not, or has otherwise, and the ids of what is gone.
template <class Thing, class Entry>
void add_changes(const char* key, const std::map<std::string, Thing>& before, const std::map<std::string, Thing>& now, Entry entry,
                 Json& out)
{
    for (const auto& [id, thing] : now)
    {
        const auto old = before.find(id);
        if (old == before.end() || !same_entry(old->second, thing)) out[key].push_back(entry(thing));
    }
    for (const auto& [id, thing] : before)
        if (!now.contains(id)) out["gone"][key].push_back(id);
}

template <class Thing, class Entry>
Json list_of(const std::map<std::string, Thing>& things, Entry entry)
{
    Json out = Json::array();
    for (const auto& [id, thing] : things) out.push_back(entry(thing));
    return out;
}

Json scene_entry(const link::Scene& scene)
{
    Json out{{"title", scene.title}, {"file", scene.file}, {"dt", scene.dt}, {"run", scene.run}, {"cameras", Json::array()}};
    for (const link::Camera& c : scene.cameras)
        out["cameras"].push_back({{"name", c.name},
                                  {"position", wire::json_of(c.position)},
                                  {"look_at", wire::json_of(c.look_at)},
                                  {"up", wire::json_of(c.up)},
                                  {"field_of_view", c.field_of_view}});
    return out;
}

Json type_entry(const link::Type& type) { return wire::json_of(type); }

// ---- What a page says -----------------------------------------------------------------------------------------------

constexpr std::size_t kMostOperations = 32;

/// Reads members of one object; the first that is wrong is the error.
class Members
{
public:
    explicit Members(const Json& json) : json_(json) {}
    std::string text(const char* name)
    {
        const auto at = json_.find(name);
        if (at == json_.end()) return {};
        if (at->is_string()) return at->get<std::string>();
        wrong(name, "a text");
        return {};
    }
    double number(const char* name, double fallback)
    {
        const auto at = json_.find(name);
        if (at == json_.end()) return fallback;
        if (at->is_number() && std::isfinite(at->get<double>())) return at->get<double>();
        wrong(name, "a number");
        return fallback;
    }
    std::uint64_t whole(const char* name)
    {
        const double value = number(name, 0);
        if (value >= 0 && value < 9e15 && value == std::floor(value)) return static_cast<std::uint64_t>(value);
        wrong(name, "a whole number");
        return 0;
    }
    Vec3 vector(const char* name)
    {
        const auto at = json_.find(name);
        if (at != json_.end() && at->is_array() && at->size() == 3 && (*at)[0].is_number() && (*at)[1].is_number() && (*at)[2].is_number())
            return {(*at)[0].get<double>(), (*at)[1].get<double>(), (*at)[2].get<double>()};
        wrong(name, "three numbers");
        return {};
    }
    /// An array of at most `most`; empty if there is none.
    const Json& list(const char* name, std::size_t most)
    {
        static const Json kNone = Json::array();
        const auto at = json_.find(name);
        if (at == json_.end()) return kNone;
        if (at->is_array() && at->size() <= most) return *at;
        wrong(name, "a list of at most " + std::to_string(most));
        return kNone;
    }
    void wrong(const char* name, const std::string& what)
    {
        if (error_.empty()) error_ = std::string("'") + name + "' must be " + what;
    }
    const std::string& error() const { return error_; }

private:
    const Json& json_;
    std::string error_;
};

Result<link::Operation> parse_operation(const Json& json)
{
    if (!json.is_object()) return reason("an operation must be an object");
    Members members(json);
    link::Operation out{members.text("verb"), members.text("target"), members.text("argument"), members.text("blueprint"), {}};
    if (out.verb.empty()) members.wrong("verb", "the name of an operation");
    if (const auto values = json.find("values"); values != json.end())
    {
        if (!values->is_object()) members.wrong("values", "an object of texts");
        for (const auto& [name, value] : values->items())
        {
            if (!value.is_string()) return reason("the value of '" + name + "' must be a text");
            out.values.push_back({name, value.get<std::string>()});
        }
    }
    if (!members.error().empty()) return reason(members.error());
    return out;
}

Result<Said> parse_ask(const Json& json, Members& members)
{
    Ask out;
    out.id = members.whole("id");
    for (const Json& one : members.list("operations", kMostOperations))
    {
        auto operation = parse_operation(one);
        if (!operation) return operation.errors();
        out.request.operations.push_back(operation.take());
    }
    if (out.request.operations.empty()) members.wrong("operations", "a list of at least one");
    if (json.contains("at")) out.request.at = static_cast<std::int64_t>(members.whole("at"));
    if (json.contains("revision")) out.request.revision = members.whole("revision");
    if (!members.error().empty()) return reason(members.error());
    return Said{std::move(out)};
}

Result<Said> parse_watch(Members& members)
{
    Watch out;
    for (const Json& id : members.list("components", kMostWatched))
    {
        if (!id.is_string()) return reason("'components' must be a list of texts");
        out.components.insert(id.get<std::string>());
    }
    if (!members.error().empty()) return reason(members.error());
    return Said{std::move(out)};
}

Result<Said> parse_hand(const std::string& type, Members& members)
{
    if (type == "release") return Said{Release{}};
    const Vec3 position = members.vector("position");
    if (!is_finite(position)) members.wrong("position", "finite");
    const Grab grab{members.whole("id"), members.text("body"), position, members.number("force", Grab{}.force)};
    if (type == "grab" && grab.body.empty()) members.wrong("body", "the id of a body");
    if (grab.force <= 0) members.wrong("force", "more than zero");
    if (!members.error().empty()) return reason(members.error());
    return type == "grab" ? Said{grab} : Said{MoveHand{position}};
}

constexpr double kLongestPreview = 60;  // s, simulated

Result<Said> parse_preview(Members& members)
{
    PreviewAsk out{members.whole("id"), members.text("component"), members.text("with"), members.number("seconds", 1)};
    // They become words of a command line: an option is no id.
    if (out.component.empty() || out.component.starts_with('-')) members.wrong("component", "the id of a component");
    if (out.type.empty() || out.type.starts_with('-')) members.wrong("with", "the name of a type");
    if (!(out.seconds > 0) || out.seconds > kLongestPreview) members.wrong("seconds", "more than 0 and at most 60");
    if (!members.error().empty()) return reason(members.error());
    return Said{std::move(out)};
}

/// Whether a name names something is for whoever does it; here it is only kept short.
Result<Said> parse_job(Members& members)
{
    constexpr std::size_t kMostName = 200;
    JobAsk out{members.whole("id"), members.text("verb"), members.text("name"), members.number("value", 0)};
    if (out.verb.empty()) members.wrong("verb", "what is to be done");
    if (out.name.size() > kMostName) members.wrong("name", "at most " + std::to_string(kMostName) + " bytes long");
    if (!members.error().empty()) return reason(members.error());
    return Said{std::move(out)};
}

}  // namespace

MessagePtr message_of(const Json& json) { return std::make_shared<Message>(link::line_of(json)); }

Json scene_message(const link::CatalogueContents& now)
{
    Json out{{"type", "scene"}};
    out["scene"] = now.scene ? scene_entry(*now.scene) : Json();
    out["server"] = now.server ? wire::json_of(*now.server) : Json();
    out["objects"] = list_of(now.objects, object_entry);
    out["shapes"] = list_of(now.shapes, shape_entry);
    out["interactions"] = list_of(now.interactions, interaction_entry);
    out["types"] = list_of(now.types, type_entry);
    return out;
}

std::optional<Json> changes_message(const link::CatalogueContents& before, const link::CatalogueContents& now)
{
    Json out{{"type", "changes"}};
    if (now.scene && (!before.scene || !(*before.scene == *now.scene))) out["scene"] = scene_entry(*now.scene);
    add_changes("objects", before.objects, now.objects, object_entry, out);
    add_changes("shapes", before.shapes, now.shapes, shape_entry, out);
    add_changes("interactions", before.interactions, now.interactions, interaction_entry, out);
    add_changes("types", before.types, now.types, type_entry, out);
    return out.size() > 1 ? std::optional(std::move(out)) : std::nullopt;
}

Json server_message(const link::ServerInfo& server) { return {{"type", "server"}, {"server", wire::json_of(server)}}; }

Json metrics_message(const link::Metrics& metrics, const std::set<std::string>& watched)
{
    link::Metrics head = metrics;
    head.interactions.clear();
    Json out = wire::json_of(head);
    Json rows = Json::array(), details = Json::object();
    for (const link::InteractionMetrics& m : metrics.interactions)
    {
        const link::Parameter* const error = wire::find_account(m, "error");
        rows.push_back({m.component_id, m.resolved, m.cost_ns, error == nullptr ? Json() : Json(m.error), m.work, m.quarantined});
        if (watched.contains(m.component_id)) details[m.component_id] = parameter_list(m.outputs);
    }
    out["interactions"] = std::move(rows), out["watched"] = std::move(details);
    out["type"] = "metrics";
    return out;
}

Json detail_message(const link::CatalogueContents& now, const std::string& component)
{
    Json out{{"type", "detail"}, {"id", component}, {"parameters", nullptr}};
    if (const auto object = now.objects.find(component); object != now.objects.end())
        out["parameters"] = parameter_list(object->second.parameters);
    else if (const auto interaction = now.interactions.find(component); interaction != now.interactions.end())
        out["parameters"] = parameter_list(interaction->second.parameters);
    return out;
}

Json reply_message(std::uint64_t id, const link::Reply& reply)
{
    Json out{{"type", "reply"}, {"id", id}};
    out.update(wire::json_of(reply));
    return out;
}

Json preview_message(std::uint64_t id, const Json& preview)
{
    return {{"type", "reply"}, {"id", id}, {"outcome", "done"}, {"preview", preview}};
}

Json refusal_message(std::uint64_t id, const std::string& reason)
{
    return {{"type", "reply"}, {"id", id}, {"outcome", "unanswered"}, {"reasons", {reason}}};
}

Result<Said> parse_said(const std::string& text)
{
    if (text.size() > kMostText) return reason("the message is longer than " + std::to_string(kMostText) + " bytes");
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object()) return reason("the message is no JSON object");
    Members members(json);
    const std::string type = members.text("type");
    if (type == "request") return parse_ask(json, members);
    if (type == "watch") return parse_watch(members);
    if (type == "contacts") return Said{ContactsAsk{}};
    if (type == "grab" || type == "move" || type == "release") return parse_hand(type, members);
    if (type == "preview") return parse_preview(members);
    if (type == "job") return parse_job(members);
    return reason("'type' must be request, watch, contacts, grab, move, release, preview or job");
}

}  // namespace plab::web
