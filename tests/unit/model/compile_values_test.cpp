/// Settings, ids, fields.
#include <doctest/doctest.h>

#include "scene_types.h"

using namespace plab;
using namespace plab::test;
using model::Blueprint;

TEST_CASE("settings of a scene")
{
    Blueprint b = scene({});
    b.settings = {text("dt", "1/60"), text("seed", "18446744073709551615"), text("title", "two balls"),
                  text("solver", "Solver/SemiImplicitEuler")};
    b.cameras = {component("front", "", {{"position", "0 -5 1"}, {"look_at", "0 0 1"}, {"field_of_view", "40 deg"}})};
    const model::SceneSettings s = compiled(b).settings;
    CHECK(s.dt.denominator == 60);
    CHECK(s.seed == 18446744073709551615u);
    CHECK(s.title == "two balls");
    CHECK(s.solver == "solver");
    CHECK(s.solver_type == "Solver/SemiImplicitEuler");
    REQUIRE(s.cameras.size() == 1);
    CHECK(s.cameras[0].name == "front");
    CHECK(s.cameras[0].position == Vec3{0, -5, 1});
    CHECK(s.cameras[0].field_of_view == doctest::Approx(0.69813170079773179).epsilon(1e-15));
}

TEST_CASE("settings that are refused")
{
    const auto why = [](const char* name, const char* value)
    {
        Blueprint b = scene({component("ball", "Shape/Sphere")});
        b.settings = {text(name, value, 2)};
        return errors_of(b);
    };
    CHECK(why("dt", "0") == "scene.xml:2:1: scene: dt must be positive, not 0");
    CHECK(why("seed", "-1") == "scene.xml:2:1: scene: seed: '-1' is not a whole number, 0 or greater");
    CHECK(why("sed", "1") ==
          "scene.xml:2:1: scene: unknown setting 'sed', did you mean 'seed'? (settings are 'dt', 'seed', 'solver' and "
          "'title')");
    CHECK(why("solver", "bal") == "scene.xml:2:1: scene: solver: no component has the id 'bal', did you mean 'ball'?");
    CHECK(why("solver", "ball") == "scene.xml:2:1: scene: solver 'ball' is not a component of type Solver/...");
    CHECK(why("solver", "Shape/Sphere") == "scene.xml:2:1: scene: solver must be of type Solver/..., not 'Shape/Sphere'");
    CHECK(why("solver", "Solver/RungeKuta4") ==
          "scene.xml:2:1: scene: solver: unknown type 'Solver/RungeKuta4', did you mean 'Solver/RungeKutta4'?");
    CHECK(why("solver", " ") == "scene.xml:2:1: scene: solver is empty: give the id or the type of a solver");
}

TEST_CASE("cameras that see nothing")
{
    const auto why = [](const Texts& attributes)
    {
        Blueprint b = scene({});
        b.cameras = {component("c", "", attributes, 3)};
        return errors_of(b);
    };
    CHECK(why({{"position", "1 1 1"}, {"look_at", "1 1 1"}}).find("must not look at its own position") != std::string::npos);
    CHECK(why({{"position", "0 0 5"}}) == "scene.xml:3:1: camera 'c': must not look along its up direction");
    CHECK(why({{"up", "0 0 0"}}) == "scene.xml:3:1: camera 'c': up must not be zero: it is a direction");
    CHECK(why({{"field_of_view", "200 deg"}}).find("field_of_view must be at most") != std::string::npos);
    CHECK(why({{"fov", "1"}}) == "scene.xml:3:1: camera 'c': unknown attribute 'fov'");
}

TEST_CASE("fields are read with units and are in the order of their declaration")
{
    const model::SceneSpec s = compiled(scene({component("red", "State/RigidBody", {{"position", "0 0 30 cm"}, {"mass", "250 g"}})}));
    CHECK(field_of(s, "red", "mass") == "0.25");
    CHECK(field_of(s, "red", "position") == "0 0 0.3");
    CHECK(field_of(s, "red", "orientation") == "-");
    CHECK(s.find("red")->fields.front().name == "mass");
}

