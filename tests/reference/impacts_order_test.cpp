// Many impacts: their number, their order and what they leave. C4 to C9 and C13 as in the catalogue.
//
// | problem | rung                            | bound                                                                     |
// |---------|---------------------------------|---------------------------------------------------------------------------|
// | C4      | LocalRoot                       | energy 1e-12 of E0, heights 1e-9 m over 20 s at h = 0.01                  |
// | C5      | certifying + Impulse            | rest at the sum of the series to 1e-6 s, gap 1e-12; at most 60 impacts in |
// |         |                                 | a step for e = .5, .9; 200 for e = .99, whose bounces are cut off in the  |
// |         |                                 | step in which their sum ends (1023 in all, 90 s)                          |
// | C6      | LocalRoot                       | 3, 31, 314, 3141 (31415 in impacts_long)                                  |
// | C8      | LocalRoot + Impulse             | gaps: k in, k out to 1e-10                                                |
// |         | gap 0, Impulse, any resolution  | k in, k out to 1e-12: the declared law, one pair after the other          |
// |         | gap 0, Rows, not located        | the other declared law, all at once: those that touch share               |
// |         |                                 | u_n' >= -e u_n; momentum and energy kept                                  |
// | C9      | LocalRoot + Impulse             | 1e-12 of (3M - m)/(M + m); Penalty 8e-9 of its own equations, half of that  |
// | C13     | LocalRoot + Impulse             | mirror 1e-12, ids 1e-12 (Rows: stacks_test)                               |
#include <algorithm>

#include "impacts.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("C4: 49 elastic balls keep their energy and their heights at dt = 0.01")
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
        s.run(600);  // the last ones nearly move along with one another
        CHECK(s.count("contact.impact") == digits);
        ++k;
    }
}

TEST_CASE("C8: Newton's cradle with gaps: k in, k out")
{
    for (const double gap : {1e-6, 1e-9})
        for (int k = 1; k <= 3; ++k)
        {
            CAPTURE(gap);
            CAPTURE(k);
            std::string balls, all;
            for (int i = 0; i < 5; ++i)
            {
                const std::string id = "b" + std::to_string(i);
                const bool comes = i < k;
                balls += sphere(id, 0.1, at({i * (0.2 + gap) - (comes ? 0.1 : 0), 0, 0}, {comes ? 1.0 : 0.0, 0, 0}));
                all += id + " ";
            }
            Scene s(balls + contact(all, "LocalRoot", "1"), "dt=\"1/60\"");
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.run(0.5);
            for (int i = 0; i < 5; ++i)
                CHECK(std::fabs(s.vec("b" + std::to_string(i), "linear_velocity").x - (i >= 5 - k ? 1 : 0)) < 1e-10);
        }
}

