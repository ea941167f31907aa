/// What the compiler adds to short forms.
#include <doctest/doctest.h>

#include "scene_types.h"

using namespace plab;
using namespace plab::test;
using model::ComponentNode;

namespace
{

/// Two bodies and a detection between them.
std::vector<ComponentNode> collision(const Texts& attributes, std::vector<ComponentNode> more = {})
{
    Texts all{{"between", "a b"}};
    all.insert(all.end(), attributes.begin(), attributes.end());
    std::vector<ComponentNode> out{body("a"), body("b"), component("c", "CDetection/Simple", all, 9)};
    out.insert(out.end(), more.begin(), more.end());
    return out;
}

}  // namespace

TEST_CASE("sub-components that are left out are created with stable ids")
{
    const model::SceneSpec s = compiled(scene(collision({})));
    CHECK(ids_of(s) == "a b c solver c.resolution c.response");
    CHECK(role_of(s, "c", "response") == "c.response");
    CHECK(s.find("c.response")->type == "Response/Impulse");
    CHECK(s.find("c.response")->parent == "c");
    CHECK(s.find("c.response")->generated);
    CHECK(s.find("c.response")->where.line == 9);
    CHECK(s.find("solver")->type == "Solver/Automatic");
    CHECK(s.find("solver")->parent.empty());
    CHECK(role_of(s, "a", "solver") == "solver");
}

TEST_CASE("a sub-component can be given by its type, and its fields set with a dot")
{
    const model::SceneSpec s =
        compiled(scene(collision({{"response", "Response/Impulse"}, {"response.restitution", "0.5"}, {"resolution.tolerance", "1 us"}})));
    CHECK(field_of(s, "c.response", "restitution") == "0.5");
    CHECK(field_of(s, "c.resolution", "tolerance") == "1e-06");
    const model::SceneSpec ball = compiled(scene({body("r", {{"shape", "Shape/Sphere"}, {"shape.radius", "2 cm"}})}));
    CHECK(role_of(ball, "r", "shape") == "r.shape");
    CHECK(field_of(ball, "r.shape", "radius") == "0.02");
}

TEST_CASE("a sub-component that the author wrote is used")
{
    const model::SceneSpec by_id =
        compiled(scene(collision({{"response.restitution", "0.5"}}, {component("c.response", "Response/Impulse")})));
    CHECK(role_of(by_id, "c", "response") == "c.response");
    CHECK_FALSE(by_id.find("c.response")->generated);
    CHECK(field_of(by_id, "c.response", "restitution") == "0.5");
    const model::SceneSpec by_name = compiled(scene(collision({{"response", "soft"}}, {component("soft", "Response/Impulse")})));
    CHECK(role_of(by_name, "c", "response") == "soft");
    CHECK_FALSE(by_name.find("c.response"));
    const model::SceneSpec typed =
        compiled(scene(collision({{"response", "Response/Impulse"}}, {component("c.response", "Response/Impulse")})));
    CHECK(role_of(typed, "c", "response") == "c.response");
}

TEST_CASE("sub-components that are refused")
{
    const std::string c = "scene.xml:9:1: c (CDetection/Simple): ";
    CHECK(errors_of(collision({{"response.restituton", "0.5"}})) ==
          "scene.xml:9:1: c.response (Response/Impulse): unknown attribute 'restituton', did you mean 'restitution'? "
          "(known are 'restitution' and 'limit')");
    CHECK(
        errors_of(collision({{"restitution", "0.5"}})).find(c + "unknown attribute 'restitution', did you mean 'response.restitution'?") !=
        std::string::npos);
    CHECK(errors_of(collision({{"response.restitution", "2"}})) ==
          "scene.xml:9:1: c.response (Response/Impulse): restitution must be at most 1, not 2");
    CHECK(errors_of(collision({{"response", "Resolution/Bisection"}})) ==
          c + "role response needs a component of type Response/..., but 'c.response' is Resolution/Bisection");
    CHECK(errors_of(collision({{"answer.restitution", "1"}})).find("unknown attribute 'answer.restitution'") != std::string::npos);
    CHECK(errors_of(collision({{"response", "soft"}, {"response.restitution", "1"}}, {component("soft", "Response/Impulse")})) ==
          c + "'response.restitution': 'soft' is not a part of this component: set it there");
    CHECK(
        errors_of(collision({{"response.restitution", "1"}}, {component("c.response", "Response/Impulse", {{"restitution", "0"}}, 12)})) ==
        "scene.xml:9:1: c.response (Response/Impulse): restitution is given twice, here and at scene.xml:12:1");
    CHECK(errors_of(collision({{"response", "Response/Impulse"}}, {component("c.response", "Resolution/Bisection", {}, 12)}))
              .find("response is 'Response/Impulse' here, but component 'c.response' is of type 'Resolution/Bisection'") !=
          std::string::npos);
    CHECK(errors_of({body("r", {{"shape.radius", "1"}})}) ==
          "scene.xml:5:1: r (State/RigidBody): 'shape.radius' needs a part to set: give shape the type of one");
}

