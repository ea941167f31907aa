// Snapshots before, between and after changes of a running scene: swaps, additions, removals, failures, requests that wait.
#include "boxes.h"

using namespace plab;
using namespace plab::test;
using simulation::Simulation;

namespace
{

/// Dense enough that there are snapshots before, between and after all changes.
Plan seldom()
{
    Plan plan;
    plan.every = 20, plan.follow = 40, plan.as_file = true;
    return plan;
}

}  // namespace

TEST_CASE("across swaps of response, resolution and the way a detection acts, before, between and after")
{
    for (const char* response : {"Penalty", "Rows"})
    {
        const std::string what = follow_changes(kBoxes,
                                                {{35, {swap_of("contact.response", std::string("Response/") + response)}},
                                                 {75, {swap_of("contact.response", "Response/Impulse")}}},
                                                seldom());
        CHECK_MESSAGE(what.empty(), std::string(response), ": ", what);
    }
    for (const char* resolution : {"LocalRoot", "Bisection", "None"})
    {
        const std::string what =
            follow_changes(kBoxes, {{35, {swap_of("contact.resolution", std::string("Resolution/") + resolution)}}}, seldom());
        CHECK_MESSAGE(what.empty(), std::string(resolution), ": ", what);
    }
}

TEST_CASE("across swaps of managers and solvers")
{
    const std::string rows = kBoxes + "<component id='solver' type='Solver/Automatic'/>";
    for (const char* manager : {"Direct", "SoftStep", "SequentialImpulse"})
    {
        const std::string what = follow_changes(rows,
                                                {{5, {swap_of("contact.response", "Response/Rows")}},
                                                 {35, {swap_of("contact.response.manager", std::string("Manager/") + manager)}},
                                                 {45, {swap_of("contact.resolution", "Resolution/Speculative")}},
                                                 {65, {swap_of("solver", "Solver/Radau5")}},
                                                 {95, {swap_of("solver", "Solver/StoermerVerlet")}}},
                                                seldom());
        CHECK_MESSAGE(what.empty(), std::string(manager), ": ", what);
    }
}

TEST_CASE("across additions and removals, which leave free rows that others use")
{
    const auto body = [](const char* id, const char* x)
    {
        return added(std::string("<component id='") + id + "' type='State/RigidBody' mass='1' shape='ball' position='" + x +
                     " 0.5 0.4' linear_velocity='0.1 0 0'/>");
    };
    // Its work stays in the ledger when it is removed.
    const std::string air = "<component id='air' type='Field/Drag' between='low high bouncing' linear='0.1'/>";
    const std::string what = follow_changes(kBoxes + air,
                                            {{15, {body("zz", "0.2")}},
                                             {30, {simulation::RemoveOperation{"air"}}},
                                             {35, {simulation::RemoveOperation{"bouncing"}}},
                                             {55, {body("aa", "0.5")}},
                                             {70, {simulation::RemoveOperation{"zz"}, body("mm", "-0.4")}},
                                             {90, {simulation::SetOperation{"ball", "radius", std::string("0.12")}}}},
                                            seldom());
    CHECK_MESSAGE(what.empty(), what);
}

TEST_CASE("at a boundary between a swap and its step, swapping back restores every bit in both runs")
{
    const model::SceneSpec scene = scene_of(kBoxes);
    const auto original = started(scene);
    for (int i = 0; i < 60; ++i) original->step();
    const std::uint64_t before = original->state_hash();
    ask(*original, {swap_of("contact.response", "Response/Penalty")});
    CHECK(original->state_hash() != before);
    Simulation twin(library());
    REQUIRE(twin.restore(original->capture()).ok());
    for (Simulation* s : {original.get(), &twin})
    {
        ask(*s, {swap_of("contact.response", "Response/Impulse")});
        CHECK(s->state_hash() == before);
    }
    CHECK(difference_of(original->capture(), twin.capture()).empty());
}

TEST_CASE("with an object that is frozen, and one whose script has failed")
{
    const std::string failing =
        kBoxes +
        "<component id='lost' type='State/RigidBody' mass='1' inertia='1 1 1' position='50 0 0'/>"
        "<component id='blast' type='Script/Lua' driven='lost'><param name='state'><entry name='n'>0</entry></param>"
        "<param name='code'>function drive(step) state.n = state.n + 1 end\n"
        "function force(t, state) if state.n > 25 then driven:add_force(vec(1e308, 1e308, 0) * 10) end end</param></component>"
        "<component id='broken' type='Script/Lua' driven='low'><param name='state'><entry name='n'>0</entry></param>"
        "<param name='code'>function drive(step) state.n = state.n + 1; if state.n == 46 then error('no more') end end</param>"
        "</component>";
    const auto original = started(scene_of(failing));
    for (int i = 0; i < 100; ++i) original->step();
    REQUIRE(original->world().component(original->world().find("broken")).quarantined);
    const std::string what = follow_changes(failing,
                                            {{110,
                                              {simulation::SetOperation{"broken", "state.n", std::string("100")},
                                               simulation::SetOperation{"broken", "quarantined", std::string("false")}}}},
                                            seldom());
    CHECK_MESSAGE(what.empty(), what);
}

