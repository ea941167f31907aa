#include "idl/json/json.h"

#include <initializer_list>
#include <nlohmann/json.hpp>

#include "idl/values/scene.h"

namespace plab::wire
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
inline constexpr bool kIsKeyed<DroppedSamples> = true;

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

Json form_of(const RecordingInfo& r) { return r.file.empty() ? Json() : with_last(members_of(r), {"bytes", "messages", "dropped"}); }

Json form_of(const Server& s)
{
    Json out = members_of(s);
    if (s.rewind_from < 0) out["rewind_from"] = nullptr;
    return out;
}

Json form_of(const SceneObject& o)
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

}  // namespace

Json json_of(const Vec3& v) { return form_of(v); }
Json json_of(const Quat& q) { return form_of(q); }
Json json_of(const Server& s) { return form_of(s); }
Json json_of(const SceneObject& o) { return form_of(o); }
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
Json json_of(const SwapReport& s) { return members_of(s); }
Json json_of(const EventInfo& e) { return members_of(e); }
Json json_of(const CollisionInfo& c) { return members_of(c); }
Json json_of(const ContactForces& c) { return members_of(c); }

std::string line_of(const Json& json)
{
    const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    // U+007F and U+0080 to U+009F, which nlohmann leaves as they are, and which some terminals obey.
    const auto is_control = [&](std::size_t i)
    {
        const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
        return byte(i) == 0x7F || (byte(i) == 0xC2 && i + 1 < text.size() && byte(i + 1) < 0xA0);
    };
    std::string out;
    std::size_t done = 0;
    for (std::size_t i = 0; i < text.size(); ++i)
    {
        if (!is_control(i)) continue;
        const std::size_t length = text[i] == 0x7F ? 1 : 2;
        const auto code = static_cast<unsigned char>(text[i + length - 1]);
        out.append(text, done, i - done).append("\\u00").append({"0123456789abcdef"[code >> 4], "0123456789abcdef"[code & 15]});
        i += length - 1;
        done = i + 1;
    }
    return done == 0 ? text : out.append(text, done);
}

}  // namespace plab::wire
