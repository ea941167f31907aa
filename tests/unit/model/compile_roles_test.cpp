/// Participants: ids, groups, aliases, everyone, and which participants are refused.
#include <doctest/doctest.h>

#include "scene_types.h"

using namespace plab;
using namespace plab::test;
using model::ComponentNode;

namespace
{

ComponentNode gear(const Texts& attributes, std::uint32_t line = 9)
{
    return component("g", "Constraint/AngularVelocity/Graph", attributes, line);
}
ComponentNode collide(const std::string& between, std::uint32_t line = 9)
{
    return component("c", "CDetection/Simple", {{"between", between}}, line);
}

const std::string kGear = "scene.xml:9:1: g (Constraint/AngularVelocity/Graph): ";
const std::string kCollide = "scene.xml:9:1: c (CDetection/Simple): ";

}  // namespace

TEST_CASE("ids are separated by blanks, and members are in the order of ids")
{
    const model::SceneSpec s = compiled(scene({collide(" b10 b9\n b1 "), body("b1"), body("b9"), body("b10")}));
    CHECK(role_of(s, "c", "between") == "b1 b10 b9");
}

TEST_CASE("an id that holds blanks is one id")
{
    const model::SceneSpec s = compiled(scene({shaft("big wheel"), shaft("a"), gear({{"driver", "big wheel"}, {"driven", "a"}})}));
    CHECK(role_of(s, "g", "driver") == "big wheel");
}

TEST_CASE("everyone: all suitable components except the component itself")
{
    const model::SceneSpec s =
        compiled(scene({collide("*"), body("b"), shaft("s"), body("a"), component("m", "Manager/Any", {{"parts", "*"}})}));
    CHECK(role_of(s, "c", "between") == "* a b");
    CHECK(role_of(s, "m", "parts") == "* a b c c.resolution c.response s solver");
    CHECK(role_of(compiled(scene({collide("*")})), "c", "between") == "* ");
    CHECK(errors_of({shaft("a"), shaft("b"), gear({{"driver", "*"}, {"driven", "b"}})}) ==
          kGear + "role driver takes one participant, but '*' means all objects");
    CHECK(errors_of({collide("* a"), body("a")}) == kCollide + "role between: no component has the id '*'");
}

TEST_CASE("a pattern: all suitable components whose ids match, beside those that are named")
{
    const model::SceneSpec s = compiled(scene({collide("b?.* x"), body("b1.0"), body("b2.7"), body("x"), body("b10.0"), shaft("b3.0"),
                                               component("m", "Manager/Any", {{"parts", "b*0"}})}));
    CHECK(role_of(s, "c", "between") == "* b1.0 b2.7 x");
    CHECK(s.find("c")->roles.front().patterns == std::vector<std::string>{"b?.*", "x"});
    CHECK(role_of(s, "m", "parts") == "* b1.0 b10.0 b3.0");
    // What a pattern matches besides is named once, and an id that looks like a pattern is that id.
    CHECK(role_of(compiled(scene({collide("b1 b*"), body("b1"), body("b2")})), "c", "between") == "* b1 b2");
    CHECK(role_of(compiled(scene({component("m", "Manager/Any", {{"parts", "b*"}}), body("b*"), body("b2")})), "m", "parts") == "b*");
    CHECK(errors_of({collide("b1 bx*"), body("b1"), shaft("bx1")}) == kCollide + "role between needs a body, and 'bx*' matches none");
    CHECK(errors_of({shaft("a"), shaft("b"), gear({{"driver", "a*"}, {"driven", "b"}})}) ==
          kGear + "role driver takes one participant, but 'a*' is a pattern of ids");
}

TEST_CASE("two roles that act on one participant each need two")
{
    CHECK(errors_of({shaft("a"), gear({{"driver", "a"}, {"driven", "a"}})}) ==
          kGear + "roles driver and driven are both 'a': they must be two");
    // The same through another name.
    CHECK(errors_of({shaft("a"), shares("same", {"a"}), gear({{"driver", "same"}, {"driven", "a"}})}) ==
          kGear + "roles driver and driven are both 'a': they must be two");
}