TEST_CASE("params and embedded values are fields as well")
{
    model::ComponentNode mesh = component("mesh", "Shape/Mesh");
    mesh.values = {{"vertices", Value(Reals{0, 0, 0}), at(2)}, {"triangles", Value(Integers{0, 0, 0}), at(3)}};
    model::ComponentNode script = component("s", "Script/Lua");
    script.parameters = {text("code", "x = 1"), text("state", "")};
    script.parameters[1].entries = {{"count", 1.0}};
    const model::SceneSpec s = compiled(scene({mesh, script}));
    CHECK(s.find("mesh")->type == "Shape/Mesh");
    mesh.type.clear();
    CHECK(errors_of({mesh}).find("scene.xml:2:1: mesh: a component without type has no 'vertices': give it a type") == 0);
    CHECK(field_of(s, "mesh", "vertices") == "0 0 0");
    CHECK(field_of(s, "s", "state") == "count=1");
}

TEST_CASE("fields that are refused")
{
    const auto why = [](const Texts& attributes, const char* type = "State/RigidBody")
    { return errors_of({component("b", type, attributes, 4)}); };
    const std::string b = "scene.xml:4:1: b (State/RigidBody): ";
    CHECK(why({{"mass", "-1"}}) == b + "mass must be positive, not -1");
    CHECK(why({{"mass", "1 m"}}) == b + "mass must be in kg (or g, mg, t), not in 'm'");
    CHECK(why({}) == b + "mass is missing: mass of the body");
    CHECK(why({{"mass", "1"}, {"postion", "0 0 0"}}) ==
          b + "unknown attribute 'postion', did you mean 'position'? (known are 'mass', 'position', 'orientation', "
              "'linear_velocity', "
              "'shape' and 'solver')");
    CHECK(why({{"mass", "1"}, {"energy", "3"}}) == b + "energy is an output of State/RigidBody and cannot be set");
    CHECK(why({{"mass", "1"}, {"mass", "2"}}) == b + "mass is given twice, here and at scene.xml:4:1");
    CHECK(why({{"radius", "1"}}, "") == "scene.xml:4:1: b: a component without type has no 'radius': give it a type, or leave it out");
    CHECK(why({{"restitution", "1.5"}}, "Response/Impulse") ==
          "scene.xml:4:1: b (Response/Impulse): restitution must be at most 1, not 1.5");
    CHECK(why({}, "State/RigidBdy") == "scene.xml:4:1: b (State/RigidBdy): unknown type 'State/RigidBdy', did you mean 'State/RigidBody'?");

    model::ComponentNode referring = component("b", "State/RigidBody", {}, 4);
    referring.parameters = {reference("mass", {"b"}, 5)};
    CHECK(errors_of({referring}) == "scene.xml:5:1: b (State/RigidBody): mass takes a value, not a reference");
    referring.parameters = {text("mass", "", 5)};
    referring.parameters[0].entries = {{"a", 1.0}};
    CHECK(errors_of({referring}) == "scene.xml:5:1: b (State/RigidBody): mass takes a value, not entries");
    model::ComponentNode mesh = component("m", "Shape/Mesh", {{"triangles", "0 1 2"}}, 4);
    mesh.values = {{"vertices", Value(1.0), at(5)}, {"normals", Value(Reals{}), at(6)}};
    CHECK(errors_of({mesh}) ==
          "scene.xml:5:1: m (Shape/Mesh): vertices must be numbers, not a number\n"
          "scene.xml:6:1: m (Shape/Mesh): embedded XML gives 'normals', which Shape/Mesh does not have");
}

