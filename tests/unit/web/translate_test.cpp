#include "web/translate.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

using namespace plab;
using namespace plab::web;

namespace
{

std::string error_of(const std::string& text)
{
    const auto said = parse_said(text);
    return said ? "" : said.error().text();
}

link::CatalogueContents made_scene()
{
    link::CatalogueContents out;
    out.server.emplace();
    out.scene.emplace();
    link::Object ball;
    ball.component_id = "ball", ball.type_name = "State/RigidBody", ball.handle = 4, ball.shape_of = "body", ball.shapes = {"hull"};
    ball.parameters = {{"mass", "1", "kg", "param"}};
    out.objects["ball"] = ball;
    link::Shape hull;
    hull.component_id = "hull", hull.form = "mesh", hull.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, hull.triangles = {0, 1, 2, 0, 1, 9};
    out.shapes["hull"] = hull;
    link::Interaction hinge;
    hinge.component_id = "hinge", hinge.type_name = "Constraint/Hinge", hinge.roles = {{"a", {}}, {"b", {"ball"}}};
    hinge.parameters = {{"point_b", "0 0 1", "m", "state"}, {"angle", "0.5", "rad", "state"}};
    out.interactions["hinge"] = hinge;
    return out;
}

}  // namespace

TEST_CASE("what a page asks becomes a request")
{
    const auto said = parse_said(
        R"({"type":"request","id":7,"at":120,"operations":[{"verb":"swap","target":"gears","argument":"T"},{"verb":"set","target":"g","values":{"a":"1 m"}}]})");
    REQUIRE(said.ok());
    const Ask& ask = std::get<Ask>(*said);
    CHECK(ask.id == 7);
    CHECK(ask.request.at == 120);
    REQUIRE(ask.request.operations.size() == 2);
    CHECK(ask.request.operations[0].target == "gears");
    CHECK(ask.request.operations[1].values[0].text == "1 m");
    CHECK(std::get<Grab>(*parse_said(R"({"type":"grab","id":1,"body":"red","position":[1,2,3],"force":5})")).position.z == 3);
    CHECK(std::get<Watch>(*parse_said(R"({"type":"watch","components":["a","b","a"]})")).components.size() == 2);
    CHECK(std::holds_alternative<Release>(*parse_said(R"({"type":"release"})")));
}

TEST_CASE("what cannot be understood is refused with a reason, and nothing of it is done")
{
    CHECK(error_of("") == "the message is no JSON object");
    CHECK(error_of("[]") == "the message is no JSON object");
    CHECK(error_of("{\"type\":") == "the message is no JSON object");
    CHECK(error_of(std::string(100000, '[')) == "the message is no JSON object");
    CHECK(error_of("{}") == "'type' must be request, watch, contacts, grab, move, release, preview or job");
    CHECK(error_of(R"({"type":"request","id":1})") == "'operations' must be a list of at least one");
    CHECK(error_of(R"({"type":"request","id":-1,"operations":[{"verb":"pause"}]})") == "'id' must be a whole number");
    CHECK(error_of(R"({"type":"request","id":1,"operations":["pause"]})") == "an operation must be an object");
    CHECK(error_of(R"({"type":"request","id":1,"operations":[{"target":"x"}]})") == "'verb' must be the name of an operation");
    CHECK(error_of(R"({"type":"request","id":1,"operations":[{"verb":"set","values":{"a":1}}]})") == "the value of 'a' must be a text");
    CHECK(error_of(R"({"type":"move","position":[1,2]})") == "'position' must be three numbers");
    CHECK(error_of(R"({"type":"move","position":[1,2,1e999]})") != "");
    CHECK(error_of(R"({"type":"grab","body":"","position":[1,2,3]})") == "'body' must be the id of a body");
    CHECK(error_of(R"({"type":"grab","body":"x","position":[1,2,3],"force":0})") == "'force' must be more than zero");
    CHECK(error_of(R"({"type":"preview","component":"--help","with":"T"})") == "'component' must be the id of a component");
    CHECK(error_of(R"({"type":"preview","component":"gears","with":"-x"})") == "'with' must be the name of a type");
    CHECK(error_of(R"({"type":"preview","component":"gears","with":"T","seconds":1e9})") == "'seconds' must be more than 0 and at most 60");
    CHECK(error_of(R"({"type":"job","id":1})") == "'verb' must be what is to be done");
    CHECK(error_of(R"({"type":"job","id":1,"verb":"seek","value":"x"})") == "'value' must be a number");
    CHECK(error_of(R"({"type":"job","id":1,"verb":"play","name":")" + std::string(201, 'x') + "\"}") ==
          "'name' must be at most 200 bytes long");
    std::string many = R"({"type":"watch","components":[)";
    for (std::size_t i = 0; i <= kMostWatched; ++i) many += (i > 0 ? "," : "") + std::string("\"x\"");
    CHECK(error_of(many + "]}") == "'components' must be a list of at most 16");
    CHECK(error_of(R"({"type":")" + std::string(kMostText, 'x') + "\"}").starts_with("the message is longer than"));
}

TEST_CASE("the scene has what is drawn; parameters go one component at a time")
{
    const link::CatalogueContents now = made_scene();
    const Json scene = scene_message(now);
    CHECK(scene["objects"][0]["id"] == "ball");
    CHECK_FALSE(scene["objects"][0].contains("parameters"));
    CHECK(scene["shapes"][0]["vertices"].size() == 9);
    CHECK(scene["shapes"][0]["triangles"] == Json::array({0, 1, 2}));  // that of a vertex that does not exist is left out
    CHECK(scene["interactions"][0]["roles"]["b"][0] == "ball");
    CHECK(scene["interactions"][0]["joint"] == Json{{"point_b", "0 0 1"}});
    CHECK(detail_message(now, "ball")["parameters"][0]["unit"] == "kg");
    CHECK(detail_message(now, "nobody")["parameters"].is_null());
}

TEST_CASE("changes name what is new, other and gone, and nothing else")
{
    const link::CatalogueContents before = made_scene();
    link::CatalogueContents now = before;
    CHECK_FALSE(changes_message(before, now));
    now.interactions["hinge"].parameters[1].text = "0.7";  // evolves: not drawn from here
    CHECK_FALSE(changes_message(before, now));
    now.interactions["hinge"].type_name = "Constraint/Ball";
    now.objects["new"] = before.objects.at("ball");
    now.objects["new"].component_id = "new";
    now.objects.erase("ball");
    const auto changes = changes_message(before, now);
    REQUIRE(changes);
    CHECK((*changes)["interactions"][0]["type"] == "Constraint/Ball");
    CHECK((*changes)["objects"].size() == 1);
    CHECK((*changes)["gone"]["objects"] == Json::array({"ball"}));
    CHECK_FALSE(changes->contains("shapes"));
}