TEST_CASE("a group stands for all suitable components inside it, an object for its only one")
{
    const model::SceneSpec s =
        compiled(scene({group("balls", {body("b"), group("more", {body("a"), component("s", "Shape/Sphere")})}), shares("some", {"a", "x"}),
                        body("x"), collide("balls x"), component("d", "CDetection/Simple", {{"between", "some"}})}));
    CHECK(role_of(s, "c", "between") == "a b x");
    CHECK(role_of(s, "d", "between") == "a x");
    CHECK(s.find("some")->group == std::vector<std::string>{"a", "x"});
    // A component that is twice inside one group counts once.
    const model::SceneSpec twice = compiled(scene({group("balls", {body("a"), body("b"), shares("pair", {"a", "b"})}), collide("balls")}));
    CHECK(role_of(twice, "c", "between") == "a b");
    const model::SceneSpec one = compiled(scene(
        {group("motor", {shaft("axle"), component("form", "Shape/Sphere")}), shaft("b"), gear({{"driver", "motor"}, {"driven", "b"}})}));
    CHECK(role_of(one, "g", "driver") == "axle");
    CHECK(errors_of({group("motor", {shaft("p"), shaft("q")}), shaft("b"), gear({{"driver", "motor"}, {"driven", "b"}})}) ==
          kGear + "role driver takes one participant, and 'motor' holds 2 that fit ('p' and 'q'): name one of them");
    CHECK(errors_of({group("motor", {component("form", "Shape/Sphere")}), shaft("b"), gear({{"driver", "motor"}, {"driven", "b"}})}) ==
          kGear + "role driver needs a shaft, and 'motor' holds none");
}

TEST_CASE("a compref is the component that it refers to")
{
    const model::SceneSpec s = compiled(
        scene({shaft("a"), shares("same", {"a"}), shares("again", {"same"}), shaft("b"), gear({{"driver", "again"}, {"driven", "b"}})}));
    CHECK(role_of(s, "g", "driver") == "a");
    CHECK(s.find("again")->alias_of == "a");
    CHECK(s.find("again")->type.empty());
}

TEST_CASE("participants of the wrong kind")
{
    CHECK(errors_of({body("a"), shaft("b"), gear({{"driver", "a"}, {"driven", "b"}})}) ==
          kGear + "role driver needs a shaft, but 'a' is State/RigidBody, a body");
    CHECK(errors_of({shaft("a"), component("r", "Response/Impulse"), component("x", "State/Shaft", {{"solver", "r"}}, 9)}) ==
          "scene.xml:9:1: x (State/Shaft): role solver needs a component of type Solver/..., but 'r' is "
          "Response/Impulse");
    CHECK(errors_of({component("s", "Script/Lua", {{"code", "x"}, {"target", "r"}}, 9), component("r", "Response/Impulse")}) ==
          "scene.xml:9:1: s (Script/Lua): role target needs a body or a shaft, but 'r' is Response/Impulse");
}

TEST_CASE("dangling references name the nearest ids")
{
    CHECK(errors_of({shaft("motor"), shaft("b"), gear({{"driver", "motr"}, {"driven", "b"}})}) ==
          kGear + "role driver: no component has the id 'motr', did you mean 'motor'?");
    CHECK(errors_of({shares("x", {"motr"}, 3), shaft("motor")}) ==
          "scene.xml:3:1: x: compref: no component has the id 'motr', did you mean 'motor'?");
    CHECK(errors_of({shaft("b"), gear({{"driver", "Shape/Spere"}, {"driven", "b"}})})
              .find("unknown type 'Shape/Spere', did you mean 'Shape/Sphere'?") != std::string::npos);
}

TEST_CASE("the number of participants")
{
    CHECK(errors_of({shaft("b"), gear({{"driven", "b"}})}) == kGear + "driver is missing: name a shaft");
    CHECK(errors_of({shaft("b"), gear({{"driver", ""}, {"driven", "b"}})}) ==
          kGear + "driver names no component: give ids, or leave it out");
    CHECK(errors_of({shaft("a"), shaft("b"), shaft("c"), gear({{"driver", "a b"}, {"driven", "c"}})}) ==
          kGear + "role driver takes one participant, has 2");
    CHECK(errors_of({body("a"), collide("a")}) == kCollide + "role between needs at least 2 participants, has 1");
    CHECK(errors_of({body("a"), body("b"), collide("a b a")}) == kCollide + "role between names 'a' twice");
    CHECK(errors_of({group("all", {body("a"), body("b")}), collide("all a")}) == kCollide + "role between names 'a' twice");
    CHECK(errors_of({shaft("a"), shaft("b"), gear({{"driver", "a"}, {"driver", "b"}, {"driven", "b"}})}) ==
          kGear + "driver is given twice, here and at scene.xml:9:1");
}

TEST_CASE("two components cannot drive the same one if the role is exclusive")
{
    const auto second = component("h", "Constraint/AngularVelocity/Assign", {{"driver", "a"}, {"driven", "c"}}, 12);
    CHECK(errors_of({shaft("a"), shaft("b"), shaft("c"), gear({{"driver", "b"}, {"driven", "c"}}), second}) ==
          "scene.xml:12:1: h (Constraint/AngularVelocity/Assign): 'c' is driven of g "
          "(Constraint/AngularVelocity/Graph) already: only "
          "one component can have it in this role");
    CHECK(errors_of({shaft("a"), shaft("b"), shaft("c"), gear({{"driver", "a"}, {"driven", "b"}}), second}).empty());
}

