/// Rows, grids and seeded fillings.
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>

#include "scene_types.h"

using namespace plab;
using namespace plab::test;
using model::ComponentNode;

namespace
{

model::Blueprint repeated(const Texts& attributes, std::vector<ComponentNode> components, std::vector<ComponentNode> others = {})
{
    model::Blueprint b = scene(std::move(others));
    b.repeats = {repeat(attributes, std::move(components), 3)};
    return b;
}

std::string why(const Texts& attributes) { return errors_of(repeated(attributes, {body("b")})); }

}  // namespace

TEST_CASE("a row extends along its step, a grid has an axis for each count")
{
    const model::SceneSpec row =
        compiled(repeated({{"count", "3"}, {"step", "10 0 5 cm"}, {"origin", "0 0 1"}}, {body("b", {{"position", "1 0 0"}})}));
    CHECK(ids_of(row) == "b.0 b.1 b.2 solver");
    CHECK(field_of(row, "b.0", "position") == "1 0 1");
    CHECK(field_of(row, "b.2", "position") == "1.2 0 1.1");
    const model::SceneSpec grid = compiled(repeated({{"count", "2 2"}, {"step", "1 10 0"}}, {body("b")}));
    CHECK(ids_of(grid) == "b.0.0 b.0.1 b.1.0 b.1.1 solver");
    CHECK(field_of(grid, "b.0.0", "position") == "-");
    CHECK(field_of(grid, "b.1.0", "position") == "1 0 0");
    CHECK(field_of(grid, "b.0.1", "position") == "0 10 0");
    const model::SceneSpec block = compiled(repeated({{"count", "1 2 3"}, {"step", "1 1 1"}}, {body("b")}));
    CHECK(field_of(block, "b.0.1.2", "position") == "0 1 2");
}

TEST_CASE("references stay within the cell, and shapes stay with their bodies")
{
    ComponentNode ball = body("ball", {{"shape", "ball.form"}});
    ball.children = {component("ball.form", "Shape/Sphere", {{"position", "0 0 1"}})};
    const model::SceneSpec s = compiled(repeated({{"count", "2"}, {"step", "1 0 0"}, {"id", "balls"}},
                                                 {ball, component("c", "CDetection/Simple", {{"between", "ball outside"}})},
                                                 {body("outside"), component("all", "CDetection/Simple", {{"between", "balls"}})}));
    CHECK(role_of(s, "ball.1", "shape") == "ball.form.1");
    CHECK(field_of(s, "ball.form.1", "position") == "0 0 1");
    CHECK(role_of(s, "c.1", "between") == "ball.1 outside");
    CHECK(role_of(s, "c.1", "response") == "c.1.response");
    CHECK(role_of(s, "all", "between") == "ball.0 ball.1");
    CHECK(s.find("ball.1")->parent == "balls");
    CHECK(s.find("balls")->type.empty());
}

TEST_CASE("sub-components that are named after their role are used in each cell")
{
    const model::SceneSpec s =
        compiled(repeated({{"count", "2"}}, {body("r", {{"shape.radius", "2"}}), component("r.shape", "Shape/Sphere")}));
    CHECK(role_of(s, "r.1", "shape") == "r.shape.1");
    CHECK(field_of(s, "r.shape.1", "radius") == "2");
    CHECK(ids_of(s) == "r.0 r.shape.0 r.1 r.shape.1 solver");
}

TEST_CASE("commands and objects are repeated as well")
{
    model::CommandNode set = command("g", "Constraint/AngularVelocity");
    set.id = "set";
    set.parameters = {reference("SetDriver", {"a"}), reference("SetDriven", {"b"})};
    ComponentNode object =
        group("pair", {component("a", "State/Shaft"), component("b", "State/Shaft"), component("g", "Constraint/AngularVelocity/Graph")});
    object.commands = {set};
    const model::SceneSpec s = compiled(repeated({{"count", "2"}}, {object}));
    CHECK(role_of(s, "g.0", "driver") == "a.0");
    CHECK(role_of(s, "g.1", "driven") == "b.1");
    CHECK(s.find("a.1")->parent == "pair.1");
}

TEST_CASE("the copies of a repeat are at its position in the document")
{
    model::Blueprint b = repeated({{"count", "2"}}, {component("r", "Shape/Sphere")},
                                  {component("before", "Shape/Sphere", {}, 1), component("after", "Shape/Sphere", {}, 9)});
    CHECK(ids_of(compiled(b)) == "before r.0 r.1 after");
}