TEST_CASE("the default solver is the scene's")
{
    model::Blueprint b = scene({body("r"), component("mine", "Solver/SemiImplicitEuler")});
    b.settings = {text("solver", "mine")};
    model::SceneSpec s = compiled(b);
    CHECK(role_of(s, "r", "solver") == "mine");
    CHECK_FALSE(s.find("solver"));
    b.settings = {text("solver", "Solver/SemiImplicitEuler")};
    s = compiled(b);
    CHECK(s.find("solver")->type == "Solver/SemiImplicitEuler");
    CHECK(s.find("solver")->generated);
    b.settings.clear();
    b.components.push_back(component("solver", "Solver/SemiImplicitEuler"));
    s = compiled(b);
    CHECK(s.find("solver")->type == "Solver/SemiImplicitEuler");
    CHECK_FALSE(s.find("solver")->generated);
    CHECK(role_of(compiled(scene({body("r", {{"solver", "Solver/SemiImplicitEuler"}})})), "r", "solver") == "r.solver");
    CHECK_FALSE(compiled(scene({component("s", "Shape/Sphere")})).find("solver"));
}

TEST_CASE("a nested component fills the role that it fits")
{
    ComponentNode red = body("red");
    red.children = {component("red.form", "Shape/Sphere"), component("own", "Solver/SemiImplicitEuler")};
    const model::SceneSpec s = compiled(scene({red}));
    CHECK(role_of(s, "red", "shape") == "red.form");
    CHECK(role_of(s, "red", "solver") == "own");
    CHECK(s.find("red.form")->parent == "red");

    ComponentNode sharing = body("green");
    sharing.references = {"red.form"};
    CHECK(role_of(compiled(scene({red, sharing})), "green", "shape") == "red.form");

    ComponentNode aliased = body("blue");
    aliased.children = {shares("skin", {"red.form"})};
    CHECK(role_of(compiled(scene({red, aliased})), "blue", "shape") == "red.form");
}

TEST_CASE("nested components that fit more than one place")
{
    ComponentNode two = body("two");
    two.children = {component("p", "Shape/Sphere", {}, 6), component("q", "Shape/Sphere", {}, 7)};
    CHECK(errors_of({two}) == "scene.xml:7:1: two (State/RigidBody): 'p' and 'q' both fit role shape: name one of them");
    two.attributes.push_back(text("shape", "q"));
    CHECK(role_of(compiled(scene({two})), "two", "shape") == "q");

    ComponentNode gear = component("g", "Constraint/AngularVelocity/Graph", {}, 4);
    gear.children = {component("p", "State/Shaft", {}, 5), component("q", "State/Shaft", {}, 6)};
    CHECK(errors_of({gear}).find("'p' fits the roles 'driver' and 'driven': name it in one of them") != std::string::npos);
    gear.attributes = {text("driver", "p")};
    CHECK(role_of(compiled(scene({gear})), "g", "driven") == "q");
    gear.attributes.clear();
    gear.children[0].id = "g.driven";
    CHECK(role_of(compiled(scene({gear})), "g", "driven") == "g.driven");
    CHECK(role_of(compiled(scene({gear})), "g", "driver") == "q");

    ComponentNode stray = body("stray");
    stray.references = {"lua"};
    CHECK(errors_of({stray, component("lua", "Response/Impulse")}) ==
          "scene.xml:5:1: stray (State/RigidBody): compref 'lua' fits no open role of this component");
}

TEST_CASE("in an object, the only shape is the only state's")
{
    CHECK(role_of(compiled(scene({group("ball", {body("s"), component("f", "Shape/Sphere")})})), "s", "shape") == "f");
    CHECK(role_of(compiled(scene({component("mesh", "Shape/Sphere"), group("ball", {shares("f", {"mesh"}), body("s")})})), "s", "shape") ==
          "mesh");
    CHECK(role_of(compiled(scene({group("ball", {body("s"), component("f", "Shape/Sphere"), component("g", "Shape/Sphere")})})), "s",
                  "shape") == "-");
    CHECK(role_of(compiled(scene({group("ball", {body("s"), body("t"), component("f", "Shape/Sphere")})})), "s", "shape") == "-");
    CHECK(role_of(compiled(scene(
                      {group("ball", {body("s", {{"shape", "h"}}), component("f", "Shape/Sphere")}), component("h", "Shape/Sphere")})),
                  "s", "shape") == "h");
}

TEST_CASE("the long and the short form are equivalent")
{
    ComponentNode c = component("c", "CDetection/Simple");
    c.parameters = {reference("between", {"b", "a"}), text("response", "c.response")};
    c.children = {component("c.response", "Response/Impulse"), component("c.resolution", "Resolution/Bisection", {{"tolerance", "1e-6"}})};
    c.children[0].parameters = {text("restitution", "1/2")};
    const model::SceneSpec longer = compiled(scene({body("a"), body("b"), c, component("solver", "Solver/Automatic")}));
    const model::SceneSpec shorter = compiled(scene(collision({{"response.restitution", "0.5"}, {"resolution.tolerance", "1 us"}})));
    for (const model::ComponentSpec& spec : shorter.components)
    {
        const model::ComponentSpec* other = longer.find(spec.id);
        REQUIRE(other);
        CHECK(other->type == spec.type);
        REQUIRE(other->fields.size() == spec.fields.size());
        for (std::size_t k = 0; k < spec.fields.size(); ++k) CHECK(other->fields[k].value == spec.fields[k].value);
        REQUIRE(other->roles.size() == spec.roles.size());
        for (std::size_t k = 0; k < spec.roles.size(); ++k) CHECK(other->roles[k].members == spec.roles[k].members);
    }
}