TEST_CASE("no component is its own participant, directly or indirectly")
{
    CHECK(errors_of({component("m", "Manager/Any", {{"parts", "m"}}, 3)}) ==
          "scene.xml:3:1: m (Manager/Any): role parts: a component cannot be its own participant");
    CHECK(errors_of({component("m", "Manager/Any", {{"parts", "n"}}, 3), component("n", "Manager/Any", {{"parts", "o"}}, 4),
                     component("o", "Manager/Any", {{"parts", "m"}}, 5)}) ==
          "scene.xml:3:1: m (Manager/Any): circular reference: 'm' -> 'n' -> 'o' -> 'm'");
    CHECK(errors_of({component("p", "Shape/Placed", {{"of", "q"}}, 3), component("q", "Shape/Placed", {{"of", "p"}}, 4)}) ==
          "scene.xml:3:1: p (Shape/Placed): circular reference: 'p' -> 'q' -> 'p'");
    CHECK(errors_of({shares("x", {"y"}, 3), shares("y", {"x"}, 4)}) == "scene.xml:3:1: x: circular reference: 'x' -> 'y' -> 'x'");
    CHECK(errors_of({shares("x", {"x"}, 3)}) == "scene.xml:3:1: x: circular reference: 'x' -> 'x'");
    CHECK(errors_of({group("x", {shares("y", {"x"}, 4)}, 3)}) == "scene.xml:3:1: x: circular reference: 'x' -> 'y' -> 'x'");
}

TEST_CASE("a chain of a hundred thousand references is followed without recursion")
{
    std::vector<ComponentNode> chain{component("s0", "Shape/Sphere")};
    for (int i = 1; i < 99'999; ++i) chain.push_back(shares("s" + std::to_string(i), {"s" + std::to_string(i - 1)}));
    chain.push_back(component("b", "State/RigidBody", {{"mass", "1"}, {"shape", "s300"}}));
    FixedTypes types;
    const auto result = model::compile(scene(std::move(chain)), types);
    REQUIRE(result.ok());
    CHECK(role_of(*result, "b", "shape") == "s0");
}

TEST_CASE("an unknown type is reported once, not where it is referred to")
{
    CHECK(errors_of({component("a", "State/Shft", {}, 3), shaft("b"), gear({{"driver", "a"}, {"driven", "b"}})}) ==
          "scene.xml:3:1: a (State/Shft): unknown type 'State/Shft', did you mean 'State/Shaft'?");
}

TEST_CASE("participants that exist already in the scene")
{
    const model::SceneSpec s = compiled(scene({group("motor", {shaft("axle")}), shares("same", {"motor"}), shaft("b")}));
    const auto driven_by = [](const std::string& driver) { return scene({shaft("c"), gear({{"driver", driver}, {"driven", "c"}})}); };
    CHECK(role_of(compiled(driven_by("axle"), &s), "g", "driver") == "axle");
    CHECK(role_of(compiled(driven_by("same"), &s), "g", "driver") == "axle");
    CHECK(errors_of(driven_by("axl"), &s).find("role driver: no component has the id 'axl', did you mean 'axle'?") != std::string::npos);
    CHECK(errors_of(driven_by("solver"), &s).find("role driver needs a shaft, but 'solver' is Solver/Automatic") != std::string::npos);
}

TEST_CASE("a fragment sees the scene that it joins")
{
    const model::SceneSpec s = compiled(scene({shaft("a"), shaft("b"), gear({{"driver", "a"}, {"driven", "b"}})}));
    model::Blueprint fragment = scene({shaft("c"), component("h", "Constraint/AngularVelocity/Graph", {{"driver", "b"}, {"driven", "c"}})});
    const model::SceneSpec added = compiled(fragment, &s);
    CHECK(ids_of(added) == "c h");
    CHECK(role_of(added, "h", "driver") == "b");
    CHECK(role_of(added, "c", "solver") == "solver");
    CHECK(errors_of(scene({component("a", "Shape/Sphere", {}, 2)}), &s) ==
          "scene.xml:2:1: a (Shape/Sphere): id 'a' is already in the scene");
    CHECK(errors_of(scene({component("h", "Constraint/AngularVelocity/Assign", {{"driver", "a"}, {"driven", "b"}}, 2)}), &s)
              .find("'b' is driven of g") != std::string::npos);
    fragment.settings = {text("dt", "1/60", 2)};
    CHECK(errors_of(fragment, &s) == "scene.xml:2:1: scene: dt belongs to the scene, not to a part that is added");
}
