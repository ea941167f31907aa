// Bodies that pass within a step, graze, or spin: no contact is missed, and times are accurate. C10 as in the catalogue.
#include <algorithm>

#include "impacts.h"
#include "support/random_poses.h"

using namespace plab;
using namespace plab::test;

namespace
{
const char* const kCertifying[] = {"LocalRoot", "ConservativeAdvancement"};
}  // namespace

TEST_CASE("C10: a bullet of 1 mm at 1000 m/s meets paper of 0.1 mm, 16.7 m per step")
{
    for (const char* resolution : kCertifying)
    {
        CAPTURE(resolution);
        Scene s(sphere("bullet", 1e-3, at({0, 0, 0}, {1000, 0, 0}, 1e-3)) +
                    box("paper", {5e-5, 1, 1}, "position=\"" + text(Vec3{1.2345 + 5e-5, 0, 0}) + "\"", "Static") +
                    contact("bullet paper", resolution, "0.5"),
                "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        s.step();
        const auto impacts = events_of(s, "contact.impact");
        REQUIRE(impacts.size() == 1);
        CHECK(std::fabs(impacts[0].time - (1.2345 - 1e-3) / 1000) < 1e-13);
        CHECK(near(s.vec("bullet", "linear_velocity").x, -500, 1e-13));
        CHECK(near(s.vec("bullet", "position").x, 1.2335 - 500 * (1.0 / 60 - 1.2335e-3), 1e-12));
    }
}

TEST_CASE("C10: a thousand sheets in one step are hit in order, each at its time")
{
    std::string sheets, all;
    for (int i = 0; i < 1000; ++i)
    {
        const std::string id = "s" + std::to_string(10000 + (i * 617) % 1000);  // ids in another order than places
        sheets += box(id, {5e-5, 1, 1}, "position=\"" + text(Vec3{1 + 1e-3 * i + 5e-5, 0, 0}) + "\"", "Static");
        all += id + " ";
    }
    Scene s(sphere("bullet", 1e-3, at({0, 0, 0}, {1000, 0, 0}, 1e-3)) + sheets + sensor("bullet", "LocalRoot", all), "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    s.step();
    const auto begins = events_of(s, "contact.begin");
    REQUIRE(begins.size() == 1000);
    double worst = 0;
    for (int i = 0; i < 1000; ++i)
        worst = std::max(worst, std::fabs(begins[static_cast<std::size_t>(i)].time - (1 + 1e-3 * i - 1e-3) / 1000));
    CHECK(worst < 1e-13);
    CHECK(near(s.vec("bullet", "linear_velocity").x, 1000, 1e-15));
}

TEST_CASE("C10: random shots at a moving ball: the number of hits follows from the geometry")
{
    // Sensor shots: whether the line of a sphere meets a static ball is known in closed form, grazing ones included.
    std::uint64_t seed = 7;
    int wrong = 0;
    double worst = 0;
    Scene s(sphere("bullet", 1e-3, at({0, 0, 0}, {1000, 0, 0}, 1e-3)) + sphere("target", 0.05, at({}), "RigidBody") +
                sensor("bullet target", "LocalRoot"),
            "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    for (int shot = 0; shot < 4000; ++shot)
    {
        const Vec3 target{uniform(seed, 2, 14), uniform(seed, -0.1, 0.1), uniform(seed, -0.1, 0.1)};
        const Vec3 drift{uniform(seed, -100, 100), uniform(seed, -5, 5), uniform(seed, -5, 5)};
        s.ask_all({simulation::SetOperation{"bullet", "position", Vec3{}}, simulation::SetOperation{"target", "position", target},
                   simulation::SetOperation{"target", "linear_velocity", drift}});
        s.events.clear();
        s.step();
        // |p + w t| = R
        const Vec3 w = drift - Vec3{1000, 0, 0};
        const double R = 0.051, b = dot(target, w), c = length_squared(target) - R * R, square = b * b - length_squared(w) * c;
        const double time = square >= 0 ? c / (-b + std::sqrt(square)) : HUGE_VAL;
        const bool hits = time < 1.0 / 60;
        const auto begins = events_of(s, "contact.begin");
        wrong += begins.size() != (hits ? 1u : 0u);
        // Rounding limits the times of grazing impacts to its square root.
        if (hits && begins.size() == 1 && square > 1e-3 * b * b * R * R)
            worst = std::max(worst, std::fabs(begins[0].time - (s.simulation().time() - s.simulation().dt()) - time));
    }
    CHECK(wrong == 0);
    CHECK(worst < 1e-12);  // the time of an event counts from the start of the run
}

TEST_CASE("a spinning box hits the ground with a corner, although it is clear of it at both ends of the step")
{
    // Half extents .5 x .1 x .1, spinning at 40 rad/s about y above the ground: its end reaches .51 m below the centre at half
    // turns only. With the centre at .505 it touches between two steps.
    for (const char* resolution : kCertifying)
    {
        CAPTURE(resolution);
        Scene s(std::string(kGround) + box("bar", {0.5, 0.1, 0.1}, at({0, 0, 0.505}) + " angular_velocity=\"0 40 0\"") +
                    contact("bar ground", resolution, "1", "resolution.max_iterations=\"100000\""),
                "dt=\"1/20\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        s.step();
        const auto impacts = events_of(s, "contact.impact");
        REQUIRE(impacts.size() >= 1);
        // Lowest corner: .5 sin a + .1 cos a = .505
        const double r = std::hypot(0.5, 0.1), angle = std::asin(0.505 / r) - std::atan2(0.1, 0.5);
        CHECK(std::fabs(impacts[0].time - angle / 40) < 1e-12);
        CHECK(s.vec("bar", "linear_velocity").z > 1);
        const double kinetic = energy(s) - 9.81 * s.vec("bar", "position").z;
        CHECK(near(kinetic, 0.5 * (0.25 + 0.01) / 3 * 1600, 1e-12));
    }
}

TEST_CASE("a ball that passes a post hits or narrowly misses it, as the geometry requires")
{
    for (const double miss : {-1e-6, -1e-9, 1e-9, 1e-6})
    {
        CAPTURE(miss);
        Scene s(sphere("ball", 0.1, at({-1, 0.3 + miss, 0}, {100, 0, 0})) + sphere("post", 0.2, "position=\"0 0 0\"", "Static") +
                    contact("ball post", "LocalRoot", "1"),
                "dt=\"1/20\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        s.step();
        CHECK(s.count("contact.impact") == (miss < 0 ? 1 : 0));
    }
}

TEST_CASE("a ball thrown up touches a ceiling at the apex of its path")
{
    // The gap closes and opens within one step: h = v^2 / 2g.
    const double v = 0.3, top = v * v / (2 * 9.81);
    for (const double over : {-1e-9, 1e-9})
    {
        CAPTURE(over);
        Scene s(sphere("ball", 0.1, at({0, 0, 0}, {0, 0, v})) +
                    "<component id=\"ceiling\" type=\"State/Static\" shape=\"roof\" position=\"" + text(Vec3{0, 0, 0.1 + top - over}) +
                    "\" orientation=\"0 1 0 0\"/><component id=\"roof\" type=\"Shape/Plane\"/>" + gravity("ball") +
                    contact("ball ceiling", "LocalRoot", "1"),
                "dt=\"1/10\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        s.step();
        CHECK(s.count("contact.impact") == (over > 0 ? 1 : 0));
    }
}
