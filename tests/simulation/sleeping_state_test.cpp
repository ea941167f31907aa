// Sleep is state: it survives snapshots, rewinds, requests, aborted steps and any number of threads, and requests wake what they touch.
#include <algorithm>
#include <cmath>

#include "plab/interruption.h"
#include "simulation/sleeping.h"
#include "simulation/snapshot/format.h"
#include "support/allocation_counter.h"

using namespace plab;
using namespace plab::simulation;
using namespace plab::test;

namespace
{

const std::vector<std::string> kTowerIds = {"a0", "a1", "a2"};

/// Two towers, and a ball that comes down on one of them at 1.9 s, when they sleep.
std::string visited_towers() { return stack("a", 0, 3) + stack("b", 3, 3) + ball("late", {3, 0.1, 20}) + cube("far", {-4, 0, 0.25}); }

struct Sleepers : Scene
{
    explicit Sleepers(int threads = 1)
        : Scene(resting_scene(visited_towers(), "type=\"Manager/SoftStep\" sleep_after=\"0.3\""), "dt=\"1/120\"", threads)
    {
        REQUIRE_MESSAGE(loaded(), error());
    }
};

std::vector<std::uint64_t> hashes(Simulation& s, int steps)
{
    std::vector<std::uint64_t> out;
    for (int i = 0; i < steps; ++i) s.step(), out.push_back(s.state_hash());
    return out;
}

void require_same(Scene& s, Scene& plain, int steps)
{
    for (int i = 0; i < steps; ++i)
    {
        s.step(), plain.step();
        REQUIRE(s.hash() == plain.hash());
    }
}

AddBlueprintOperation addition(const std::string& body)
{
    return AddBlueprintOperation(blueprint::read_blueprint("<plab version=\"1\">" + body + "</plab>", "more.xml").take());
}

SetOperation setting(const std::string& id, const std::string& name, const std::string& value) { return {id, name, value}; }

}  // namespace

TEST_CASE("the number of threads makes no difference")
{
    Sleepers one, two(2), three(3);
    bool slept = false, woke = false;
    for (int i = 0; i < 420; ++i)
    {
        one.step(), two.step(), three.step();
        REQUIRE(one.hash() == two.hash());
        REQUIRE(one.hash() == three.hash());
        slept = slept || asleep(one) == 7, woke = woke || (slept && asleep(one) < 7);
    }
    CHECK(slept);
    CHECK(woke);
}

TEST_CASE("a run continues from a snapshot to the same bits, from before, within and after sleep")
{
    Sleepers s;
    for (const double at : {0.25, 1.0, 1.6, 2.05})
    {
        CAPTURE(at);
        s.run(at);
        const Snapshot memory = s.simulation().capture();
        const auto bytes = encode(memory);
        REQUIRE(bytes.ok());
        auto file = decode(*bytes, library());
        REQUIRE_MESSAGE(file.ok(), reasons(file));
        Simulation other(library(), 2), third(library());
        REQUIRE(other.restore(file->snapshot).ok());
        REQUIRE(third.restore(memory).ok());
        CHECK(other.state_hash() == s.hash());
        const auto expected = hashes(s.simulation(), 40);
        CHECK(hashes(other, 40) == expected);
        CHECK(hashes(third, 40) == expected);
        CHECK(other.events().size() == s.simulation().events().size());
    }
}

TEST_CASE("a rewind finds them asleep")
{
    Sleepers s;
    s.simulation().history().configure({0.5});
    s.run(1.5);
    REQUIRE(asleep(s) == 7);
    const std::uint64_t hash = s.hash();
    s.run(2.6);
    REQUIRE(asleep(s) < 7);
    REQUIRE(s.ask(RewindOperation{1.5, false}).done);
    CHECK(asleep(s) == 7);
    CHECK(s.hash() == hash);
}

TEST_CASE("an aborted step leaves no trace in them")
{
    Sleepers s, plain;
    for (int i = 0; i < 330; ++i)
    {
        plain.step();
        if (i % 7 == 0)
        {
            Interruption now;
            now.ask();
            s.simulation().set_interruption(&now);
            CHECK_FALSE(s.simulation().step());
            s.simulation().set_interruption(nullptr);
        }
        Interruption never;
        s.simulation().set_interruption(&never);
        s.step();
        s.simulation().set_interruption(nullptr);
        REQUIRE(s.hash() == plain.hash());
    }
}