TEST_CASE("C8: Newton's cradle without gaps: each response keeps to its declared law")
{
    const auto cradle = [](const Rung& rung, int k)
    {
        std::string balls, all;
        for (int i = 0; i < 5; ++i)
        {
            const std::string id = "b" + std::to_string(i);
            balls += sphere(id, 0.1, at({i * 0.2 - (i < k ? 0.1 : 0), 0, 0}, {i < k ? 1.0 : 0.0, 0, 0}));
            all += id + " ";
        }
        Scene s(balls + contact(all, rung, 1), "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(0.5);
        std::vector<double> v;
        for (int i = 0; i < 5; ++i) v.push_back(s.vec("b" + std::to_string(i), "linear_velocity").x);
        return v;
    };
    for (const Rung& rung : kRungs)
        for (int k = 1; k <= 3; ++k)
        {
            CAPTURE(rung.name());
            CAPTURE(k);
            const std::vector<double> v = cradle(rung, k);
            double momentum = 0, energy = 0;
            for (const double x : v) momentum += x, energy += x * x;
            CHECK(std::fabs(momentum - k) < 1e-12);
            CHECK(std::fabs(energy - k) < 1e-11);
            for (std::size_t i = 0; i < 5 && !rung.rows(); ++i) CHECK(std::fabs(v[i] - (static_cast<int>(i) >= 5 - k ? 1 : 0)) < 1e-12);
        }
    // One into four that touch, at once: the first contact parts at 1 m/s, the others at none: -0.6 and 0.4 for all.
    const std::vector<double> v = cradle({"None", "Rows"}, 1);
    CHECK(std::fabs(v[0] + 0.6) < 1e-12);
    for (std::size_t i = 1; i < 5; ++i) CHECK(std::fabs(v[i] - 0.4) < 1e-12);
}

// Both contacts press at once: M x'' = k (-x)+ - k (x - y)+ - M g, m y'' = k (x - y)+ - m g, from the touch of the big one, by
// Runge-Kutta with 4000 steps in a radian of the fastest oscillation. The small one is fastest at the end of the step in which it leaves.
TEST_CASE("C9: contacts that last do not do what impacts one after the other do")
{
    const double sequential = (3 - 0.1) / (1 + 0.1) * std::sqrt(2 * 9.81);
    for (const auto& [stiffness, fastest] : {std::pair{1e4, 5.271603805363632}, {1e6, 5.05645027296866}})
    {
        CAPTURE(stiffness);
        Scene s(kGround + sphere("big", 0.1, at({0, 0, 1.1}, {}, 1)) + sphere("small", 0.05, at({0, 0, 1.251}, {}, 0.1)) +
                    gravity("big small") +
                    "<component id=\"contact\" type=\"CDetection/ODE\" between=\"big small ground\" response=\"Response/Penalty\" "
                    "response.stiffness=\"" +
                    text(stiffness) + "\"/>",
                "dt=\"1/240\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        double top = 0;
        while (s.simulation().time() < 0.7) s.step(), top = std::max(top, s.vec("small", "linear_velocity").z);
        // Reached 4e-9 with 200 pieces per contact, 2e-10 with 1000: the pieces' own error.
        CHECK(std::fabs(top - fastest) < 8e-9);
        CHECK(top < 0.5 * sequential);
    }
}

TEST_CASE("C9: Galileo's cannon: the small ball leaves with (3M - m)/(M + m) of the speed")
{
    Scene s(kGround + sphere("big", 0.1, at({0, 0, 1.1}, {}, 1)) + sphere("small", 0.05, at({0, 0, 1.251}, {}, 0.1)) +
                gravity("big small") + contact("big small ground", "LocalRoot", "1"),
            "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    while (s.count("contact.impact") < 2 && s.simulation().time() < 1) s.step();
    const auto impacts = events_of(s, "contact.impact");
    REQUIRE(impacts.size() >= 2);
    // The big one turns at t1, and meets the small one, a gap of 1 mm above it, at t2; both fall alike.
    const double g = 9.81, v = std::sqrt(2 * g), t1 = v / g, t2 = t1 + 1e-3 / (2 * v);
    CHECK(std::fabs(impacts[0].time - t1) < 1e-13);
    CHECK(std::fabs(impacts[1].time - t2) < 1e-13);
    const double up = v - g * (t2 - t1), down = -g * t2, M = 1, m = 0.1;
    const double after = (m * down + M * up + M * (up - down)) / (M + m);
    CHECK(near(s.vec("small", "linear_velocity").z, after - g * (s.simulation().time() - t2), 1e-12));
}

namespace
{
/// Cue ball into a rack of 15, along its axis; ids run through `rank`. Returns final velocities by place.
std::vector<Vec3> break_rack(const std::vector<int>& rank, double gap)
{
    std::string balls, all;
    std::vector<std::string> ids;
    const double d = 0.1 + gap;
    for (int row = 0, n = 0; row < 5; ++row)
        for (int i = 0; i <= row; ++i, ++n)
        {
            ids.push_back("b" + std::to_string(100 + rank[static_cast<std::size_t>(n)]));
            balls += sphere(ids.back(), 0.05, at({row * d * std::sqrt(0.75), (i - 0.5 * row) * d, 0}));
            all += ids.back() + " ";
        }
    balls += sphere("cue", 0.05, at({-0.5, 0, 0}, {10, 0, 0}));
    Scene s(balls + contact(all + "cue", "LocalRoot", "1"), "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(0.5);
    std::vector<Vec3> out;
    for (const std::string& id : ids) out.push_back(s.vec(id, "linear_velocity"));
    return out;
}
}  // namespace

TEST_CASE("C13: a rack breaks as symmetric as it stands, whatever the ids")
{
    std::vector<int> straight, mixed;
    for (int i = 0; i < 15; ++i) straight.push_back(i), mixed.push_back((i * 7 + 3) % 15);
    for (const double gap : {0.0, 1e-4})
    {
        CAPTURE(gap);
        const std::vector<Vec3> v = break_rack(straight, gap), w = break_rack(mixed, gap);
        double worst = 0, other = 0, energy_sum = 0;
        for (int row = 0, first = 0; row < 5; first += ++row)
            for (int i = 0; i <= row; ++i)
            {
                const Vec3 &a = v[static_cast<std::size_t>(first + i)], &b = v[static_cast<std::size_t>(first + row - i)];
                worst = std::max({worst, std::fabs(a.x - b.x), std::fabs(a.y + b.y)});
            }
        for (std::size_t i = 0; i < v.size(); ++i) other = std::max(other, length(v[i] - w[i])), energy_sum += length_squared(v[i]);
        CHECK(worst < 1e-12);
        CHECK(other < 1e-12);
        CHECK(energy_sum > 50);
    }
}
