#include "link/json.h"

#include <initializer_list>

#include "idl/samples.h"
#include "link/json_text.h"

namespace plab::link
{
namespace
{

/// A list of these is an object: the first member is the key; where there are only two, the second one is the value.
template <class T>
inline constexpr bool kIsKeyed = false;
template <>
inline constexpr bool kIsKeyed<Parameter> = true;
template <>
inline constexpr bool kIsKeyed<Participants> = true;
template <>
inline constexpr bool kIsKeyed<FieldFate> = true;
template <>
inline constexpr bool kIsKeyed<InteractionMetrics> = true;
template <>
inline constexpr bool kIsKeyed<wire::DroppedSamples> = true;

/// The key of a member of T: its name on the bus, or a shorter one.
template <class T>
std::string_view key_of(std::string_view member)
{
    constexpr bool kIsReport = std::is_same_v<T, SwapReport> || std::is_same_v<T, EventInfo>;
    if (member == "component_id") return kIsReport ? "component" : "id";
    if (member == "type_name") return std::is_same_v<T, Type> ? "name" : "type";
    if (member == "shape_of") return "kind";
    if (member == "is_loaded") return "loaded";
    if (member == "from_type") return "from";
    if (member == "to_type") return "to";
    if (member == "ledger") return "energy";
    return member;
}

template <class T>
Json json_from(const T& value);

/// All members by their keys.
template <class T>
Json members_of(const T& value)
{
    Json out = Json::object();
    for_each_member([&](const char* name, const auto& member) { out[std::string(key_of<T>(name))] = json_from(member); }, value);
    return out;
}

/// Moves these members behind the others, in this order.
Json with_last(Json json, std::initializer_list<const char*> keys)
{
    for (const char* key : keys)
    {
        Json value = std::move(json.at(key));
        json.erase(key);
        json[key] = std::move(value);
    }
    return json;
}

// Where the JSON of a type is more than its members.
Json form_of(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }
Json form_of(const Quat& q) { return Json::array({q.w, q.x, q.y, q.z}); }

Json form_of(const wire::RecordingInfo& r) { return r.file.empty() ? Json() : with_last(members_of(r), {"bytes", "messages", "dropped"}); }

Json form_of(const ServerInfo& s)
{
    Json out = members_of(s);
    if (s.rewind_from < 0) out["rewind_from"] = nullptr;
    return out;
}

Json form_of(const Object& o)
{
    Json all = members_of(o), out;
    for (auto& [key, value] : all.items()) out[key == "mass" && is_shaft(o) ? "inertia" : key] = std::move(value);
    if (!color_of(o)) out["color"] = nullptr;
    return with_last(std::move(out), {"handle", "run", "quarantined", "parameters"});
}

Json form_of(const Shape& s)
{
    Shape head = s;
    head.vertices.clear(), head.triangles.clear();
    Json out = members_of(head);
    out["vertices"] = s.vertices.size(), out["triangles"] = triangles_of(s).size() / 3;
    return out;
}

Json form_of(const RoleInfo& r)
{
    Json out = members_of(r);
    if (r.most == kAnyNumber) out["most"] = nullptr;
    return out;
}

Json form_of(const InteractionMetrics& m) { return with_last(members_of(m), {"quarantined"}); }

Json form_of(const Reply& r)
{
    Json out = members_of(r);
    out.erase("client"), out.erase("number");
    return out;
}

template <class T>
Json form_of(const std::vector<T>& items)
{
    Json out = kIsKeyed<T> ? Json::object() : Json::array();
    for (const T& item : items)
    {
        Json json = json_from(item);
        if constexpr (!kIsKeyed<T>)
            out.push_back(std::move(json));
        else
        {
            const std::string key = json.begin().value();
            json.erase(json.begin());
            out[key] = json.size() == 1 ? json.begin().value() : json;
        }
    }
    return out;
}

template <class T>
Json json_from(const T& value)
{
    if constexpr (requires { form_of(value); })
        return form_of(value);
    else if constexpr (Described<T>)
        return members_of(value);
    else
        return value;
}

/// One entry of events or of collisions, with its place in front.
template <class Entry, class Sample>
Json placed(const Sample& sample, std::uint32_t entry)
{
    const auto& one = sample.entries._buffer[entry];
    Json out{{"run", sample.run}, {"sequence_number", sample.sequence_number + entry}, {"step", sample.step}, {"time", one.time}};
    out.update(members_of(wire::value_of<Entry>(one)));
    return out;
}

}  // namespace

Json json_of(const Vec3& v) { return form_of(v); }
Json json_of(const Quat& q) { return form_of(q); }
Json json_of(const ServerInfo& s) { return form_of(s); }
Json json_of(const Object& o) { return form_of(o); }
Json json_of(const Shape& s) { return form_of(s); }
Json json_of(const Interaction& i) { return members_of(i); }
Json json_of(const InteractionMetrics& m)
{
    Json out = members_of(m);
    out.erase("id"), out.erase("quarantined");
    return out;
}
Json json_of(const Metrics& m) { return members_of(m); }
Json json_of(const Type& t) { return members_of(t); }
Json json_of(const Reply& r) { return form_of(r); }
Json json_of(const plab_v2_Events& sample, std::uint32_t entry) { return placed<EventInfo>(sample, entry); }
Json json_of(const plab_v2_Collisions& sample, std::uint32_t entry) { return placed<wire::CollisionInfo>(sample, entry); }

std::string line_of(const Json& json) { return safe_json(json.dump(-1, ' ', false, Json::error_handler_t::replace)); }

}  // namespace plab::link
