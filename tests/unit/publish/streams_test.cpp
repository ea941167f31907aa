// Frames, collisions, events, metrics and status: when they are published, and what they contain.
#include <algorithm>
#include <chrono>
#include <map>
#include <thread>

#include "publish/figures.h"
#include "publish/pace.h"
#include "simulation/costs/component_costs.h"
#include "support/allocation_counter.h"
#include "watcher.h"

using namespace plab;
using namespace plab::test;
using publish::Stream;

namespace
{

const std::string kDrop = R"(
  <component id="ball" type="State/RigidBody" mass="1" shape="Shape/Sphere" shape.radius="0.1" position="0 0 0.5"/>
  <component id="floor" type="State/Static" shape="Shape/Plane"/>
  <component id="gravity" type="Field/Gravity" between="ball"/>
  <component id="contact" type="CDetection/ODE" between="ball floor" resolution="Resolution/Bisection" response="Response/Impulse"
             response.restitution="0.5"/>
)";

/// Numbers of batches follow one another; returns the number after the last one.
template <class Batches>
std::uint64_t check_numbers(const Batches& batches, std::uint64_t next)
{
    for (const auto& batch : batches)
    {
        CHECK(batch.sequence_number == next);
        CHECK(!batch.entries.empty());
        next += batch.entries.size();
    }
    return next;
}

}  // namespace

TEST_CASE("a pace keeps its grid despite jitter, and does not make up for missed times")
{
    publish::Pace pace(100);
    std::int64_t now = 1'000'000'000;
    CHECK(pace.due(now));
    CHECK(!pace.due(now + 1));
    int due = 0;
    for (int i = 1; i <= 400; ++i)
    {
        const std::int64_t jitter = (i % 3 - 1) * 400'000;
        due += pace.due(now + i * 2'500'000 + jitter) ? 1 : 0;
    }
    CHECK(due == 100);
    now += 60'000'000'000;
    CHECK(pace.due(now));
    CHECK(!pace.due(now + 1'000'000));
    publish::Pace always(0);
    CHECK(always.due(5));
    CHECK(always.due(5));
}

TEST_CASE("a frame holds the poses of bodies in the frames that the scene's author defined")
{
    Scene scene(R"(
      <component id="static" type="State/Static" shape="Shape/Sphere" shape.radius="1" position="9 9 9"/>
      <component id="lump" type="State/RigidBody" mass="1" position="1 2 3" linear_velocity="0.3 0 0" angular_velocity="0 0 2">
        <component id="lump.shape" type="Shape/Placed" of="Shape/Sphere" of.radius="0.1" position="0.5 0 0"/>
      </component>
      <component id="cart" type="State/Kinematic" shape="Shape/Sphere" shape.radius="1" linear_velocity="1 0 0"/>
      <component id="wheel" type="State/Shaft" inertia="1" angle="0.5" angular_velocity="4"/>)");
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    Watched run(scene);
    run.step(10);
    const auto& frame = run.watcher.frame;
    CHECK(run.watcher.frames == 10);
    CHECK(frame.sequence_number == 10);
    CHECK(frame.step == 10);
    CHECK(frame.run == scene.simulation().run());
    CHECK(frame.time == scene.simulation().time());
    CHECK(frame.stamp_ns > 1'600'000'000'000'000'000);
    REQUIRE(frame.bodies.size() == 2);
    const auto* entry = find_entry(run.watcher.changes[0].objects, "lump");
    const auto lump = std::find_if(frame.bodies.begin(), frame.bodies.end(), [&](const auto& b) { return b.handle == entry->handle; });
    REQUIRE(lump != frame.bodies.end());
    CHECK(length(rotate(lump->orientation, {0.5, 0, 0})) == doctest::Approx(0.5));
    CHECK(distance(lump->position, scene.vec("lump", "position")) < 1e-15);
    CHECK(distance(lump->linear_velocity, scene.vec("lump", "linear_velocity")) < 1e-14);
    CHECK(distance(lump->angular_velocity, scene.vec("lump", "angular_velocity")) == 0);
    // The centre of mass moves on a straight line, the origin does not.
    CHECK(distance(lump->linear_velocity, {0.3, 0, 0}) > 1e-3);
    REQUIRE(frame.shafts.size() == 1);
    CHECK(frame.shafts[0].angle == scene.angle("wheel"));
    CHECK(frame.shafts[0].speed == 4);
}

