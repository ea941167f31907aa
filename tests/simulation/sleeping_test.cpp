// Islands at rest sleep, wake where they were, and nothing else does either.
#include <algorithm>
#include <cmath>

#include "simulation/sleeping.h"

using namespace plab;
using namespace plab::simulation;
using namespace plab::test;

namespace
{

const std::vector<std::string> kTower = {"a0", "a1", "a2", "a3"}, kOther = {"b0", "b1", "b2", "b3"};

std::string towers() { return stack("a", 0, 4) + stack("b", 3, 4); }

/// J: what methods have lost or made, apart from what the contacts say they have created.
double unaccounted(const Scene& s)
{
    const Totals totals = s.simulation().totals();
    double created = 0;
    for (const ContactEnergy& e : s.simulation().stepper().contact_energy()) created += e.created;
    return totals.kinetic - s.simulation().kinetic_at_start() - totals.work - created;
}

const Event& only(const Scene& s, const std::string& kind)
{
    REQUIRE(s.count(kind) == 1);
    return *std::find_if(s.events.begin(), s.events.end(), [&](const Event& e) { return e.kind == kind; });
}

SetOperation set(const std::string& id, const std::string& name, const std::string& value) { return {id, name, value}; }

AddBlueprintOperation adds(const std::string& body)
{
    return AddBlueprintOperation(blueprint::read_blueprint("<plab version=\"1\">" + body + "</plab>", "more.xml").take());
}

}  // namespace

