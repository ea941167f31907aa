#include "foxglove/services.h"

#include <array>
#include <nlohmann/json.hpp>
#include <span>

#include "foxglove/value_text.h"

namespace plab::foxglove
{
namespace
{

/// Where a member of the arguments goes in an operation.
enum class Place : std::uint8_t
{
    Target,
    Argument,
    Blueprint,
    Value,   ///< the value of this name
    Values,  ///< an object: one value for each member
};
struct Argument
{
    const char* name;
    Place place;
    bool is_required;
    const char* doc;
};
struct Service
{
    const char* verb;
    const char* doc;
    std::vector<Argument> arguments;
};

constexpr const char* kSeveral = "request";

const std::vector<Service>& services()
{
    static const std::vector<Service> all{
        {"swap",
         "Exchanges a component for another one of its family.",
         {{"component", Place::Target, true, "its id; may contain * and ?"},
          {"type", Place::Argument, true, "the new type: Constraint/AngularVelocity/Graph"},
          {"values", Place::Values, false, "parameters of the new type"}}},
        {"set",
         "Sets parameters or states of a component.",
         {{"component", Place::Target, true, "its id"}, {"values", Place::Values, true, "by name"}}},
        {"push",
         "Gives an object an impulse.",
         {{"object", Place::Target, true, "its id"},
          {"impulse", Place::Value, true, "[x, y, z] in N s; of a shaft one number in N m s"},
          {"point", Place::Value, false, "[x, y, z] in m, in the world; without it the centre of mass"}}},
        {"pause", "Pauses the run.", {}},
        {"resume", "Lets the run go on.", {}},
        {"step", "Makes steps, of a paused run.", {{"steps", Place::Argument, true, "1 or more"}}},
        {"rate", "Sets the pace.", {{"rate", Place::Argument, true, "real, max, or simulated seconds for each second"}}},
        {"reset", "Begins anew.", {}},
        {"rewind", "Goes back in the run.", {{"to", Place::Argument, true, "a time of the run in s: 2.5; or how far: back 0.5"}}},
        {"snapshot", "Keeps this moment.", {{"name", Place::Target, true, "name of the snapshot"}}},
        {"restore", "Returns to a moment that was kept.", {{"name", Place::Target, true, "name of the snapshot"}}},
        {"forget", "Drops a moment that was kept.", {{"name", Place::Target, true, "name of the snapshot"}}},
        {"add",
         "Adds components.",
         {{"blueprint", Place::Blueprint, true, "XML: <component>, or <plab> with several"},
          {"file", Place::Argument, false, "a name for messages"}}},
        {"remove", "Removes a component.", {{"component", Place::Target, true, "its id"}}},
        {"load",
         "Loads another scene.",
         {{"blueprint", Place::Blueprint, true, "XML: <plab>"}, {"file", Place::Argument, false, "a name for messages"}}},
        {"dt", "Sets the step.", {{"dt", Place::Argument, true, "s: 1/240"}}},
        {"cancel", "Withdraws a request that waits.", {{"request", Place::Argument, true, "CLIENT:NUMBER"}}},
        {"shutdown", "Ends the server.", {}},
    };
    return all;
}

std::uint32_t id_of_several() { return static_cast<std::uint32_t>(services().size() + 1); }

const Service* find_service(std::uint32_t id) { return id >= 1 && id <= services().size() ? &services()[id - 1] : nullptr; }

// ---- Schemas --------------------------------------------------------------------------------------------------------

const Json kValue{{"type", {"string", "number", "boolean", "array"}}};
const Json kValues{{"type", "object"}, {"additionalProperties", kValue}};

Json with_moment(Json properties)
{
    properties["at"] = {{"type", "integer"}, {"description", "takes effect before this step; without it at once"}};
    properties["revision"] = {{"type", "integer"}, {"description", "refused unless the scene is at this revision"}};
    return properties;
}

Json object_schema(Json properties, Json required)
{
    if (properties.is_null()) properties = Json::object();
    return {{"type", "object"}, {"properties", std::move(properties)}, {"required", std::move(required)}, {"additionalProperties", false}};
}

Json schema_of(const Service& service)
{
    Json properties = Json::object(), required = Json::array();
    for (const Argument& a : service.arguments)
    {
        properties[a.name] = a.place == Place::Values ? kValues : kValue;
        properties[a.name]["description"] = a.doc;
        if (a.is_required) required.push_back(a.name);
    }
    return object_schema(with_moment(std::move(properties)), std::move(required));
}

Json schema_of_several()
{
    const Json text{{"type", "string"}};
    Json operation = object_schema({{"verb", text}, {"target", text}, {"argument", text}, {"blueprint", text}, {"values", kValues}},
                                   Json::array({"verb"}));
    return object_schema(with_moment({{"operations", {{"type", "array"}, {"minItems", 1}, {"items", std::move(operation)}}}}),
                         Json::array({"operations"}));
}

Json schema_of_reply()
{
    const Json text{{"type", "string"}}, number{{"type", "number"}};
    return {{"type", "object"},
            {"properties",
             {{"outcome", text},
              {"run", number},
              {"revision", number},
              {"step", number},
              {"time", number},
              {"pause_ns", number},
              {"waited_ns", number},
              {"trial", text},
              {"reasons", {{"type", "array"}, {"items", text}}},
              {"swaps", {{"type", "array"}, {"items", {{"type", "object"}}}}}}}};
}

Json advertised(std::uint32_t id, const std::string& verb, const Json& schema)
{
    const auto half = [&](const char* what, const Json& json) -> Json {
        return {
            {"encoding", "json"}, {"schemaName", "plab." + verb + "." + what}, {"schemaEncoding", "jsonschema"}, {"schema", json.dump()}};
    };
    return {{"id", id},
            {"name", "plab/" + verb},
            {"type", "plab." + verb},
            {"request", half("request", schema)},
            {"response", half("reply", schema_of_reply())}};
}

// ---- Calls ----------------------------------------------------------------------------------------------------------

Error wrong(const std::string& name, const std::string& what) { return reason("'" + name + "' must be " + what); }

Result<void> put_values(const std::string& name, const Json& json, link::Operation& out)
{
    if (!json.is_object()) return wrong(name, "an object");
    for (const auto& [key, value] : json.items())
    {
        auto text = value_text(value);
        if (!text) return wrong(name + "." + key, "a text, a number, true, false or a list of numbers");
        out.values.push_back({key, std::move(*text)});
    }
    return {};
}

Result<void> put_argument(const Argument& argument, const Json& json, link::Operation& out)
{
    if (argument.place == Place::Values) return put_values(argument.name, json, out);
    auto text = value_text(json);
    if (!text) return wrong(argument.name, "a text, a number or a list of numbers");
    if (argument.place == Place::Target)
        out.target = std::move(*text);
    else if (argument.place == Place::Argument)
        out.argument = std::move(*text);
    else if (argument.place == Place::Blueprint)
        out.blueprint = std::move(*text);
    else
        out.values.push_back({argument.name, std::move(*text)});
    return {};
}

/// Takes `at` and `revision` out of the arguments.
Result<void> take_moment(Json& json, link::Request& out)
{
    const auto whole = [&](const char* name) -> Result<std::optional<std::uint64_t>>
    {
        const auto at = json.find(name);
        if (at == json.end()) return std::optional<std::uint64_t>();
        if (!at->is_number_unsigned() || at->get<std::uint64_t>() > INT64_MAX) return wrong(name, "a whole number");
        const auto value = at->get<std::uint64_t>();
        json.erase(name);
        return std::optional(value);
    };
    const auto at = whole("at"), revision = whole("revision");
    if (!at) return at.errors();
    if (!revision) return revision.errors();
    if (*at) out.at = static_cast<std::int64_t>(**at);
    out.revision = *revision;
    return {};
}

/// An operation with `verb`, of the members of `json`; a member that no argument names is wrong.
Result<link::Operation> operation_of(const char* verb, std::span<const Argument> arguments, const Json& json)
{
    if (!json.is_object()) return reason("an operation must be an object");
    link::Operation out{verb};
    std::size_t used = 0;
    for (const Argument& argument : arguments)
    {
        const auto at = json.find(argument.name);
        if (at == json.end() && argument.is_required) return wrong(argument.name, std::string("given: ") + argument.doc);
        if (at == json.end()) continue;
        ++used;
        if (auto put = put_argument(argument, *at, out); !put) return put.errors();
    }
    if (used == json.size()) return out;
    for (const auto& [name, value] : json.items())
    {
        bool is_known = false;
        for (const Argument& argument : arguments) is_known = is_known || name == argument.name;
        if (!is_known) return reason("'" + name + "' is no argument of " + verb);
    }
    return out;
}

Result<void> put_several(const Json& json, link::Request& out)
{
    constexpr std::size_t kMost = 256;
    static const std::array<Argument, 4> kPlaces{{{"target", Place::Target, false, ""},
                                                  {"argument", Place::Argument, false, ""},
                                                  {"blueprint", Place::Blueprint, false, ""},
                                                  {"values", Place::Values, false, ""}}};
    const auto list = json.find("operations");
    if (json.size() != 1 || list == json.end() || !list->is_array() || list->empty() || list->size() > kMost)
        return reason("the arguments are a list 'operations' of 1 to 256, and perhaps 'at' and 'revision'");
    for (Json one : *list)
    {
        if (!one.is_object() || !one.contains("verb") || !one["verb"].is_string()) return wrong("verb", "the name of an operation");
        const std::string verb = one["verb"];
        one.erase("verb");
        auto operation = operation_of(verb.c_str(), kPlaces, one);
        if (!operation) return operation.errors();
        out.operations.push_back(operation.take());
    }
    return {};
}

}  // namespace

Json advertise_services()
{
    Json list = Json::array();
    std::uint32_t id = 0;
    for (const Service& service : services()) list.push_back(advertised(++id, service.verb, schema_of(service)));
    list.push_back(advertised(id_of_several(), kSeveral, schema_of_several()));
    return {{"op", "advertiseServices"}, {"services", std::move(list)}};
}

const char* service_name(std::uint32_t id)
{
    if (id == id_of_several()) return kSeveral;
    const Service* const service = find_service(id);
    return service == nullptr ? nullptr : service->verb;
}

Result<link::Request> request_of(std::uint32_t id, const std::string& data)
{
    const bool is_empty = data.find_first_not_of(" \t\r\n") == std::string::npos;
    Json json = is_empty ? Json::object() : Json::parse(data, nullptr, false);
    if (!json.is_object()) return reason("the arguments are no JSON object");
    link::Request out;
    if (auto taken = take_moment(json, out); !taken) return taken.errors();
    if (id == id_of_several())
    {
        if (auto put = put_several(json, out); !put) return put.errors();
        return out;
    }
    const Service* const service = find_service(id);
    if (service == nullptr) return reason("there is no service " + std::to_string(id));
    auto operation = operation_of(service->verb, service->arguments, json);
    if (!operation) return operation.errors();
    out.operations.push_back(operation.take());
    return out;
}

}  // namespace plab::foxglove