TEST_CASE("a swap for the same manager changes no bit and wakes nobody; another one takes over where they were")
{
    Sleepers s, plain;
    s.run(1.2), plain.run(1.2);
    REQUIRE(asleep(s) == 7);
    s.keep_events = true;
    REQUIRE(s.ask(SwapOperation{"manager", "Manager/SoftStep", {}}).done);
    REQUIRE(s.ask(SwapOperation{"contact.response", "Response/Rows", {}}).done);
    require_same(s, plain, 150);

    Sleepers other;
    other.run(1.2);
    other.keep_events = true;
    const auto there = places_of(other, kTowerIds);
    REQUIRE(other.ask(SwapOperation{"manager", "Manager/Direct", {}}).done);
    CHECK(places_of(other, kTowerIds) == there);
    other.step();
    CHECK(other.count("island.awake") == 3);
    CHECK(asleep(other) == 0);
    other.run(1.4);
    for (std::size_t k = 0; k < kTowerIds.size(); ++k) CHECK(length(other.vec(kTowerIds[k], "position") - there[k].position) < 2e-3);
    CHECK_FALSE(other.ask(SwapOperation{"manager", "Manager/Nothing", {}}).done);
}

TEST_CASE("a refused request leaves them asleep")
{
    Sleepers s, plain;
    s.run(1.2), plain.run(1.2);
    CHECK_FALSE(s.ask_all({setting("a0", "mass", "2"), RemoveOperation{"nothing"}}).done);
    CHECK_FALSE(s.ask_all({addition(cube("more", {9, 9, 9})), RemoveOperation{"nothing"}}).done);
    require_same(s, plain, 150);
}

TEST_CASE("requests wake what they touch, and what depends on it")
{
    struct Asked
    {
        const char* what;
        Operation operation;
        std::int64_t left;  // asleep afterwards, of 7
    };
    const Asked all[] = {
        {"a push", PushOperation{"a1", {0, 0, 1e-3}, {}}, 4},
        {"a speed", setting("b0", "linear_velocity", "0 0 1e-9"), 4},
        {"a place", setting("far", "position", "-4 0 0.26"), 6},
        {"a mass", setting("a2", "mass", "3"), 4},
        {"gravity", setting("g", "acceleration", "0 0 -1"), 0},
        {"a field", addition("<component id=\"wind\" type=\"Field/Drag\" between=\"a2\" linear=\"0.1\"/>"), 4},
        {"a uniform force", addition("<component id=\"load\" type=\"Field/Load\" between=\"far\" force=\"0 0 1\"/>"), 6},
        {"a spring", addition("<component id=\"s\" type=\"Constraint/SpringDamper\" a=\"a2\" b=\"b2\" length=\"3\" stiffness=\"10\"/>"), 1},
        {"friction", setting("contact.response", "friction", "0.5"), 0},
        {"a removed support", RemoveOperation{"a1"}, 4},
        {"a wall", addition("<component id=\"wall\" type=\"State/Static\" shape=\"cube\" position=\"20 0 0\"/>"), 0},
        {"a shape", setting("cube", "half_extents", "0.25 0.25 0.2501"), 0},
        {"a body elsewhere", addition(cube("more", {9, 9, 3})), 7},
        {"a shaft elsewhere", addition("<component id=\"shaft\" type=\"State/Shaft\" inertia=\"1\"/>"), 7},
        {"sleep_after", setting("manager", "sleep_after", "0"), 0},
    };
    for (const Asked& asked : all)
    {
        CAPTURE(asked.what);
        Sleepers s;
        s.run(1.2);
        REQUIRE(asleep(s) == 7);
        const Reply reply = s.ask(asked.operation);
        REQUIRE_MESSAGE(reply.done, first_error(reply.errors));
        s.step();
        CHECK(asleep(s) == asked.left);
    }
    Sleepers s;
    s.run(1.2);
    REQUIRE(s.ask(RemoveOperation{"a0"}).done);
    s.run(1.6);
    CHECK(s.vec("a1", "position").z < 0.5);
}