TEST_CASE("towers fall asleep: no speed is left, and a step costs and changes nothing")
{
    Scene s(resting_scene(towers()), "dt=\"1/120\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    for (int i = 0; i < 600 && asleep(s) < 8; ++i) s.step();
    REQUIRE(asleep(s) == 8);
    CHECK(s.simulation().totals().kinetic == 0);
    CHECK(s.simulation().totals().momentum == Vec3{});
    CHECK(s.count("island.asleep") == 2);
    for (const Event& e : s.events)
        if (e.kind == "island.asleep") CHECK(e.values[0] == 4);
    // From here on a step changes nothing.
    const std::uint64_t hash = s.hash();
    s.step(200);
    CHECK(s.hash() == hash);
    CHECK(s.simulation().stepper().report().swept_rows == 0);
    CHECK(s.simulation().stepper().report().resting_pairs == 8);
}

TEST_CASE("an island wakes exactly where it was, and goes on as one that never slept")
{
    for (const char* manager : {"Direct", "SoftStep", "SequentialImpulse"})
    {
        CAPTURE(manager);
        const std::string type = "type=\"Manager/" + std::string(manager) + "\"";
        Scene s(resting_scene(towers(), type + " sleep_after=\"0.5\""), "dt=\"1/120\"");
        Scene never(resting_scene(towers(), type), "dt=\"1/120\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        for (int i = 0; i < 1200 && asleep(s) < 8; ++i) s.step(), never.step();
        REQUIRE(asleep(s) == 8);
        const std::vector<Place> there = places_of(s, kTower);
        for (int i = 0; i < 600; ++i) s.step(), never.step();
        CHECK(places_of(s, kTower) == there);
        CHECK(s.ask(PushOperation{"a3", {0, 0, 1e-6}, {}}).done);
        CHECK(never.ask(PushOperation{"a3", {0, 0, 1e-6}, {}}).done);
        CHECK(places_of(s, kTower) == there);
        s.step(), never.step();
        CHECK(only(s, "island.awake").values[0] == 4);
        CHECK(asleep(s) == 4);
        double apart = 0, faster = 0;
        for (int i = 0; i < 60; ++i)
        {
            for (const std::string& id : kTower)
            {
                apart = std::max(apart, length(s.vec(id, "position") - never.vec(id, "position")));
                faster = std::max(faster, length(s.vec(id, "linear_velocity") - never.vec(id, "linear_velocity")));
            }
            s.step(), never.step();
        }
        // While it sleeps it misses the drift of the other one, which is at most sleep_speed; here they are far less.
        CHECK(apart < 2e-4);
        CHECK(faster < 2e-3);
    }
}

TEST_CASE("a ball that is thrown at a tower wakes it, and no other")
{
    Scene s(resting_scene(towers()), "dt=\"1/120\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(4);
    REQUIRE(asleep(s) == 8);
    const std::vector<Place> there = places_of(s, kTower), other = places_of(s, kOther);
    s.keep_events = true;
    REQUIRE(s.ask(adds(ball("thrown", {-2, 0, 1.5}, "linear_velocity=\"8 0 0\""))).done);
    int steps = 0;
    while (asleep(s) == 8 && steps++ < 120)
    {
        CHECK(places_of(s, kTower) == there);
        s.step();
    }
    CHECK(places_of(s, kTower) == there);  // it is awake, but the ball has only touched it
    CHECK(s.simulation().world().id_of(only(s, "island.awake").b) == "thrown");
    s.run(s.simulation().time() + 0.5);
    CHECK(s.vec("a2", "position").x > there[2].position.x + 0.01);
    CHECK(places_of(s, kOther) == other);
    CHECK(asleep(s) == 4);
    CHECK(s.count("island.awake") == 1);
}

TEST_CASE("nothing sleeps in flight, however slow")
{
    // In weak gravity both stay below sleep_speed all the time: a ball by itself, and two that touch each other.
    const std::string flyers = ball("one", {0, 0, 1}, "linear_velocity=\"0 0 0.004\"") +
                               ball("two", {2, 0, 1}, "linear_velocity=\"0 0 0.004\"") +
                               ball("three", {2, 0, 1.19999}, "linear_velocity=\"0 0 0.004\"");
    Scene s(resting_scene(flyers), "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    REQUIRE(s.ask(set("g", "acceleration", "0 0 -0.001")).done);
    for (int i = 0; i < 480; ++i)
    {
        s.step();
        REQUIRE(asleep(s) == 0);
    }
    const double t = s.simulation().time();
    CHECK(std::fabs(s.vec("one", "position").z - (1 + 0.004 * t - 0.0005 * t * t)) < 1e-6);
    // Without gravity their speed does not even change.
    REQUIRE(s.ask(set("g", "acceleration", "0 0 0")).done);
    for (int i = 0; i < 240; ++i)
    {
        s.step();
        REQUIRE(asleep(s) == 0);
    }
}

TEST_CASE("nothing sleeps at a turning point on a slope")
{
    // The floor leans by 0.05 rad. The ball rolls up and down again: a = 5/7 g sin 0.05, and |v| < sleep_speed for seconds.
    const double g = 0.05, slope = 0.05, a = 5.0 / 7 * g * std::sin(slope);
    Scene s(resting_scene(ball("one", {0, 0, 0.1}, "linear_velocity=\"0.02 0 0\" angular_velocity=\"0 0.2 0\""),
                          "type=\"Manager/Direct\" sleep_after=\"0.5\""),
            "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    REQUIRE(s.ask(set("g", "acceleration", text(Vec3{-g * std::sin(slope), 0, -g * std::cos(slope)}))).done);
    const double back = 2 * 0.02 / a;
    while (s.simulation().time() < back)
    {
        s.step();
        REQUIRE(asleep(s) == 0);
    }
    const double t = s.simulation().time();
    CHECK(std::fabs(s.vec("one", "position").x - (0.02 * t - a / 2 * t * t)) < 2e-3);
}

TEST_CASE("what hangs from a joint or rides on a swing or a platform stays awake")
{
    const std::string swing = cube("seat", {0, 0, 2}) + "<component id=\"joint\" type=\"Constraint/Hinge\" b=\"seat\" anchor=\"0 0 4\" " +
                              "axis=\"0 1 0\"/>" + cube("rider", {0, 0, 2.5}) +
                              "<component id=\"lift\" type=\"State/Kinematic\" shape=\"cube\" position=\"5 0 0.5\"/>" +
                              cube("passenger", {5, 0, 1}) + cube("alone", {9, 0, 0.25}) + cube("gate", {13, 0, 0.25}) +
                              "<component id=\"post\" type=\"Constraint/Hinge\" b=\"gate\" anchor=\"13 0 0\"/>";
    Scene s(resting_scene(swing, "type=\"Manager/Direct\" sleep_after=\"0.5\""), "dt=\"1/120\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    s.run(4);
    CHECK(asleep(s) == 1);
    CHECK(is_asleep(s, "alone"));
    CHECK(s.count("island.asleep") == 1);
}

TEST_CASE("what slides stays awake above the bounds of speed and acceleration, and sleeps below")
{
    // Friction 0.6 on a floor that leans by `lean`: the cube accelerates by g (sin - 0.6 cos).
    const auto sliding = [](double lean, double speed, double g)
    {
        auto s = std::make_unique<Scene>(resting_scene(cube("one", {0, 0, 0.25}, "linear_velocity=\"" + text(Vec3{-speed, 0, 0}) + "\""),
                                                       "type=\"Manager/Direct\" sleep_after=\"0.5\""),
                                         "dt=\"1/60\"");
        REQUIRE_MESSAGE(s->loaded(), s->error());
        s->keep_events = true;
        REQUIRE(s->ask(set("g", "acceleration", text(Vec3{-g * std::sin(lean), 0, -g * std::cos(lean)}))).done);
        s->run(3);
        return s;
    };
    const double balanced = std::atan(0.6);
    CHECK(asleep(*sliding(balanced, 0.02, 9.81)) == 0);
    // Slower than sleep_speed it is stopped. The energy that it loses is in the ledger.
    const auto stopped = sliding(balanced, 0.005, 9.81);
    CHECK(asleep(*stopped) == 1);
    CHECK(stopped->simulation().totals().kinetic == 0);
    CHECK(std::fabs(only(*stopped, "island.asleep").values[1] - 0.5 * 0.005 * 0.005) < 1e-8);
    CHECK(std::fabs(unaccounted(*stopped)) < 1e-9);
    // From rest, so slow at first that it is below sleep_speed for half a second.
    const double lean = std::asin(std::sin(balanced)) + 1e-3, a = 9.81 * (std::sin(lean) - 0.6 * std::cos(lean));
    const auto creeping = sliding(lean, 0, 9.81);
    CHECK(asleep(*creeping) == 0);
    CHECK(std::fabs(creeping->vec("one", "position").x + a / 2 * 9) < 0.02 * a / 2 * 9);
    CHECK(asleep(*sliding(balanced - 0.01, 0, 9.81)) == 1);
}

TEST_CASE("an exclusion wakes those that it parts, and its removal those that meet again")
{
    Scene s(resting_scene(towers()), "dt=\"1/120\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = true;  // the cubes come back inside one another
    for (int i = 0; i < 600 && asleep(s) < 8; ++i) s.step();
    REQUIRE(asleep(s) == 8);
    // The third cube falls into the second one as far as the first, on which it comes to rest; so the fourth stays on it.
    REQUIRE(s.ask(adds("<component id='apart' type='Collision/Exclude' within='a1 a2'/>")).done);
    for (int i = 0; i < 600 && (i < 2 || asleep(s) < 8); ++i) s.step();
    REQUIRE(asleep(s) == 8);
    CHECK(std::fabs(s.vec("a2", "position").z - s.vec("a1", "position").z) < 2e-3);
    const double before = distance(s.vec("a1", "position"), s.vec("a2", "position"));
    REQUIRE(s.ask(RemoveOperation{"apart"}).done);
    s.step(5);
    CHECK(asleep(s) < 8);
    CHECK(distance(s.vec("a1", "position"), s.vec("a2", "position")) > before + 1e-3);
}
