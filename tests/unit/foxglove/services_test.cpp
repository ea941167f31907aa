#include "foxglove/services.h"

#include <doctest/doctest.h>

#include <cstring>
#include <nlohmann/json.hpp>

using namespace plab;
using namespace plab::foxglove;

namespace
{

std::uint32_t id_of(const std::string& name)
{
    for (std::uint32_t id = 1; service_name(id) != nullptr; ++id)
        if (name == service_name(id)) return id;
    return 0;
}

std::string service_error(const std::string& name, const std::string& data)
{
    const auto request = request_of(id_of(name), data);
    return request ? "" : request.error().text();
}

}  // namespace

TEST_CASE("arguments of a service become one operation")
{
    const auto swap =
        request_of(id_of("swap"), R"({"component":"gears","type":"Assign","values":{"velocity_factor":-0.25,"x":"1 m"},"at":7})");
    REQUIRE(swap.ok());
    CHECK(swap->at == 7);
    CHECK(!swap->revision);
    REQUIRE(swap->operations.size() == 1);
    const link::Operation& operation = swap->operations[0];
    CHECK(operation.verb == "swap");
    CHECK(operation.target == "gears");
    CHECK(operation.argument == "Assign");
    CHECK(operation.values.at(0).text == "-0.25");
    CHECK(operation.values.at(1).text == "1 m");
    const auto push = request_of(id_of("push"), R"({"object":"red","impulse":[0,0.5,-1]})");
    REQUIRE(push.ok());
    CHECK(push->operations[0].values.at(0).name == "impulse");
    CHECK(push->operations[0].values.at(0).text == "0 0.5 -1");
    CHECK(request_of(id_of("step"), R"({"steps":10})")->operations[0].argument == "10");
    CHECK(request_of(id_of("pause"), "")->operations[0].verb == "pause");
    const auto several =
        request_of(id_of("request"), R"({"operations":[{"verb":"pause"},{"verb":"set","target":"g","values":{"a":1}}],"revision":3})");
    REQUIRE(several.ok());
    CHECK(several->operations.size() == 2);
    CHECK(several->revision == 3u);
}

TEST_CASE("wrong arguments are refused with the member's name")
{
    CHECK(service_error("swap", R"({"component":"gears"})").find("'type'") != std::string::npos);
    CHECK(service_error("pause", R"({"why":1})") == "'why' is no argument of pause");
    CHECK(service_error("set", R"({"component":"g","values":[1]})") == "'values' must be an object");
    CHECK(service_error("set", R"({"component":"g","values":{"a":{}}})").find("'values.a'") != std::string::npos);
    CHECK(service_error("step", R"({"steps":10,"at":-1})") == "'at' must be a whole number");
    CHECK(service_error("pause", "[1]") == "the arguments are no JSON object");
    CHECK(service_error("pause", "{") == "the arguments are no JSON object");
    CHECK(!service_error("request", R"({"operations":[]})").empty());
    CHECK(!service_error("request", R"({"operations":[{"target":"x"}]})").empty());
    CHECK(!service_error("request", R"({"operations":[{"verb":"pause","x":"y"}]})").empty());
    CHECK(!request_of(0, "{}").ok());
    CHECK(!request_of(1000, "{}").ok());
}

TEST_CASE("each service has schemas, which are JSON, and a name of its own")
{
    const Json said = advertise_services();
    std::set<std::string> names;
    for (const Json& service : said["services"])
    {
        names.insert(service["name"]);
        CHECK(service["request"]["encoding"] == "json");
        for (const char* half : {"request", "response"})
            CHECK(Json::parse(service[half]["schema"].get<std::string>(), nullptr, false)["type"] == "object");
    }
    CHECK(names.size() == said["services"].size());
    for (const char* verb : {"swap", "set", "push", "pause", "resume", "step", "reset", "rewind", "request"})
        CHECK(names.contains(std::string("plab/") + verb));
}