TEST_CASE("a script that changes a force wakes what feels it")
{
    Scene s(resting_scene(visited_towers(), "type=\"Manager/SoftStep\" sleep_after=\"0.3\"") +
                "<component id=\"script\" type=\"Script/Lua\" driven=\"late\"><param name=\"code\">"
                "function drive(step) if step.tick == 150 then set(\"g\", \"acceleration\", vec(0, 0, -5)) end end</param></component>",
            "dt=\"1/120\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(150);
    REQUIRE(asleep(s) == 7);
    s.step();
    CHECK(asleep(s) == 0);
}

TEST_CASE("ten thousand sleepers cost next to nothing, and a ball wakes the one that it hits")
{
    std::string bodies;
    for (int i = 0; i < 100; ++i)
        for (int k = 0; k < 100; ++k) bodies += cube("c" + std::to_string(100 * i + k), {0.8 * i, 0.8 * k, 0.25});
    Scene s(resting_scene(bodies, "type=\"Manager/SequentialImpulse\" sleep_after=\"0.2\""), "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(30);
    REQUIRE(asleep(s) == 10000);
    REQUIRE(s.ask(addition(ball("thrown", {0.8 * 50, 0.8 * 50, 3}))).done);
    s.step(4);
    const long before = allocations;
    s.step(4);
    CHECK(allocations - before == 0);
    for (int i = 0; i < 16; ++i)
    {
        s.step();
        CHECK(s.simulation().stepper().report().visited < 10);
        CHECK(s.simulation().stepper().report().evaluations < 10);
    }
    s.step(30);
    CHECK(asleep(s) == 9999);
    CHECK_FALSE(is_asleep(s, "c5050"));
}

TEST_CASE("it is told what keeps islands awake")
{
    const std::string hung = cube("hung", {5, 0, 3}) + "<component id=\"joint\" type=\"Constraint/Hinge\" b=\"hung\" anchor=\"5 0 4\"/>";
    Scene s(resting_scene(stack("a", 0, 2) + hung), "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(2);
    CHECK(std::get<std::string>(s.get("manager", "sleep_reason")).starts_with("1 bodies stay awake: joints"));
    REQUIRE(s.ask(SwapOperation{"contact.resolution", "Resolution/LocalRoot", {}}).done);
    s.step(2);
    CHECK(asleep(s) == 0);
    CHECK(std::get<std::string>(s.get("manager", "sleep_reason")) == "contact keeps everything awake: it locates impacts inside the step");
    REQUIRE(s.ask(SwapOperation{"contact.resolution", "Resolution/Speculative", {}}).done);
    s.run(s.simulation().time() + 1.5);
    CHECK(asleep(s) == 2);
}

namespace
{

std::string defaults(const std::string& bodies, const std::string& more = "")
{
    return "<component id=\"g\" type=\"Field/Gravity\" between=\"*\"/>"
           "<component id=\"cube\" type=\"Shape/Box\" half_extents=\"0.25 0.25 0.25\"/>" +
           std::string(kGround) + bodies + "<component id=\"contact\" type=\"CDetection/ODE\" between=\"*\" " + more + "/>";
}

std::int64_t asleep_by_default(const Scene& s) { return std::get<std::int64_t>(s.get("contact.response.manager", "asleep")); }

}  // namespace

TEST_CASE("the defaults let a large group sleep, not a few exact bodies")
{
    for (const int high : {3, 12})
    {
        CAPTURE(high);
        Scene s(defaults(stack("a", 0, high)), "dt=\"1/120\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(4);
        CHECK(asleep_by_default(s) == (high > 8 ? high : 0));
    }
}

TEST_CASE("by default only what is at rest but for rounding sleeps, so a wake shows nothing of it")
{
    Scene s(defaults(stack("a", 0, 12)), "dt=\"1/120\""),
        never(defaults(stack("a", 0, 12), "response.manager.sleep_after=\"0\""), "dt=\"1/120\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    REQUIRE_MESSAGE(never.loaded(), never.error());
    s.run(20), never.run(20);
    REQUIRE(asleep_by_default(s) == 12);
    REQUIRE(asleep_by_default(never) == 0);
    for (Scene* one : {&s, &never}) REQUIRE(one->ask(PushOperation{"a11", {0.01, 0, 0}, {}}).done);
    s.step(), never.step();
    CHECK(asleep_by_default(s) == 0);
    s.run(20.5), never.run(20.5);
    double apart = 0;
    for (int k = 0; k < 12; ++k)
        apart = std::max(apart, length(s.vec("a" + std::to_string(k), "position") - never.vec("a" + std::to_string(k), "position")));
    CHECK(apart < 2e-8);  // sleep_speed for 20 s
}

TEST_CASE("by default nothing that still moves sleeps, however slowly")
{
    // Nine cubes in a row glide over smooth ground by a micrometre each second.
    std::string row;
    for (int k = 0; k < 9; ++k) row += cube("a" + std::to_string(k), {0.5 * k, 0, 0.25}, "linear_velocity=\"1e-6 0 0\"");
    Scene s(defaults(row, "response.friction=\"0\""), "dt=\"1/120\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(3);
    CHECK(asleep_by_default(s) == 0);
    CHECK(std::fabs(s.vec("a4", "position").x - (2 + 3e-6)) < 1e-12);
}