TEST_CASE("jitter is bounded, differs by cell, and follows from the seed")
{
    const auto positions = [](const char* seed)
    {
        model::Blueprint b = repeated({{"count", "200"}, {"jitter", "1 2 0"}},
                                      {group("o", {body("b"), component("s", "State/RigidBody", {{"mass", "1"}})})});
        b.settings = {text("seed", seed)};
        std::vector<Vec3> out;
        const model::SceneSpec s = compiled(b);
        for (const model::ComponentSpec& c : s.components)
            for (const model::FieldSpec& f : c.fields)
                if (f.name == "position") out.push_back(std::get<Vec3>(f.value));
        return out;
    };
    const std::vector<Vec3> one = positions("1");
    REQUIRE(one.size() == 400);
    Vec3 least{9, 9, 9}, most{-9, -9, -9};
    for (std::size_t i = 0; i < one.size(); i += 2)
    {
        CHECK(one[i] == one[i + 1]);  // an object moves as a whole
        for (int k = 0; k < 3; ++k) least[k] = std::fmin(least[k], one[i][k]), most[k] = std::fmax(most[k], one[i][k]);
    }
    CHECK(least.x > -1);
    CHECK(most.x < 1);
    CHECK(most.x - least.x > 1.8);
    CHECK(most.y - least.y > 3.6);
    CHECK(most.z == 0);
    CHECK(positions("1") == one);
    CHECK(positions("2") != one);
}

TEST_CASE("repeats that are refused")
{
    const std::string r = "scene.xml:3:1: repeat: ";
    CHECK(why({}) == r + "count is missing: give 1 to 3 whole numbers");
    CHECK(why({{"count", "0"}}) == r + "count must be 1 or more, not 0");
    CHECK(why({{"count", "2.5"}}) == r + "count: '2.5' is not a whole number");
    CHECK(why({{"count", "1 1 1 1"}}) == r + "count needs 1 to 3 whole numbers, has 4");
    CHECK(why({{"count", "1000000 1000000 1000000"}}) == r + "makes 1000000000000000000 components: a scene has at most 100000");
    CHECK(why({{"count", "100001"}}) == r + "makes 100001 components: a scene has at most 100000");
    CHECK(why({{"count", "9999999999"}}) == r + "count must be at most 1000000, not 9999999999");
    CHECK(why({{"count", "2"}, {"step", "1 0"}}) == r + "step needs 3 numbers, has 2");
    CHECK(why({{"count", "2"}, {"step", "1 0 0 s"}}) == r + "step must be in m (or cm, mm, km, um), not in 's'");
    CHECK(why({{"count", "2"}, {"jitter", "-1"}}) == r + "jitter must be 0 or more, not -1");
    CHECK(why({{"count", "2"}, {"jitter", "1 1"}}) == r + "jitter needs 3 numbers or 1, has 2");
    CHECK(why({{"count", "2"}, {"stp", "1 0 0"}}) == r + "unknown attribute 'stp', did you mean 'step'? (attributes "
                                                         "are 'id', 'count', 'step', 'jitter' and 'origin')");
    CHECK(why({{"count", "2 2"}, {"step", "1 1 1"}}) == r + "step has a z component, but count has no third number");
    CHECK(why({{"count", "2"}, {"count", "3"}}) == r + "count is given twice");
    CHECK(errors_of(repeated({{"count", "2"}}, {})) == r + "holds no component to repeat");
}

TEST_CASE("an error in a repeat is reported once")
{
    CHECK(errors_of(repeated({{"count", "500"}}, {component("b", "Shape/Sphere", {{"radius", "0"}}, 5)})) ==
          "scene.xml:5:1: b.0 (Shape/Sphere): radius must be positive, not 0");
    CHECK(errors_of(repeated({{"count", "500"}}, {component("b", "Shape/Sphere", {}, 5), component("b", "Shape/Sphere", {}, 6)})) ==
          "scene.xml:6:1: b.0 (Shape/Sphere): id 'b' is already used at scene.xml:5:1");
}

TEST_CASE("the same tree gives the same scene")
{
    const model::Blueprint b = repeated({{"count", "5 4 3"}, {"step", "1 1 1"}, {"jitter", "0.1"}, {"id", "all"}},
                                        {body("b", {{"shape", "Shape/Sphere"}, {"shape.radius", "0.1"}})},
                                        {component("c", "CDetection/Simple", {{"between", "all"}})});
    const std::string first = dump(compiled(b));
    CHECK(first.size() > 5000);
    CHECK(dump(compiled(b)) == first);
}

TEST_CASE("ten thousand bodies compile in well under a second")
{
    const model::Blueprint b = repeated(
        {{"count", "100 100"}, {"step", "1 1 0"}, {"jitter", "0.1"}, {"id", "balls"}},
        {body("ball", {{"position", "0 0 50 cm"}, {"linear_velocity", "0 0 -1"}, {"shape", "Shape/Sphere"}, {"shape.radius", "5 cm"}})},
        {component("c", "CDetection/Simple", {{"between", "balls"}}), component("d", "CDetection/Simple", {{"between", "*"}})});
    FixedTypes types;
    const auto begin = std::chrono::steady_clock::now();
    const auto result = model::compile(b, types);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    REQUIRE(result.ok());
    CHECK(result->components.size() == 20'008);
    CHECK(result->find("c")->roles.front().members.size() == 10'000);
    CHECK(took.count() < 1.0);
    CHECK(types.asked.size() == 6);  // each type once
    MESSAGE("10,000 bodies with shapes: " << took.count() * 1e3 << " ms");
}