TEST_CASE("conditions that were already reported are not reported again")
{
    // Two hinges that contradict each other: reported once, as long as it lasts.
    const std::string torn =
        "<component id='a' type='State/RigidBody' mass='1' inertia='1 1 1'/>"
        "<component id='b' type='State/RigidBody' mass='1' inertia='1 1 1' position='1 0 0'/>"
        "<component id='one' type='Constraint/Ball' a='a' b='b' anchor='0.5 0 0'/>"
        "<component id='two' type='Constraint/Distance' a='a' b='b' length='2.5'/>";
    const auto scene = scene_of(torn);
    const auto original = started(scene);
    std::size_t reported = 0;
    for (int i = 0; i < 40; ++i)
    {
        original->step();
        for (const Event& e : original->events()) reported += e.kind == "constraint.contradiction" ? 1 : 0;
    }
    REQUIRE(reported > 0);
    Plan plan;
    plan.steps = 60, plan.every = 20;
    const std::string what = follow(scene, plan);
    CHECK_MESSAGE(what.empty(), what);
}

TEST_CASE("a restored run is a new run of the same scene: reset, step length and pause are as they were")
{
    const auto original = started(scene_of(kBoxes));
    ask(*original, {swap_of("contact.response", "Response/Penalty")});
    for (int i = 0; i < 30; ++i) original->step();
    ask(*original, {simulation::StepLengthOperation{{1.0 / 240, 1, 240}}});
    ask(*original, {simulation::RateOperation{0.5}});
    for (int i = 0; i < 30; ++i) original->step();
    ask(*original, {simulation::StepOperation{7}});
    for (int i = 0; i < 3; ++i) original->step();

    const auto twin = started(scene_of("<component id='s' type='State/Shaft' inertia='1'/>"));
    (void)twin->take_changes();
    const std::uint64_t run = twin->run(), revision = twin->revision();
    REQUIRE(twin->restore(original->capture()).ok());
    CHECK(twin->run() == run + 1);
    CHECK(twin->revision() >= revision);
    CHECK(twin->take_changes().everything);
    CHECK(twin->tick() == original->tick());
    CHECK(twin->time() == original->time());
    CHECK(twin->rate() == 0.5);
    for (int i = 0; i < 6; ++i) CHECK(twin->step() == original->step());
    CHECK(twin->paused());
    CHECK(difference_of(original->capture(), twin->capture()).empty());
    for (Simulation* s : {original.get(), twin.get()})
    {
        ask(*s, {simulation::ResetOperation{}});
        CHECK(s->world().type_of(s->world().find("contact.response"))->info.name == "Response/Impulse");
        ask(*s, {simulation::ResumeOperation{}});
        for (int i = 0; i < 20; ++i) s->step();
    }
    CHECK(difference_of(original->capture(), twin->capture()).empty());
}

TEST_CASE("requests that wait at the snapshot wait again; other waiting requests are refused")
{
    const auto s = started(scene_of(kBoxes));
    const auto post = [&](std::uint64_t id, Tick at)
    {
        simulation::Request request;
        request.id = id, request.at = at, request.operations = {simulation::PushOperation{"bouncing", {0, 0, 1}, {}}};
        s->post(std::move(request));
    };
    for (int i = 0; i < 10; ++i) s->step();
    post(1, 20);
    const simulation::Snapshot snapshot = s->capture();
    REQUIRE(snapshot->waiting.size() == 1);
    post(2, 30);
    REQUIRE(s->restore(snapshot).ok());
    CHECK(s->pending_requests() == 2);
    (void)s->apply_due();
    auto replies = s->take_replies();
    REQUIRE(replies.size() == 1);
    CHECK(replies[0].request == 2);
    CHECK(!replies[0].done);
    for (int i = 0; i < 15; ++i) s->step();
    replies = s->take_replies();
    REQUIRE(replies.size() == 1);
    CHECK(replies[0].request == 1);
    CHECK(replies[0].done);
    CHECK(replies[0].step == 20);
}

TEST_CASE("a snapshot is a value: it outlives its run, and continuing the run does not change it")
{
    simulation::Snapshot snapshot;
    std::vector<Footprint> then;
    {
        const auto s = started(scene_of(kBoxes));
        for (int i = 0; i < 40; ++i) s->step();
        snapshot = s->capture();
        for (int i = 0; i < 40; ++i)
        {
            if (i == 20) ask(*s, {simulation::RemoveOperation{"high"}});
            s->step(), then.push_back(footprint(*s));
        }
    }
    for (int round = 0; round < 2; ++round)
    {
        Simulation twin(library());
        REQUIRE(twin.restore(snapshot).ok());
        for (int i = 0; i < 40; ++i)
        {
            if (i == 20) ask(twin, {simulation::RemoveOperation{"high"}});
            twin.step();
            REQUIRE(footprint(twin) == then[static_cast<std::size_t>(i)]);
        }
    }
}

TEST_CASE("a refused snapshot changes nothing")
{
    const auto s = started(scene_of(kBoxes));
    for (int i = 0; i < 20; ++i) s->step();
    const simulation::Snapshot before = s->capture();
    CHECK(!s->restore(simulation::Snapshot()).ok());

    auto broken = std::make_shared<simulation::SnapshotContent>(*before);
    broken->world.bodies.velocity[0].x += 1e-9;
    const auto refused = s->restore(simulation::Snapshot(broken));
    REQUIRE(!refused.ok());
    CHECK(reasons(refused).find("differs from the captured one") != std::string::npos);

    auto foreign = std::make_shared<simulation::SnapshotContent>(*before);
    auto scene = std::make_shared<model::SceneSpec>(*before->world.scene);
    model::ComponentSpec klein = scene->components[0];
    klein.type = "Shape/Klein";
    scene->components.replace(0, std::move(klein));
    foreign->world.scene = scene;
    CHECK(!s->restore(simulation::Snapshot(foreign)).ok());
    CHECK(s->run() == before->run);
    CHECK(difference_of(before, s->capture()).empty());
}
