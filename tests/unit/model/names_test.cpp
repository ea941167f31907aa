/// Similar names and setter names.
#include <doctest/doctest.h>

#include "model/names.h"

using namespace plab::model;

TEST_CASE("the most similar names come first, dissimilar ones are left out")
{
    const std::vector<std::string> known{"mass", "massive", "position", "orientation", "linear_velocity", "Mass"};
    CHECK(nearest_names("mas", known) == std::vector<std::string>{"Mass", "mass"});
    CHECK(nearest_names("postion", known) == std::vector<std::string>{"position"});
    CHECK(nearest_names("amss", known, 1) == std::vector<std::string>{"Mass"});
    CHECK(nearest_names("colour", known).empty());
    CHECK(nearest_names("", known).empty());
    CHECK(nearest_names(std::string(1'000'000, 'a'), known).empty());
    CHECK(did_you_mean("positon", known) == ", did you mean 'position'?");
    CHECK(did_you_mean("zzz", known).empty());
}

TEST_CASE("type names are found by their last part")
{
    const std::vector<std::string> known{"Constraint/AngularVelocity/Graph", "Constraint/AngularVelocity/Assign", "Shape/Sphere"};
    CHECK(nearest_names("Graph", known) == std::vector<std::string>{"Constraint/AngularVelocity/Graph"});
    CHECK(nearest_names("Constraint/AngularVelocty/Graph", known).front() == "Constraint/AngularVelocity/Graph");
    CHECK(nearest_names("shape/sphere", known) == std::vector<std::string>{"Shape/Sphere"});
    CHECK(nearest_names("Shapes/Sphere", known) == std::vector<std::string>{"Shape/Sphere"});
}

TEST_CASE("a last part that is a piece of another one's is a suggestion, after those that are nearer")
{
    const std::vector<std::string> known{"Shape/Bowl", "Shape/ConvexHull", "Constraint/TorsionSpring", "Constraint/SpringDamper"};
    CHECK(nearest_names("Shape/Hull", known).front() == "Shape/ConvexHull");
    CHECK(nearest_names("Constraint/spring", known) == std::vector<std::string>{"Constraint/SpringDamper", "Constraint/TorsionSpring"});
    CHECK(nearest_names("Shape/Convex", known) == std::vector<std::string>{"Shape/ConvexHull"});
}

TEST_CASE("setter names")
{
    CHECK(field_name_of_setter("SetVelocityFactor") == "velocity_factor");
    CHECK(field_name_of_setter("VelocityFactor") == "velocity_factor");
    CHECK(field_name_of_setter("velocity_factor") == "velocity_factor");
    CHECK(field_name_of_setter("SetCode") == "code");
    CHECK(field_name_of_setter("Settle") == "settle");
    CHECK(field_name_of_setter("Set") == "set");
    CHECK(field_name_of_setter("SetURLName") == "url_name");
    CHECK(setter_of_field_name("velocity_factor") == "SetVelocityFactor");
    CHECK(setter_of_field_name("axis_2") == "SetAxis2");
    for (const char* name : {"mass", "driver_teeth", "field_of_view"}) CHECK(field_name_of_setter(setter_of_field_name(name)) == name);
}