TEST_CASE("a large frame, which is written past the caches, holds every bit of every body that is not static")
{
    Scene scene(R"(
      <component id="ball" type="Shape/Sphere" radius="0.1"/>
      <component id="static" type="State/Static" shape="ball" position="9 9 9"/>
      <component id="lump" type="State/RigidBody" mass="1" position="1 2 3" linear_velocity="0.3 0 0" angular_velocity="0 0 2">
        <component id="lump.shape" type="Shape/Placed" of="Shape/Sphere" of.radius="0.1" position="0.5 0 0"/>
      </component>
      <repeat id="row" count="40 30" step="1 1 0"><component id="b" type="State/RigidBody" mass="1" shape="ball"
              linear_velocity="0.1 -0.2 0.3" angular_velocity="1 2 -3"/></repeat>)");
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    Watched run(scene);
    run.step(7);
    const auto& frame = run.watcher.frame;
    REQUIRE(frame.bodies.size() == 1201);
    std::map<std::uint32_t, std::string> id_of;
    for (const auto& object : run.watcher.changes[0].objects) id_of[object.handle] = object.component_id;
    for (const auto& b : frame.bodies)
    {
        const std::string id = id_of.at(b.handle);
        CAPTURE(id);
        REQUIRE(distance(b.position, scene.vec(id, "position")) <= (id == "lump" ? 1e-14 : 0.0));
        REQUIRE(b.orientation == std::get<Quat>(scene.simulation().world().get(scene.simulation().world().find(id), "orientation")));
        // That of the frame's origin is computed where it is not the centre of mass.
        REQUIRE(distance(b.linear_velocity, scene.vec(id, "linear_velocity")) <= (id == "lump" ? 1e-14 : 0.0));
        REQUIRE(b.angular_velocity == scene.vec(id, "angular_velocity"));
        id_of.erase(b.handle);
    }
    CHECK(frame.bodies.front().angular_velocity != Vec3{});
}

TEST_CASE("frames: at their interval, while paused, for newcomers, and for no other readers")
{
    Scene scene(kDrop);
    Watched run(scene, kRarely);
    run.step(5);
    CHECK(run.watcher.frames == 1);
    run.ask(simulation::PushOperation{"ball", {0, 0, 1}, {}});
    CHECK(run.watcher.frames == 1);  // the next one comes at its interval
    run.ask(simulation::PauseOperation{});
    CHECK(run.watcher.frames == 2);
    CHECK(run.watcher.frame.step == 5);
    run.ask(simulation::PushOperation{"ball", {0, 0, 1}, {}});
    CHECK(run.watcher.frames == 3);
    run.ask(simulation::StepOperation{3});
    run.step(3);
    CHECK(run.watcher.frames == 4);  // that of the last of the three
    CHECK(run.watcher.frame.step == 8);
    run.collector.idle(scene.simulation());
    CHECK(run.watcher.frames == 4);
    run.watcher.joined = 1;
    run.collector.idle(scene.simulation());
    CHECK(run.watcher.frames == 5);
    run.watcher.wanted.erase(Stream::States);
    run.settle();
    CHECK(run.watcher.frames == 5);
    run.watcher.wanted.insert(Stream::States);
    run.collector.idle(scene.simulation());
    CHECK(run.watcher.frames == 6);
    CHECK(run.watcher.frame.sequence_number == 6);
}

TEST_CASE("collisions carry point, normal, impulse and depth, and have a stream of their own")
{
    Scene scene(kDrop);
    Watched run(scene);
    run.step(240);
    auto& batches = run.watcher.collision_batches;
    REQUIRE(!batches.empty());
    CHECK(run.watcher.event_batches.empty());
    REQUIRE(batches[0].entries.size() == 3);
    const auto& begin = batches[0].entries[0];
    const auto& impact = batches[0].entries[1];
    CHECK(std::string(begin.kind) == "begin");
    CHECK(std::string(impact.kind) == "impact");
    CHECK(std::string(batches[0].entries[2].kind) == "end");  // the contact has ended when the step ends
    CHECK(begin.time == impact.time);
    CHECK(impact.time == doctest::Approx(std::sqrt(2 * 0.4 / 9.81)).epsilon(1e-6));
    CHECK(batches[0].step == static_cast<Tick>(impact.time * 240));
    CHECK(impact.detector == "contact");
    CHECK(impact.a == "ball");
    CHECK(impact.b == "floor");
    // a is the ball: the normal points from it to the floor, and the impulse acts on the floor.
    CHECK(distance(impact.normal, {0, 0, -1}) < 1e-9);
    CHECK(impact.impulse.z == doctest::Approx(-1.5 * std::sqrt(2 * 9.81 * 0.4)).epsilon(1e-5));
    CHECK(distance(impact.position, {0, 0, 0}) < 1e-6);
    CHECK(std::fabs(impact.depth) < 1e-6);
    CHECK(begin.normal == impact.normal);
    CHECK(begin.position == impact.position);
    CHECK(begin.impulse == Vec3{});
    CHECK(check_numbers(batches, 1) == run.collector.last_collision() + 1);
}

