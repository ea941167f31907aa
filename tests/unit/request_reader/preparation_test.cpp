// Additions that were compiled in advance: they take effect like those that are compiled at their step, also if the scene has changed.
#include "control/preparation.h"

#include <doctest/doctest.h>

#include "blueprint/reader.h"
#include "plugins/library.h"
#include "simulation/simulation.h"

using namespace plab;
using namespace plab::simulation;

namespace
{

constexpr const char* kScene = R"(<plab version="1">
  <component id="earth" type="Field/Gravity" between="*"/>
  <component id="round" type="Shape/Sphere" radius="0.1"/>
  <component id="one" type="State/RigidBody" shape="round" mass="1" position="0 0 5"/>
</plab>)";

/// Refers to `round` and makes a body of the given id.
std::string ball(const std::string& id)
{
    return "<component id=\"" + id + "\" type=\"State/RigidBody\" shape=\"round\" mass=\"2\" position=\"3 0 5\"/>";
}

class Server
{
public:
    explicit Server(const std::string& scene = kScene) : simulation(library_)
    {
        const auto blueprint = blueprint::read_blueprint(scene, "scene.xml");
        REQUIRE(blueprint.ok());
        const auto compiled = model::compile(*blueprint, library_);
        REQUIRE_MESSAGE(compiled.ok(), compiled.error().text());
        REQUIRE(simulation.load(*compiled).ok());
        for (int i = 0; i < 10; ++i) (void)simulation.step();
    }
    Request addition(const std::string& text) const
    {
        Request out;
        out.operations.push_back(AddBlueprintOperation(blueprint::read_blueprint(text, "more.xml").take()));
        return out;
    }
    /// As the thread that reads requests does it.
    Request prepared(const std::string& text)
    {
        Request out = addition(text);
        control::prepare_additions(out, library_, simulation.world().lend_scene(), {});
        REQUIRE(std::get<AddBlueprintOperation>(out.operations.front()).prepared);
        return out;
    }
    Reply ask(simulation::Operation operation)
    {
        Request request;
        request.operations.push_back(std::move(operation));
        return simulation.carry_out_now(request);
    }
    /// Carries out the request on one and the same scene, with what was prepared and without it, and compares the runs that follow.
    Reply carry_out_like(Request request, Server& other)
    {
        const Reply reply = simulation.carry_out_now(request);
        std::get<AddBlueprintOperation>(request.operations.front()).prepared.reset();
        const Reply plain = other.simulation.carry_out_now(request);
        CHECK(reply.done == plain.done);
        CHECK(reply.revision == plain.revision);
        REQUIRE(reply.errors.size() == plain.errors.size());
        for (std::size_t i = 0; i < reply.errors.size(); ++i) CHECK(reply.errors[i].text() == plain.errors[i].text());
        CHECK(simulation.take_changes().touched == other.simulation.take_changes().touched);
        for (int i = 0; i < 20; ++i)
        {
            (void)simulation.step(), (void)other.simulation.step();
            CHECK(simulation.state_hash() == other.simulation.state_hash());
        }
        return reply;
    }

private:
    plugins::PluginLibrary library_;

public:
    Simulation simulation;
};

bool fits(const Request& request, const Simulation& simulation)
{
    return std::get<AddBlueprintOperation>(request.operations.front()).prepared->fits(simulation.world().scene());
}

}  // namespace

TEST_CASE("what was prepared for the present scene is what is compiled at the step, and so are its errors")
{
    Server server, other;
    const Request add = server.prepared(ball("two"));
    CHECK(fits(add, server.simulation));
    (void)server.simulation.step(), (void)other.simulation.step();  // a step changes no scene
    CHECK(fits(add, server.simulation));
    CHECK(server.carry_out_like(add, other).done);
    CHECK_FALSE(fits(add, server.simulation));
    const Request wrong = server.prepared("<plab version=\"1\">\n  " + ball("one") + "\n</plab>");
    CHECK(fits(wrong, server.simulation));
    const Reply refused = server.carry_out_like(wrong, other);
    CHECK_FALSE(refused.done);
    REQUIRE(refused.errors.size() == 1);
    CHECK(refused.errors.front().text() == "more.xml:2:3: one (State/RigidBody): id 'one' is already in the scene");
    CHECK(fits(wrong, server.simulation));  // a refused request changes no scene
}

TEST_CASE("an addition takes effect although something else has been added since it was prepared")
{
    Server server, other;
    const Request add = server.prepared(ball("two"));
    for (Server* s : {&server, &other}) REQUIRE(s->simulation.carry_out_now(s->addition(ball("three"))).done);
    CHECK_FALSE(fits(add, server.simulation));
    CHECK(server.carry_out_like(add, other).done);
    for (const char* id : {"one", "two", "three"}) CHECK(server.simulation.world().find(id) != kNoIndex);
    CHECK(server.simulation.world().scene().components.size() == other.simulation.world().scene().components.size());
}

TEST_CASE("an addition is refused if its id was taken, or what it refers to was removed, since it was prepared")
{
    Server server, other;
    const Request add = server.prepared(ball("two"));
    for (Server* s : {&server, &other}) REQUIRE(s->simulation.carry_out_now(s->addition(ball("two"))).done);
    const Reply taken = server.carry_out_like(add, other);
    CHECK_FALSE(taken.done);
    REQUIRE_FALSE(taken.errors.empty());
    CHECK(taken.errors.front().text().find("is already in the scene") != std::string::npos);

    const Request late = server.prepared(ball("four"));
    for (Server* s : {&server, &other})
        for (const char* id : {"one", "two", "round"}) REQUIRE(s->ask(RemoveOperation{id}).done);
    const Reply lost = server.carry_out_like(late, other);
    CHECK_FALSE(lost.done);
    CHECK(server.simulation.world().find("four") == kNoIndex);
    CHECK(server.simulation.world().find("round") == kNoIndex);
}

TEST_CASE("a new run is another scene, even of the same components")
{
    Server server, other;
    const Request add = server.prepared(ball("two"));
    for (Server* s : {&server, &other}) REQUIRE(s->ask(ResetOperation{}).done);
    CHECK_FALSE(fits(add, server.simulation));
    CHECK(server.carry_out_like(add, other).done);
}

TEST_CASE("in a request of several operations only the first that changes the scene can be prepared; all of them take effect")
{
    Server server, other;
    Request both = server.addition(ball("two"));
    both.operations.push_back(server.addition(ball("three")).operations.front());
    both.operations.insert(both.operations.begin(), SetOperation{"one", "mass", std::string("3")});
    CHECK(control::has_additions(both));
    plugins::PluginLibrary types;
    control::prepare_additions(both, types, server.simulation.world().lend_scene(), {});
    CHECK(std::get<AddBlueprintOperation>(both.operations[1]).prepared);
    CHECK_FALSE(std::get<AddBlueprintOperation>(both.operations[2]).prepared);
    CHECK(server.simulation.carry_out_now(both).done);
    for (const char* id : {"two", "three"}) CHECK(server.simulation.world().find(id) != kNoIndex);
    Request behind;
    behind.operations = {RemoveOperation{"two"}, server.addition(ball("two")).operations.front()};
    CHECK_FALSE(control::has_additions(behind));
}

TEST_CASE("a part that a swap has to make is loaded with the new type")
{
    plugins::PluginLibrary types;
    Request swap;
    swap.operations.push_back(SwapOperation{"response", "Rows", {}});
    control::load_types(swap, types);
    bool manager = false;
    for (const plugins::PluginInfo& plugin : types.loaded())
        for (const std::string& type : plugin.types) manager = manager || type.starts_with("Manager/");
    CHECK(manager);
}
