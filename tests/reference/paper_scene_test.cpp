// The paper's scene: its results, and that both forms of the blueprint are equivalent.
#include "support/scene.h"

using namespace plab;
using plab::test::distance;
using plab::test::near;
using plab::test::Scene;

namespace
{
/// From runs at dt = 1/240, 1/480 and 1/960, which agree in all of these digits.
constexpr double kCollisionTime = 3.286392711;  // s
}  // namespace

TEST_CASE("motor, gears, fan and balloons move as in the paper")
{
    Scene s = Scene::file("scenes/fan_and_balloons.xml");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    const Vec3 green = s.vec("green", "position"), red = s.vec("red", "position");
    Vec3 momentum_before;
    while (s.count("contact.impact") == 0 && s.simulation().time() < 10)
    {
        momentum_before = s.simulation().totals().momentum;
        CHECK(s.vec("green", "position") == green);
        s.step();
        // Gear ratios hold at every step: axle to gear the same, gear to gear reversed and halved.
        CHECK(s.spin("small_gear") == s.spin("axle"));
        CHECK(near(s.spin("large_gear"), -0.5 * s.spin("small_gear"), 1e-15));
        CHECK(near(s.spin("fan"), 0.5 * s.spin("axle"), 1e-15));
    }
    REQUIRE(s.count("contact.impact") == 1);
    for (const Event& e : s.events)
        if (e.kind == "contact.impact") CHECK(e.time == doctest::Approx(kCollisionTime).epsilon(1e-6));
    CHECK(s.vec("red", "position").x > red.x + 0.4);
    // The impact itself changes no momentum; the wind adds the momentum of one step.
    CHECK(distance(s.simulation().totals().momentum, momentum_before) < 0.02 * 1.0 / 240);
    s.run(10);
    CHECK(s.count("contact.impact") == 1);
    CHECK(length(s.vec("green", "linear_velocity")) > 0.05);
    CHECK(length(s.vec("red", "linear_velocity")) > 0.01);
    CHECK(s.vec("green", "position").x > green.x + 0.5);
    // Both leave the line on which they met, to opposite sides.
    CHECK(s.vec("green", "linear_velocity").y > 0.005);
    CHECK(s.vec("red", "linear_velocity").y < 0);
}

TEST_CASE("the ledger explains the kinetic energy")
{
    Scene s = Scene::file("scenes/fan_and_balloons.xml");
    s.run(10);
    const auto t = s.simulation().totals();
    CHECK(std::fabs(t.kinetic - s.simulation().kinetic_at_start() - t.work) < 1e-9 * t.kinetic);
}

TEST_CASE("the short and the long form give the same hash")
{
    Scene brief = Scene::file("scenes/fan_and_balloons.xml"), full = Scene::file("scenes/paper/fan_and_balloons.xml");
    REQUIRE_MESSAGE(full.loaded(), full.error());
    CHECK(brief.hash() == full.hash());
    brief.run(5), full.run(5);
    CHECK(brief.hash() == full.hash());
}

TEST_CASE("the paper's listings load and run")
{
    for (const char* name : {"listing-2", "listing-4", "listing-6", "listing-7"})
    {
        Scene s = Scene::file(std::string("scenes/paper/") + name + ".xml");
        CHECK_MESSAGE(s.loaded(), name, ": ", s.error());
        if (s.loaded()) s.step(10);
    }
}