TEST_CASE("ids")
{
    const auto why = [](const std::string& id) { return errors_of({component(id, "Shape/Sphere", {}, 2)}); };
    CHECK(why("any string: even <this> one").empty());
    CHECK(why("") == "scene.xml:2:1: component (Shape/Sphere): needs an id");
    CHECK(why("  ") == "scene.xml:2:1: component (Shape/Sphere): needs an id");
    CHECK(why("a\nb") == "scene.xml:2:1: a?b (Shape/Sphere): has an id with a control character");
    CHECK(why("*").find("has the id '*', which is reserved for all objects") != std::string::npos);
    CHECK(why(std::string(200, 'x')).empty());
    CHECK(why(std::string(201, 'x')).find("has an id of 201 characters; at most 200 are allowed") != std::string::npos);
    CHECK(errors_of({component("a", "Shape/Sphere", {}, 2), component("a", "Shape/Sphere", {}, 3)}) ==
          "scene.xml:3:1: a (Shape/Sphere): id 'a' is already used at scene.xml:2:1");
}

TEST_CASE("all errors are reported at once, in the order of the file, and those beyond the limit are counted")
{
    CHECK(errors_of(
              {component("b", "Shape/Sphere", {{"radius", "x"}}, 9), component("a", "Shape/Sphere", {{"radius", "0"}, {"r", "1"}}, 4)}) ==
          "scene.xml:4:1: a (Shape/Sphere): radius must be positive, not 0\n"
          "scene.xml:4:1: a (Shape/Sphere): unknown attribute 'r' (known are 'radius' and 'position')\n"
          "scene.xml:9:1: b (Shape/Sphere): radius must be a number, not 'x'");
    FixedTypes types;
    Blueprint many = scene({});
    for (std::uint32_t i = 0; i < 30; ++i)
        many.components.push_back(component("s" + std::to_string(i), "Shape/Sphere", {{"radius", "0"}}, i + 1));
    model::CompileLimits limits;
    limits.errors = 10;
    const auto result = model::compile(many, types, nullptr, limits);
    REQUIRE_FALSE(result.ok());
    CHECK(result.errors().size() == 11);
    CHECK(result.errors().back().text() == "scene.xml: ... and 20 more");
}

TEST_CASE("the number of components is limited")
{
    FixedTypes types;
    Blueprint b = scene({component("a", "Shape/Sphere"), component("b", "Shape/Sphere"), component("c", "Shape/Sphere")});
    model::CompileLimits limits;
    limits.components = 2;
    b.components[2].where = at(7, 3);
    const auto refused = model::compile(b, types, nullptr, limits);
    REQUIRE(refused.errors().size() == 1);
    CHECK(refused.error().text() == "scene.xml:7:3: c: is one component too many: a scene has at most 2");
    limits.raised_by = "--max-components N";
    CHECK(model::compile(b, types, nullptr, limits).error().reason ==
          "is one component too many: a scene has at most 2 (--max-components N raises that)");
    limits.components = 3;
    CHECK(model::compile(b, types, nullptr, limits).ok());
}

TEST_CASE("types may be written by their last words if only one type ends with them")
{
    const model::SceneSpec s = compiled(scene({component("form", "Sphere"), component("a", "RigidBody", {{"mass", "1"}, {"shape", "form"}}),
                                               component("b", "State/RigidBody", {{"mass", "1"}, {"solver", "RungeKutta4"}})}));
    CHECK(s.find("form")->type == "Shape/Sphere");
    CHECK(s.find("a")->type == "State/RigidBody");
    CHECK(s.find("b.solver")->type == "Solver/RungeKutta4");
    Blueprint b = scene({component("a", "State/RigidBody", {{"mass", "1"}})});
    b.settings = {text("solver", "RungeKutta4")};
    CHECK(compiled(b).settings.solver_type == "Solver/RungeKutta4");
}

TEST_CASE("for a short name with which several types end, the message lists them")
{
    const std::vector<std::string> names{"Constraint/AngularVelocity/Impulse", "Resolution/None", "Response/Impulse", "Response/None"};
    CHECK(*model::full_type_name("None", names, "Response/") == "Response/None");
    CHECK(*model::full_type_name("AngularVelocity/Impulse", names, "") == "Constraint/AngularVelocity/Impulse");
    CHECK(*model::full_type_name("Other", names, "") == "Other");
    CHECK(model::full_type_name("None", names, "").error().reason ==
          "type 'None' can be 'Resolution/None' or 'Response/None': give the whole name");
}
