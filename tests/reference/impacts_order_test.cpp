// Many impacts: their number, their order and the motion after them. C4, C5, C6 and C9 as in the catalogue, with the best
// algorithm; every algorithm, C8 and C13: impacts_flight_algorithms_test.cpp and impacts_series_algorithms_test.cpp.
//
// | problem | algorithm            | bound                                                                      |
// |---------|----------------------|----------------------------------------------------------------------------|
// | C4      | LocalRoot            | energy 1e-12 of E0, heights 1e-9 m over 20 s at h = 0.01                   |
// | C5      | certifying + Impulse | rest at the sum of the series to 1e-6 s, gap 1e-12; at most 60 impacts in  |
// |         |                      | a step for e = .5, .9; 200 for e = .99, whose bounces are cut off in the   |
// |         |                      | step in which their sum ends (1023 in all, 90 s)                           |
// | C6      | LocalRoot            | 3, 31, 314, 3141 (31415 in impacts_long)                                   |
// | C9      | LocalRoot + Impulse  | 1e-12 of (3M - m)/(M + m); Penalty 8e-9 of its own equations, half of that |
#include <algorithm>

#include "impacts.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("C4: 49 elastic balls conserve their energy and their heights at dt = 0.01")
{
    std::string balls, all;
    for (int i = 0; i < 49; ++i)
    {
        const std::string id = "b" + std::to_string(100 + i);
        balls += sphere(id, 0.1, at({0.5 * (i % 7), 0.5 * (i / 7), 5.1 + 0.01 * i}, {}, 10));
        all += id + " ";
    }
    Scene s(kGround + balls + gravity(all) + contact(all, "LocalRoot", "1", "against=\"ground\""), "dt=\"0.01\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const double e0 = energy(s);
    double worst = 0, worst_height = 0;
    for (int i = 0; i < 2000; ++i)
    {
        s.step();
        worst = std::max(worst, std::fabs(energy(s) / e0 - 1));
        const double h = 5, fall = std::sqrt(2 * h / 9.81), phase = std::fmod(s.simulation().time() + fall, 2 * fall) - fall;
        worst_height = std::max(worst_height, std::fabs(s.vec("b100", "position").z - 0.1 - (h - 0.5 * 9.81 * phase * phase)));
    }
    CHECK(worst < 1e-12);
    CHECK(worst_height < 1e-9);
}

TEST_CASE("C5: bounces that lose speed end at the sum of their series, in few events")
{
    struct Case
    {
        std::string e;
        double rest;
        int most;  ///< impacts in one step
    };
    for (const Case& c : {Case{"0.5", 1.35457092295719271, 60}, Case{"0.9", 8.57894917872888718, 60}, Case{"0.99", 89.85320455616045, 200}})
    {
        CAPTURE(c.e);
        Scene s(kGround + sphere("a", 0.1, at({0, 0, 1.1})) + gravity("a") + contact("a ground", "LocalRoot", c.e), "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        int most = 0;
        while (s.simulation().time() < c.rest + 0.5)
        {
            const std::size_t before = s.count("contact.impact");
            s.step();
            most = std::max(most, static_cast<int>(s.count("contact.impact") - before));
        }
        const auto rests = events_of(s, "contact.rest");
        REQUIRE(rests.size() == 1);
        CHECK(std::fabs(rests[0].time - c.rest) < 1e-6);
        CHECK(s.count("contact.zeno") == 1);
        CHECK(most <= c.most);
        CHECK(std::fabs(s.vec("a", "position").z - 0.1) < 1e-12);
        CHECK(length(s.vec("a", "linear_velocity")) < 1e-12);
        MESSAGE("e = ", c.e, ": ", s.count("contact.impact"), " impacts, at most ", most, " in a step, rest off by ",
                rests[0].time - c.rest);
    }
}

TEST_CASE("C6: Galperin's balls count the digits of pi, whatever happens within one step")
{
    int k = 0;
    for (const std::size_t digits : {3u, 31u, 314u, 3141u})
    {
        CAPTURE(k);
        Scene s("<component id=\"wall.shape\" type=\"Shape/Plane\"/><component id=\"wall\" type=\"State/Static\" shape=\"wall.shape\"/>" +
                    sphere("light", 0.5, at({0, 0, 1.5})) + sphere("heavy", 0.5, at({0, 0, 3}, {0, 0, -0.1}, std::pow(100.0, k))) +
                    contact("light heavy wall", "LocalRoot", "1"),
                "dt=\"0.1\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        s.run(600);  // the velocities of the last ones are nearly equal
        CHECK(s.count("contact.impact") == digits);
        ++k;
    }
}

// Both contacts are compressed at the same time: M x'' = k (-x)+ - k (x - y)+ - M g, m y'' = k (x - y)+ - m g, from the first
// contact of the big one, by Runge-Kutta with 4000 steps per radian of the fastest oscillation. The small one is fastest at the end
// of the step in which it separates.
TEST_CASE("C9: contacts of finite duration give a different result from impacts one after the other")
{
    const double sequential = (3 - 0.1) / (1 + 0.1) * std::sqrt(2 * 9.81);
    for (const auto& [stiffness, fastest] : {std::pair{1e4, 5.271603805363632}, {1e6, 5.05645027296866}})
    {
        CAPTURE(stiffness);
        Scene s(kGround + sphere("big", 0.1, at({0, 0, 1.1}, {}, 1)) + sphere("small", 0.05, at({0, 0, 1.251}, {}, 0.1)) +
                    gravity("big small") +
                    "<component id=\"contact\" type=\"CDetection/ODE\" between=\"big small ground\" response=\"Response/Penalty\" "
                    "response.stiffness=\"" +
                    text(stiffness) + "\" response.restitution=\"1\"/>",
                "dt=\"1/240\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        double top = 0;
        while (s.simulation().time() < 0.7) s.step(), top = std::max(top, s.vec("small", "linear_velocity").z);
        // Reached 4e-9 with 200 pieces per contact, 2e-10 with 1000: the pieces' own error.
        CHECK(std::fabs(top - fastest) < 8e-9);
        CHECK(top < 0.5 * sequential);
    }
}

TEST_CASE("C9: Galileo's cannon: the small ball separates with (3M - m)/(M + m) times the speed")
{
    Scene s(kGround + sphere("big", 0.1, at({0, 0, 1.1}, {}, 1)) + sphere("small", 0.05, at({0, 0, 1.251}, {}, 0.1)) +
                gravity("big small") + contact("big small ground", "LocalRoot", "1"),
            "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    while (s.count("contact.impact") < 2 && s.simulation().time() < 1) s.step();
    const auto impacts = events_of(s, "contact.impact");
    REQUIRE(impacts.size() >= 2);
    // The big one rebounds at t1, and meets the small one, a gap of 1 mm above it, at t2; both fall with the same acceleration.
    const double g = 9.81, v = std::sqrt(2 * g), t1 = v / g, t2 = t1 + 1e-3 / (2 * v);
    CHECK(std::fabs(impacts[0].time - t1) < 1e-13);
    CHECK(std::fabs(impacts[1].time - t2) < 1e-13);
    const double up = v - g * (t2 - t1), down = -g * t2, M = 1, m = 0.1;
    const double after = (m * down + M * up + M * (up - down)) / (M + m);
    CHECK(near(s.vec("small", "linear_velocity").z, after - g * (s.simulation().time() - t2), 1e-12));
}