TEST_CASE("numbers continue while there are no readers")
{
    Scene scene(kDrop);
    Watched run(scene, kAlways, {});
    run.step(120);
    const std::uint64_t missed = run.collector.last_collision();
    CHECK(missed >= 2);
    CHECK(run.watcher.collision_batches.empty());
    run.watcher.wanted = {Stream::Collisions, Stream::Events};
    run.step(240);
    CHECK(check_numbers(run.watcher.collision_batches, missed + 1) == run.collector.last_collision() + 1);
    run.collector.note(scene.simulation(), {"request.swap", "info", 0, "contact", "", "", "kept all", {1.5}});
    run.collector.note(scene.simulation(), {"request.set", "info", 0, "gravity", "", "", "", {}});
    REQUIRE(run.watcher.event_batches.size() == 2);
    CHECK(run.watcher.event_batches[0].sequence_number == 1);
    CHECK(run.watcher.event_batches[1].sequence_number == 2);
    CHECK(run.watcher.event_batches[0].entries[0].time == scene.simulation().time());
    CHECK(run.watcher.event_batches[0].entries[0].values == std::vector<double>{1.5});
    CHECK(run.collector.last_event() == 2);
}

TEST_CASE("metrics: figures of the run, and the work by component")
{
    Scene scene(kDrop);
    Watched run(scene);
    run.step(100);
    run.ask(simulation::PushOperation{"ball", {0, 0, 2}, {}});
    run.step(1);
    const wire::Metrics& m = run.watcher.samples.back();
    const simulation::Totals totals = scene.simulation().totals();
    CHECK(m.step == 101);
    CHECK(m.ledger.kinetic == totals.kinetic);
    CHECK(m.ledger.stored == totals.stored);
    CHECK(m.ledger.work == totals.work);
    CHECK(m.ledger.of_requests == scene.simulation().stepper().requests_work());
    CHECK(m.ledger.of_requests != 0);
    CHECK(m.ledger.unexplained == doctest::Approx(totals.kinetic - totals.work));
    CHECK(std::fabs(m.ledger.unexplained) < 1e-9);
    CHECK(m.step_ns > 0);
    const auto* contact = find_entry(m.interactions, "contact");
    REQUIRE(contact);
    CHECK(contact->requested == "CDetection/ODE");
    CHECK(contact->resolved == "CDetection/ODE: Resolution/Bisection (rewinds the whole world), Response/Impulse");
    CHECK(contact->cost_ns > 0);
    CHECK(contact->cost_ns < m.step_ns);
    CHECK(find_entry(m.interactions, "solver")->resolved ==
          "Solver/Automatic: 1 group, 1 object, by Exact (last choice: Exact: forces are uniform and no joints hold)");
    const auto* gravity = find_entry(m.interactions, "gravity");
    CHECK(gravity->resolved == "Field/Gravity");
    CHECK(gravity->work == scene.simulation().stepper().work()[scene.simulation().world().find("gravity")]);
    CHECK(parameter(find_entry(m.interactions, "contact.response")->outputs, "residual") != "none");

    run.ask(simulation::SwapOperation{"contact.response", "Response/None", {}});
    run.step();
    CHECK(
        find_entry(run.watcher.samples.back().interactions, "contact")->resolved.ends_with("Response/None (a sensor: applies no forces)"));
}

