#include "foxglove/parameters.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

using namespace plab;
using namespace plab::foxglove;

namespace
{

link::CatalogueContents tuned_scene()
{
    link::CatalogueContents out;
    out.interactions["contact.response"].parameters = {
        {"restitution", "0.5", "", "param"}, {"mode", "fast", "", "param"}, {"gap", "inf", "m", "param"}, {"work", "3", "J", "output"}};
    out.objects["red"].parameters = {{"position", "1 2 -3.5", "m", "state"}, {"fixed", "true", "", "param"}, {"name", "", "", "param"}};
    return out;
}

Json value_of(const std::string& name)
{
    const auto scene = tuned_scene();
    return parameter_json(name, find_parameter(scene, name));
}

}  // namespace

TEST_CASE("parameters have the values that their texts say")
{
    CHECK(value_of("contact.response.restitution") == Json{{"name", "contact.response.restitution"}, {"value", 0.5}, {"type", "float64"}});
    CHECK(value_of("red.position")["value"] == Json{1.0, 2.0, -3.5});
    CHECK(value_of("red.position")["type"] == "float64_array");
    CHECK(value_of("red.fixed")["value"] == true);
    CHECK(value_of("contact.response.mode")["value"] == "fast");
    CHECK(value_of("contact.response.gap")["value"] == "inf");  // JSON has no number for it
    CHECK(value_of("red.name")["value"] == "");
    for (const char* name : {"red", "", ".", "red.", ".x", "red.colour", "blue.position"}) CHECK(!value_of(name).contains("value"));
    CHECK(parameter_names(tuned_scene()) == std::vector<std::string>{"contact.response.restitution", "contact.response.mode",
                                                                     "contact.response.gap", "red.fixed", "red.name"});
}

TEST_CASE("one operation sets what belongs to one component")
{
    const auto made = set_operations({{"contact.response.restitution", "0.25"}, {"red.fixed", "false"}, {"contact.response.mode", "slow"}});
    REQUIRE(made.ok());
    REQUIRE(made->size() == 2);
    CHECK((*made)[0].target == "contact.response");
    CHECK((*made)[0].values.size() == 2);
    CHECK((*made)[1].values.at(0).name == "fixed");
    CHECK(!set_operations({}).ok());
    for (const char* name : {"red", ".x", "red."}) CHECK(!set_operations({{name, "1"}}).ok());
}

TEST_CASE("who watches parameters gets them once, and again when they change")
{
    link::CatalogueContents scene = tuned_scene();
    ParameterWatch watch;
    CHECK(watch.is_empty());
    watch.change({{"contact.response.restitution", "red.fixed"}, true});
    CHECK(watch.changes(scene).size() == 2);
    CHECK(watch.changes(scene).empty());
    scene.interactions["contact.response"].parameters[0].text = "0.75";
    scene.interactions["contact.response"].parameters[1].text = "slow";
    const Json changes = watch.changes(scene);
    REQUIRE(changes.size() == 1);
    CHECK(changes[0]["value"] == 0.75);
    watch.change({{"contact.response.restitution"}, false});
    scene.interactions["contact.response"].parameters[0].text = "0.5";
    CHECK(watch.changes(scene).empty());
    watch.change({{}, true});
    CHECK(watch.changes(scene).size() == 4);  // red.fixed is known
    watch.change({{}, false});
    CHECK(watch.is_empty());
}
