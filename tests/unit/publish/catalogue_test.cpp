// What observers receive about the structure: everything at first, then only what changed.
#include <algorithm>
#include <chrono>
#include <thread>

#include "watcher.h"

using namespace plab;
using namespace plab::test;
using publish::CatalogueChange;

namespace
{

const std::string kBalls = R"(
  <component id="ball" type="Shape/Sphere" radius="0.1"/>
  <component id="red" name="the red one" type="State/RigidBody" mass="2" shape="ball" position="0 0 1" color="1 0 0"/>
  <component id="green" type="State/RigidBody" mass="2" shape="ball" position="1 0 1"/>
  <component id="floor" type="State/Static" shape="Shape/Plane"/>
  <component id="wheel" type="State/Shaft" position="0 0 2" axis="1 0 0" inertia="0.5" angular_velocity="3"/>
  <component id="gravity" type="Field/Gravity" between="red green"/>
  <component id="drag" type="Field/Drag" between="*" linear="0.1"/>
  <component id="contact" name="bounce" type="CDetection/ODE" between="red green floor" response.restitution="0.5"/>
)";

model::SceneSpec fragment_of(const Scene& scene, const std::string& body)
{
    auto fragment = test::compile_text(test::whole_scene(body), "fragment.xml", &scene.simulation().world().scene());
    REQUIRE_MESSAGE(fragment.ok(), test::reasons(fragment));
    return fragment.take();
}

using Ids = std::set<std::string>;

}  // namespace

TEST_CASE("at first everything, as the scene has it")
{
    Scene scene(kBalls, "dt=\"1/120\" seed=\"7\" title=\"two balls\"");
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    Watched run(scene);
    run.step();
    REQUIRE(run.watcher.changes.size() == 1);
    const CatalogueChange& all = run.watcher.changes[0];
    CHECK(all.everything);
    CHECK(ids_in(all) == Ids{"ball", "red", "green", "floor", "floor.shape", "wheel", "gravity", "drag", "contact", "contact.resolution",
                             "contact.response", "contact.response.manager", "solver"});
    CHECK(all.scene.objects == 4);
    CHECK(all.scene.interactions == 7);
    CHECK(all.scene.dt == doctest::Approx(1.0 / 120));
    CHECK(all.scene.seed == 7);
    CHECK(all.scene.title == "two balls");
    CHECK(all.types.size() == library().names().size());

    const auto* red = find_entry(all.objects, "red");
    REQUIRE(red);
    CHECK(red->name == "the red one");
    CHECK(red->type_name == "State/RigidBody");
    CHECK(red->motion == "dynamic");
    CHECK(red->mass == 2);
    CHECK(red->color == Vec3{1, 0, 0});
    CHECK(red->shapes == std::vector<std::string>{"ball"});
    CHECK(parameter(red->parameters, "mass") == "2");
    CHECK(find_entry(all.objects, "floor")->motion == "static");
    const auto* wheel = find_entry(all.objects, "wheel");
    CHECK(wheel->shape_of == "shaft");
    CHECK(wheel->mass == 0.5);
    CHECK(distance(rotate(wheel->orientation, {0, 0, 1}), {1, 0, 0}) < 1e-12);
    CHECK(distance(wheel->position, {0, 0, 2}) < 1e-12);

    const auto* contact = find_entry(all.interactions, "contact");
    REQUIRE(contact);
    CHECK(contact->name == "bounce");
    CHECK(contact->family == "CDetection");
    CHECK(contact->since == 0);
    REQUIRE(!contact->roles.empty());
    CHECK(contact->roles[0].role == "between");
    CHECK(contact->roles[0].members == std::vector<std::string>{"floor", "green", "red"});
    CHECK(parameter(find_entry(all.interactions, "contact.response")->parameters, "restitution") == "0.5");
    CHECK(find_entry(all.shapes, "ball")->size.x == 0.1);

    run.step(20);
    CHECK(run.watcher.changes.size() == 1);
}

