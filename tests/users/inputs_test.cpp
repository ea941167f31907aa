// Requests that set nothing but inputs: the same as a transaction, at a cost that does not depend on the scene.
#include <algorithm>
#include <chrono>

#include "plab/rotation.h"
#include "support/ball.h"
#include "users/hands.h"

using namespace plab;
using namespace plab::test;

namespace
{

Sample wave(std::int64_t number)
{
    const double t = 0.01 * static_cast<double>(number);
    return {number, {std::sin(t), 0.5 * t, 0.3}, exp_rotation({0, 0, t}), {std::cos(t), 0.5, 0}, {0, 0, 1}, 0.5, 0.002, number % 4};
}

std::string many_bodies(int n)
{
    std::string scene = hand();
    for (int i = 0; i < n; ++i)
        scene += "<component id='b" + std::to_string(i) + "' type='State/RigidBody' mass='1' inertia='1 1 1' position='" +
                 std::to_string(i % 100) + " " + std::to_string(i / 100) + " 9'/>";
    return scene;
}

/// s: the shortest of many requests, so that what else the machine does counts little.
double cost_of_inputs(const std::string& text)
{
    Scene scene(text);
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    double least = 1;
    for (std::int64_t i = 1; i <= 2000; ++i)
    {
        simulation::Request request;
        request.operations = sets_of(wave(i));
        const auto begin = std::chrono::steady_clock::now();
        const auto reply = scene.simulation().carry_out_now(request);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        REQUIRE(reply.done);
        least = std::min(least, took.count());
    }
    return least;
}

}  // namespace

TEST_CASE("inputs that are set alone give the same states as in a transaction")
{
    const std::string text = hand() + kBall;
    Scene fast(text), slow(text);
    for (std::int64_t i = 1; i <= 100; ++i)
    {
        send(fast, wave(i));
        std::vector<simulation::Operation> operations = sets_of(wave(i));
        operations.push_back(simulation::SetOperation{"hand", "speed_limit", Value(20.0)});  // a parameter: needs a transaction
        CHECK(slow.ask_all(operations).done);
        CHECK(fast.hash() == slow.hash());
        fast.step(), slow.step();
        CHECK(fast.hash() == slow.hash());
    }
    CHECK(distance(fast.vec("hand", "position"), {0, 0, 0}) > 0.5);  // it has moved
}

TEST_CASE("a refused input changes nothing, and is refused in the same words as by a transaction")
{
    Scene scene(hand());
    send(scene, wave(1));
    scene.step();
    const std::uint64_t before = scene.hash();
    std::vector<simulation::Operation> operations = sets_of(wave(2));
    operations.push_back(simulation::SetOperation{"hand", "grip", Value(1.5)});
    const auto fast = scene.ask_all(operations);
    CHECK_FALSE(fast.done);
    CHECK(scene.hash() == before);
    operations.push_back(simulation::SetOperation{"hand", "speed_limit", Value(20.0)});
    const auto slow = scene.ask_all(operations);
    CHECK_FALSE(slow.done);
    CHECK(first_error(fast.errors) == first_error(slow.errors));
    CHECK(scene.hash() == before);
}

TEST_CASE("inputs change neither the revision nor the structure, and have no trial")
{
    Scene scene(hand() + kBall);
    (void)scene.simulation().take_changes();
    const auto revision = scene.simulation().revision();
    const auto reply = scene.ask_all(sets_of(wave(1)));
    CHECK(reply.done);
    CHECK(reply.trial.outcome == simulation::TrialReport::Outcome::None);
    CHECK(scene.simulation().revision() == revision);
    const simulation::Changes changes = scene.simulation().take_changes();
    CHECK_FALSE(changes.everything);
    CHECK(changes.touched.empty());
    CHECK(changes.by_scripts.size() == 1);  // what shows values learns of it, at a rate of its own
}

TEST_CASE("inputs given as text, as the bus does, are parsed by the field's own rules")
{
    Scene scene(hand());
    CHECK(scene
              .ask_all({simulation::SetOperation{"hand", "target_position", std::string("1 2 300 mm")},
                        simulation::SetOperation{"hand", "present", std::string("true")},
                        simulation::SetOperation{"hand", "sample", std::string("7")}})
              .done);
    CHECK(scene.vec("hand", "target_position") == Vec3{0.001, 0.002, 0.3});
    const auto reply = scene.ask(simulation::SetOperation{"hand", "sample", std::string("half")});
    CHECK_FALSE(reply.done);
}

TEST_CASE("a rewind repeats the inputs, bit for bit")
{
    Scene scene(hand() + kBall);
    simulation::HistoryOptions history;
    history.interval = 0.1;
    scene.simulation().history().configure(history);
    const auto spec = compile_text(whole_scene(hand() + kBall, "dt='1/240'"));
    REQUIRE(scene.simulation().load(*spec).ok());
    std::vector<std::uint64_t> hashes;
    for (std::int64_t i = 1; i <= 120; ++i)
    {
        if (i % 3 != 0) send(scene, wave(i));
        scene.step();
        hashes.push_back(scene.hash());
    }
    REQUIRE(scene.simulation().rewind(70.0 / 240).ok());
    CHECK(scene.hash() == hashes[69]);
    REQUIRE(scene.simulation().rewind(33.0 / 240).ok());
    CHECK(scene.hash() == hashes[32]);
}

TEST_CASE("a component that was taken out of the step is tried again when an input is set")
{
    Scene scene(hand());
    scene.simulation().world().quarantine(scene.simulation().world().find("hand"), true);
    send(scene, wave(1));
    CHECK_FALSE(scene.simulation().world().component(scene.simulation().world().find("hand")).quarantined);
}

TEST_CASE("nine inputs cost microseconds, whatever the size of the scene")
{
    const double small = cost_of_inputs(many_bodies(10)), large = cost_of_inputs(many_bodies(10000));
    MESSAGE("nine inputs: ", 1e6 * small, " us with 10 bodies, ", 1e6 * large, " us with 10,000");
    CHECK(large < 50e-6);
    CHECK(large < 4 * small);
}
