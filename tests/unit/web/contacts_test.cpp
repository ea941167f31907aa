#include "web/contacts.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

using namespace plab;
using namespace plab::web;

namespace
{

wire::ContactForces many(std::size_t pairs)
{
    wire::ContactForces out;
    out.run = 2, out.time = 1.5, out.left_out = 3;
    for (std::size_t i = 0; i < pairs; ++i)
    {
        wire::ContactPoint point{{0.1, 0.2, 1.0 / 3}, {0, 0, 1}, -1e-7, static_cast<double>(i), {0.5, 0, 0}, i == 1};
        out.entries.push_back({"contact", "a" + std::to_string(i), "ground", i == 2, {point}});
    }
    return out;
}

}  // namespace

TEST_CASE("contacts for pages have pairs and rows of short numbers")
{
    const Json json = contacts_message(many(3), {});
    CHECK(json["type"] == "contacts");
    CHECK(json["left_out"] == 3);
    REQUIRE(json["pairs"].size() == 3);
    CHECK(json["pairs"][2] == Json({"a2", "ground", true}));
    REQUIRE(json["points"].size() == 3);
    CHECK(json["points"][1].dump() == "[1,0.1,0.2,0.33333,0.0,0.0,1.0,0.5,0.0,0.0,1.0,-1e-07,1]");
}

TEST_CASE("of many points those that press most are sent, and all of what is watched")
{
    const Json json = contacts_message(many(kMostContactPoints + 100), {"a5"});
    CHECK(json["points"].size() == kMostContactPoints);
    CHECK(json["left_out"] == 103);
    CHECK(json["pairs"][0][0] == "a5");
    CHECK(json["pairs"][1][0] == "a101");
    // Each row names its pair.
    for (const Json& row : json["points"]) CHECK(row[0].get<std::size_t>() < json["pairs"].size());
}
