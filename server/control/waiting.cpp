#include "control/waiting.h"

#include <nlohmann/json.hpp>

namespace plab::control
{
namespace
{

using nlohmann::json;

json operation_json(const wire::Operation& op)
{
    json values = json::array();
    for (const auto& [name, text] : op.values) values.push_back({name, text});
    return {{"verb", op.verb}, {"target", op.target}, {"argument", op.argument}, {"blueprint", op.blueprint}, {"values", values}};
}

wire::Operation operation_of(const json& from)
{
    wire::Operation op{from.at("verb"), from.at("target"), from.at("argument"), from.at("blueprint"), {}};
    for (const json& value : from.at("values")) op.values.push_back({value.at(0), value.at(1)});
    return op;
}

}  // namespace

std::string text_of(const wire::Request& request)
{
    json operations = json::array();
    for (const wire::Operation& op : request.operations) operations.push_back(operation_json(op));
    const json out{{"at", request.at}, {"revision", request.revision}, {"operations", operations}};
    return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

Result<wire::Request> read_request(const std::string& text)
{
    try
    {
        const json from = json::parse(text);
        wire::Request out;
        out.at = from.at("at"), out.revision = from.at("revision");
        for (const json& op : from.at("operations")) out.operations.push_back(operation_of(op));
        return out;
    }
    catch (const json::exception& e)
    {
        return reason(std::string("a waiting request cannot be read: ") + e.what());
    }
}

}  // namespace plab::control