TEST_CASE("a set, a swap, an addition, a removal: only the components concerned")
{
    Scene scene(kBalls);
    Watched run(scene);
    run.step(3);
    auto& changes = run.watcher.changes;
    const auto handle = [&](const std::string& id) { return find_entry(changes.front().objects, id)->handle; };
    const std::set<std::uint32_t> handles{handle("red"), handle("green"), handle("floor"), handle("wheel")};
    CHECK(handles.size() == 4);

    run.ask(simulation::SetOperation{"gravity", "acceleration", std::string("0 0 -1.62")});
    REQUIRE(changes.size() == 2);
    CHECK(!changes[1].everything);
    CHECK(ids_in(changes[1]) == Ids{"gravity"});
    CHECK(changes[1].types.empty());
    CHECK(parameter(changes[1].interactions[0].parameters, "acceleration") == "0 0 -1.62");

    SUBCASE("a shape's size is published with the mass of its body")
    {
        run.ask(simulation::SetOperation{"ball", "radius", std::string("0.2")});
        CHECK(ids_in(changes[2]) == Ids{"ball", "red", "green"});
        CHECK(changes[2].shapes[0].size.x == 0.2);
    }
    SUBCASE("a swap changes type and since")
    {
        run.ask(simulation::SwapOperation{"contact.resolution", "Resolution/LocalBisection", {}});
        REQUIRE(changes.size() == 3);
        CHECK(ids_in(changes[2]) == Ids{"contact.resolution"});
        CHECK(changes[2].interactions[0].type_name == "Resolution/LocalBisection");
        CHECK(changes[2].interactions[0].since == 3);
        run.step();
        run.ask(simulation::SetOperation{"gravity", "acceleration", std::string("0 0 -9")});
        CHECK(changes.back().interactions[0].since == 0);
    }
    SUBCASE("an added component is published together with those that refer to everyone; handles are not reused")
    {
        const auto more = fragment_of(scene, R"(<component id="blue" type="State/RigidBody" mass="1" shape="ball" position="5 0 5"/>)");
        run.ask(simulation::AddOperation{more});
        CHECK(ids_in(changes[2]) == Ids{"blue", "drag"});
        CHECK(changes[2].scene.objects == 5);
        const std::uint32_t blue = changes[2].objects[0].handle;
        CHECK(!handles.contains(blue));
        CHECK(changes[2].interactions[0].roles[0].members == std::vector<std::string>{"blue", "floor", "green", "red", "wheel"});

        run.ask(simulation::RemoveOperation{"blue"});
        CHECK(changes[3].gone == std::vector<std::string>{"blue"});
        CHECK(ids_in(changes[3]) == Ids{"drag"});
        CHECK(changes[3].scene.objects == 4);
        run.ask(simulation::AddOperation{more});
        CHECK(changes[4].objects[0].handle > blue);
        CHECK(changes[4].gone.empty());
    }
    SUBCASE("a group stands for the components inside it")
    {
        run.ask(simulation::AddOperation{fragment_of(scene, R"(<component id="box" name="a box"><component id="box.state"
            type="State/RigidBody" mass="1" shape="Shape/Box" shape.half_extents="1 1 1" position="9 9 9"/></component>)")});
        CHECK(ids_in(changes[2]) == Ids{"box.state", "box.state.shape", "drag"});
        simulation::Changes touched;
        touched.touched = {"box"};
        run.collector.collect(scene.simulation(), touched, false);
        CHECK(ids_in(changes.back()) == Ids{"box.state", "box.state.shape"});
        run.ask(simulation::RemoveOperation{"box"});
        CHECK(changes.back().gone == std::vector<std::string>{"box.state", "box.state.shape"});
    }
    SUBCASE("a reset is a new run: everything is published, and handles begin again")
    {
        run.ask(simulation::ResetOperation{});
        CHECK(changes[2].everything);
        CHECK(ids_in(changes[2]) == ids_in(changes[0]));
        CHECK(changes[2].scene.run == changes[0].scene.run + 1);
        CHECK(find_entry(changes[2].objects, "red")->handle == handle("red"));
    }
    SUBCASE("a changed step length is published with the scene")
    {
        run.ask(simulation::StepLengthOperation{{0.01, 1, 100}});
        REQUIRE(changes.size() == 3);
        CHECK(ids_in(changes[2]).empty());
        CHECK(changes[2].scene.dt == 0.01);
    }
}

TEST_CASE("without room: everything is published as soon as there is room")
{
    Scene scene(kBalls);
    Watched run(scene);
    run.watcher.has_room = false;
    run.step();
    CHECK(run.watcher.changes.empty());
    std::string acceleration = "0 0 -9.81";
    SUBCASE("at first") {}
    SUBCASE("at a change")
    {
        acceleration = "0 0 -1";
        run.ask(simulation::SetOperation{"gravity", "acceleration", acceleration});
    }
    run.watcher.has_room = true;
    for (int i = 0; i < 200 && run.watcher.changes.empty(); ++i)
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        run.collector.idle(scene.simulation());
    }
    REQUIRE(run.watcher.changes.size() == 1);
    CHECK(run.watcher.changes[0].everything);
    CHECK(parameter(find_entry(run.watcher.changes[0].interactions, "gravity")->parameters, "acceleration") == acceleration);
    run.step();
    CHECK(run.watcher.changes.size() == 1);
}

TEST_CASE("a type whose plugin is loaded later is published as loaded")
{
    plugins::PluginLibrary own({PLAB_BINARY_DIR "/lib/plab"});
    std::vector<model::TypeSummary> types = own.summaries();
    CHECK(std::none_of(types.begin(), types.end(), [](const auto& t) { return t.loaded; }));
    Scene scene(R"(<component id="wheel" type="State/Shaft" inertia="1"/>)");
    Watcher watcher;
    publish::Collector collector(kAlways, types);
    collector.attach(watcher);
    scene.step();
    collector.collect(scene.simulation(), scene.simulation().take_changes(), true);
    const auto loaded = [&](const std::string& name)
    {
        for (const auto& t : watcher.changes.back().types)
            if (t.type_name == name) return t.is_loaded;
        return false;
    };
    CHECK(loaded("State/Shaft"));
    CHECK(loaded("State/RigidBody"));  // of the same plugin
    CHECK(!loaded("Field/Drag"));
    const auto more = fragment_of(scene, R"(<component id="drag" type="Field/Drag" between="wheel" rotational="0.1"/>)");
    REQUIRE(scene.ask(simulation::AddOperation{more}).done);
    collector.collect(scene.simulation(), scene.simulation().take_changes(), false);
    CHECK(loaded("Field/Drag"));
    CHECK(ids_in(watcher.changes.back()) == Ids{"drag"});
}

TEST_CASE("quarantine and what scripts set reach the catalogue")
{
    Scene scene(R"(
      <component id="wheel" type="State/Shaft" inertia="1"/>
      <component id="pull" type="Field/Drag" between="wheel" rotational="0.1"/>
      <component id="drive" type="Script/Lua" driven="wheel"><param name="code">
        function drive(step)
            if step.tick == 5 then error("enough") end
            set("pull", "rotational", 0.1 * (step.tick + 2))
        end
      </param></component>)");
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    scene.warnings_expected = true;
    SUBCASE("at the rate of metrics")
    {
        Watched run(scene, {0, 1e-3});
        run.step(4);
        CHECK(run.watcher.changes.size() == 1);
    }
    SUBCASE("at each step if the scene always changes")
    {
        Watched run(scene);
        run.step(2);
        REQUIRE(run.watcher.changes.size() >= 2);
        const auto* pull = find_entry(run.watcher.changes.back().interactions, "pull");
        REQUIRE(pull);
        CHECK(std::stod(parameter(pull->parameters, "rotational")) == doctest::Approx(0.3));
        run.step(4);
        const auto* drive = find_entry(run.watcher.changes.back().interactions, "drive");
        REQUIRE(drive);
        CHECK(drive->quarantined);
        CHECK(run.watcher.samples.back().interactions[0].resolved == "nothing: it failed and takes no part");
    }
}
