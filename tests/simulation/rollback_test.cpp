// Requests of several operations, and the state after failed ones.
#include "support/scene.h"

using namespace plab;
using namespace plab::simulation;
using plab::test::first_error;
using plab::test::Scene;

namespace
{

constexpr const char* kPaper = "scenes/fan_and_balloons.xml";

AddBlueprintOperation add(const std::string& body)
{
    auto blueprint = blueprint::read_blueprint("<plab version=\"1\">" + body + "</plab>", "request.xml");
    REQUIRE_MESSAGE(blueprint.ok(), (blueprint.ok() ? "" : first_error(blueprint.errors())));
    return AddBlueprintOperation(blueprint.take());
}

Reply ask(Scene& s, std::vector<Operation> operations)
{
    Request request;
    request.operations = std::move(operations);
    return s.simulation().carry_out_now(request);
}

std::string ball(const std::string& id, double x)
{
    return "<component id=\"" + id + "\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 1 1\" position=\"" + std::to_string(x) +
           " 0 0\"/>";
}

}  // namespace

TEST_CASE("a component may be swapped and removed in one request")
{
    Scene s = Scene::file(kPaper);
    s.run(0.5);
    const Reply reply = ask(s, {SwapOperation{"contact.response", "Response/None", {}}, RemoveOperation{"contact"}});
    CHECK_MESSAGE(reply.done, first_error(reply.errors));
    CHECK(s.simulation().world().find("contact") == kNoIndex);
    s.run(1);
}

TEST_CASE("a component that a request adds may be swapped by it; errors go to their own report")
{
    Scene s = Scene::file(kPaper);
    s.run(0.5);
    const Reply reply =
        ask(s, {add("<component id=\"own\" type=\"Solver/RungeKutta4\"/>"), SwapOperation{"own", "Solver/SemiImplicitEuler", {}},
                SwapOperation{"gears", "Constraint/AngularVelocity/Impulse", {}}});
    REQUIRE_MESSAGE(reply.done, first_error(reply.errors));
    REQUIRE(reply.swaps.size() == 2);
    CHECK(reply.swaps[0].id == "own");
    CHECK(reply.swaps[0].with_old.error == 0);
}

TEST_CASE("components that were added and removed in a failed request take nothing from later ones")
{
    Scene s("<component id=\"first\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 1 1\"/>");
    const std::uint64_t hash = s.hash();
    for (int i = 0; i < 3; ++i)
    {
        const Reply failed = ask(s, {add(ball("q", 5)), SwapOperation{"q", "State/Kinematic", {}}, RemoveOperation{"q"},
                                     SetOperation{"first", "nope", std::string("1")}});
        CHECK_FALSE(failed.done);
        CHECK(s.hash() == hash);
    }
    REQUIRE(ask(s, {add(ball("z", 1))}).done);
    REQUIRE(ask(s, {add(ball("y", 2))}).done);
    REQUIRE(ask(s, {PushOperation{"y", {3, 0, 0}, {}}}).done);
    CHECK(s.vec("z", "position").x == 1);
    CHECK(s.vec("y", "position").x == 2);
    CHECK(s.vec("z", "linear_velocity").x == 0);
    CHECK(s.vec("y", "linear_velocity").x == 3);
    CHECK(s.simulation().world().component(s.simulation().world().find("z")).host_index !=
          s.simulation().world().component(s.simulation().world().find("y")).host_index);
}

TEST_CASE("a request that adds many components, one of which fails at its first step, is rolled back while scripts set parameters")
{
    Scene s("<component id=\"a\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 1 1\"/>");
    const std::uint64_t hash = s.hash();
    std::string many;
    for (int i = 0; i < 40; ++i) many += ball("b" + std::to_string(i), i);
    many +=
        "<component id=\"setter\" type=\"Script/Lua\" driver=\"a\" driven=\"b39\"><param name=\"code\">function drive(step) set(\"b39\", "
        "\"mass\", "
        "0.5) end</param></component><component id=\"thrower\" type=\"Script/Lua\" driver=\"a\" driven=\"b39\"><param "
        "name=\"code\">function "
        "force(t, state) error(\"x\") end</param></component>";
    const Reply failed = ask(s, {add(many)});
    CHECK_FALSE(failed.done);
    CHECK(s.hash() == hash);
    s.run(0.1);
}

TEST_CASE("a shape that many bodies share is changed in a time that grows with their number")
{
    const auto cost = [](int side)
    {
        Scene s("<component id=\"s\" type=\"Shape/Sphere\" radius=\"0.1\"/><repeat id=\"all\" count=\"" + std::to_string(side) + " " +
                std::to_string(side) +
                "\" step=\"1 1 0\"><component id=\"b\" type=\"State/RigidBody\" density=\"1\" shape=\"s\"/></repeat>");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        double best = 1e30;
        for (int i = 0; i < 8; ++i)
        {
            const Reply reply = ask(s, {SetOperation{"s", "radius", std::to_string(0.2 + 0.01 * i)}});
            REQUIRE_MESSAGE(reply.done, first_error(reply.errors));
            best = std::min(best, reply.pause_ns);
        }
        return best;
    };
    // 16 times as many bodies: a square would be 256. Measured 45 to 75, as they do not fit into the caches any more.
    CHECK(cost(48) < 130 * cost(12));
}