TEST_CASE("metrics at their interval, at once after a request, and for newcomers")
{
    Scene scene(kDrop);
    Watched run(scene, kRarely);
    run.step(50);
    CHECK(run.watcher.samples.size() == 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    run.ask(simulation::SetOperation{"gravity", "acceleration", std::string("0 0 -1")});
    CHECK(run.watcher.samples.size() == 2);
    const std::int64_t begin = publish::monotonic_now();
    for (int i = 0; i < 10; ++i) run.ask(simulation::SetOperation{"gravity", "acceleration", std::string("0 0 -2")});
    const auto fits = static_cast<std::size_t>((publish::monotonic_now() - begin) / 50'000'000);
    CHECK(run.watcher.samples.size() <= 3 + fits);
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    run.collector.idle(scene.simulation());
    const std::size_t now = run.watcher.samples.size();
    CHECK(now >= 3);
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    run.collector.idle(scene.simulation());
    CHECK(run.watcher.samples.size() == now);
    run.watcher.joined = 1;
    run.collector.idle(scene.simulation());
    CHECK(run.watcher.samples.size() == now + 1);
}

TEST_CASE("solvers: the groups that they advance, mixtures, and solvers without work")
{
    Scene scene(R"(
      <component id="solver" type="Solver/RungeKutta4"/>
      <component id="euler" type="Solver/SemiImplicitEuler"/>
      <component id="idle" type="Solver/SemiImplicitEuler"/>
      <component id="a" type="State/Shaft" inertia="1" solver="euler"/>
      <component id="b" type="State/Shaft" inertia="1"/>
      <component id="c" type="State/Shaft" inertia="1" solver="euler"/>
      <component id="gears" type="Constraint/AngularVelocity/Graph" driver="a" driven="b" velocity_factor="2"/>)");
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    scene.step();
    const auto& world = scene.simulation().world();
    const std::vector<std::string> resolved = publish::resolved_algorithms(scene.simulation());
    CHECK(resolved[world.find("solver")] == "Solver/RungeKutta4: 1 group, 2 objects; in 1 group some members name another solver");
    CHECK(resolved[world.find("euler")] ==
          "Solver/SemiImplicitEuler: 1 group, 1 object; 1 object that use it: Solver/RungeKutta4 (solver), "
          "of whose group they are members");
    CHECK(resolved[world.find("idle")] == "nothing: no moving object uses it");
    CHECK(resolved[world.find("a")].empty());
}

TEST_CASE("cheap rows of one type share its cost, and this is stated")
{
    Scene scene(R"(<component id="a" type="State/Shaft" inertia="1"/><component id="b" type="State/Shaft" inertia="1"/>
      <component id="x" type="Field/Drag" between="a" rotational="1"/><component id="y" type="Field/Drag" between="b" rotational="1"/>)");
    const auto& s = scene.simulation();
    const auto cost_of = [&](const char* id) { return simulation::ComponentCosts(s.world(), s.stepper().cost()).of(s.world().find(id)); };
    CHECK(cost_of("x").last.samples == 0);
    CHECK(cost_of("solver").last.samples == 0);
    scene.step(100);
    CHECK(cost_of("x").shared == 2);
    CHECK(cost_of("x").last.median == cost_of("y").last.median);
    CHECK(cost_of("x").last.median > 0);
    CHECK(cost_of("solver").shared == 1);
    const simulation::Spread solver = cost_of("solver").last;
    CHECK(solver.samples == 64);
    CHECK(solver.low > 0);
    CHECK(solver.low <= solver.median);
    CHECK(solver.median <= solver.high);
}

TEST_CASE("status: on change and once a second")
{
    Scene scene(kDrop);
    Watched run(scene);
    wire::Server status;
    status.scene_file = "a scene whose name is too long for the small string optimisation.xml";
    for (int i = 0; i < 100; ++i)
    {
        ++status.step, status.time += 0.1, status.rate_reached += 0.01, status.slipped += 1;
        run.collector.status(status);
    }
    CHECK(run.watcher.statuses.size() == 1);
    CHECK(run.watcher.statuses[0].step == 1);
    status.paused = true;
    run.collector.status(status);
    REQUIRE(run.watcher.statuses.size() == 2);
    CHECK(run.watcher.statuses[1].paused);
    status.requests_done = 1;
    run.collector.status(status);
    CHECK(run.watcher.statuses.size() == 3);
    run.collector.note(scene.simulation(), {"request.pause", "info", 0, "", "", "", "", {}});
    std::this_thread::sleep_for(std::chrono::milliseconds(1050));
    run.collector.status(status);
    REQUIRE(run.watcher.statuses.size() == 4);
    CHECK(run.watcher.statuses[3].last_event == 1);
}

TEST_CASE("a warm step allocates nothing: unwatched, and with frames")
{
    Scene scene(R"(<component id="form" type="Shape/Sphere" radius="0.1"/>
      <repeat id="balls" count="10 10" step="1 1 0 m"><component id="ball" type="State/RigidBody" mass="1" shape="form"/></repeat>
      <component id="gravity" type="Field/Gravity" between="balls"/>)");
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    for (const std::set<Stream>& wanted : {std::set<Stream>{}, std::set<Stream>{Stream::States, Stream::Collisions, Stream::Events}})
    {
        Watched run(scene, kAlways, wanted);
        run.step(5);
        CHECK(run.watcher.frame.bodies.size() == (wanted.empty() ? 0u : 100u));
        const simulation::Changes none;
        wire::Server status;
        status.scene_file = "a scene whose name is too long for the small string optimisation.xml";
        run.collector.status(status);
        const long before = allocations;
        for (int i = 0; i < 100; ++i)
        {
            run.collector.collect(scene.simulation(), none, true);
            run.collector.status(status);
        }
        CHECK(allocations - before == 0);
    }
}

TEST_CASE("frames are numbered for each observer: one that receives every tenth has missed none")
{
    Scene scene(kDrop);
    Watched run(scene);
    Watcher seldom;
    seldom.wanted = {Stream::States}, seldom.intervals[Stream::States] = 10 * scene.simulation().dt();
    run.collector.attach(seldom);
    std::uint64_t last = 0;
    for (int i = 0; i < 100; ++i)
    {
        run.step();
        if (i == 50) run.watcher.wanted.erase(Stream::States);
        if (i == 60) run.watcher.wanted.insert(Stream::States);
        CHECK(run.watcher.frame.sequence_number == run.watcher.frames);
        CHECK(seldom.frame.sequence_number == seldom.frames);
        CHECK(seldom.frame.sequence_number - last <= 1);
        last = seldom.frame.sequence_number;
    }
    CHECK(run.watcher.frames > 80);
    CHECK(seldom.frames < 20);
    CHECK(seldom.frames >= 10);
}

TEST_CASE("watching changes no bit")
{
    Scene plain(kDrop), watched(kDrop);
    Watched run(watched);
    plain.step(300);
    run.step(300);
    CHECK(run.watcher.samples.size() == 300);
    CHECK(plain.hash() == watched.hash());
}

TEST_CASE("metrics right after a rewind or a restore are marked unknown, instead of a step of 0 ns and a rate across the jump")
{
    Scene scene(kDrop);
    publish::Sampler sampler(0);
    const simulation::Snapshot kept = scene.simulation().capture();
    scene.step(100);
    CHECK(sampler.sample(scene.simulation(), 1'000'000'000).step_ns > 0);
    const simulation::Snapshot later = scene.simulation().capture();
    scene.step(100);
    const double honest = sampler.sample(scene.simulation(), 2'000'000'000).real_time_factor;
    CHECK(honest == doctest::Approx(100 * scene.simulation().dt()).epsilon(1e-9));
    for (const simulation::Snapshot* to : {&kept, &later})
    {
        REQUIRE(scene.simulation().restore(*to).ok());
        const wire::Metrics after = sampler.sample(scene.simulation(), 3'000'000'000);
        CHECK(after.step_ns == 0);
        CHECK(after.real_time_factor == 0);
        for (const wire::InteractionMetrics& m : after.interactions) CHECK(m.cost_ns == 0);
        scene.step(100);
        const wire::Metrics known = sampler.sample(scene.simulation(), 4'000'000'000);
        CHECK(known.step_ns > 0);
        CHECK(known.real_time_factor == doctest::Approx(honest).epsilon(1e-9));
    }
}

TEST_CASE("metrics describe their figures: quartiles, number of steps, components that share them, unit and meaning of the error")
{
    Scene scene(R"(<component id="a" type="State/Shaft" inertia="1" angular_velocity="1"/><component id="b" type="State/Shaft" inertia="1"/>
      <component id="x" type="Field/Drag" between="a b" rotational="1"/>
      <component id="mesh" type="Constraint/AngularVelocity/Assign" driver="a" driven="b" velocity_factor="2"/>)");
    scene.step(20);
    publish::Sampler sampler(0.5);
    wire::Metrics metrics;
    for (int i = 1; i < 8; ++i) metrics = sampler.sample(scene.simulation(), static_cast<publish::Nanoseconds>(i) << 40);
    const auto account = [&](const std::string& id, const std::string& name) -> const wire::Parameter*
    {
        for (const wire::InteractionMetrics& m : metrics.interactions)
            for (const wire::Parameter& p : m.outputs)
                if (m.component_id == id && p.kind == "account" && p.name == name) return &p;
        return nullptr;
    };
    REQUIRE(account("mesh", "error"));
    CHECK(account("mesh", "error")->unit == "rad/s2");
    CHECK(account("mesh", "error")->text == "per second of a step, against Constraint/AngularVelocity/Graph");
    REQUIRE(account("x", "no_error"));
    CHECK_FALSE(account("x", "error"));
    CHECK(account("x", "cost_steps")->text == "20");
    CHECK(account("x", "cost_shared_by")->text == "1");
    CHECK(account("x", "cost_quartiles")->unit == "ns");
}
