// Stacks, sliding bodies, racks and towers with contacts by rows (Response/Rows), for each manager. C.., D.. as in the catalogue
// of reference problems. Known errors of a cheap algorithm are listed here with a bound.
#include <array>

#include "statics_scene.h"

using namespace plab;
using namespace plab::test;

namespace
{

struct Tower
{
    double sink = 0, shift = 0;  ///< of the top, m
};

Tower stand(const std::vector<double>& masses, const std::string& manager, const std::string& dt, double until)
{
    std::string body = kGround, ids;
    for (std::size_t i = 0; i < masses.size(); ++i)
    {
        body += box(name_of_box(i), {0.5, 0.5, 0.5}, masses[i], {0, 0, static_cast<double>(i) + 0.5});
        ids += name_of_box(i) + " ";
    }
    Scene s(body + gravity(ids) + contact(ids + "ground", manager, 0.8), "dt=\"" + dt + "\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(until);
    const Vec3 top = s.vec(name_of_box(masses.size() - 1), "position");
    return {static_cast<double>(masses.size()) - 0.5 - top.z, std::hypot(top.x, top.y)};
}

}  // namespace

TEST_CASE("D2: twenty cubes stand for 10 s at 1/60: Direct to 1e-9 m")
{
    const Tower t = stand(std::vector<double>(20, 1.0), "Direct", "1/60", 10);
    CHECK(std::fabs(t.sink) < 1e-9);
    CHECK(t.shift < 1e-9);
}

TEST_CASE("D2: the cheap algorithms: ten cubes with sweeps at 1/240, with sub-steps at 1/60")
{
    const Tower swept = stand(std::vector<double>(10, 1.0), "SequentialImpulse", "1/240", 5);
    CHECK(std::fabs(swept.sink) < 1e-3);
    CHECK(swept.shift < 0.05);
    const Tower soft = stand(std::vector<double>(10, 1.0), "SoftStep", "1/60", 5);
    CHECK(soft.sink < 0.02);
    CHECK(soft.shift < 0.05);
}

TEST_CASE("D1: heavy on light: a tower that doubles its masses to 512:1, pairs to 1e8:1, with Direct")
{
    std::vector<double> doubling;
    for (int i = 0; i < 10; ++i) doubling.push_back(std::ldexp(1.0, i));
    CHECK(std::fabs(stand(doubling, "Direct", "1/60", 10).sink) < 1e-9);
    for (const double ratio : {1e3, 1e6, 1e8}) CHECK(std::fabs(stand({1, ratio}, "Direct", "1/60", 5).sink) < 1e-8);
}

TEST_CASE("C14: a box slides to a stop: the distance to 1e-12 in any direction at any step, with any response to the first contact")
{
    const double exact = 9 / (2 * 0.4 * 9.81);
    for (const double angle : {0.0, 0.5235987755982988})
        for (const char* dt : {"1/60", "1/10"})
            for (const char* resolution : {"None", "LocalBisection"})
            {
                CAPTURE(angle);
                CAPTURE(dt);
                CAPTURE(resolution);
                const Vec3 v{3 * std::cos(angle), 3 * std::sin(angle), 0};
                Scene s(kGround + box("a", {0.25, 0.25, 0.1}, 1, {0, 0, 0.1}, "linear_velocity=\"" + text(v) + "\"") + gravity("a") +
                            contact("a ground", "Direct", 0.4, 0, resolution),
                        std::string("dt=\"") + dt + "\"");
                REQUIRE_MESSAGE(s.loaded(), s.error());
                s.run(2);
                const Vec3 p = s.vec("a", "position");
                const double tolerance = resolution == std::string("None") ? 1e-12 : 1e-3;
                CHECK(std::fabs(std::hypot(p.x, p.y) / exact - 1) < tolerance);
                CHECK(std::fabs(std::atan2(p.y, p.x) - angle) < tolerance);
            }
}

TEST_CASE("C14: a ramp at mu = tan(angle) (1 -+ 1e-6): holds, and slides by the difference")
{
    // The ground stays level, and gravity is inclined.
    const double angle = 0.5, g = 9.81;
    for (const double off : {1e-6, -1e-6})
    {
        const double mu = std::tan(angle) * (1 + off);
        Scene s(kGround + box("a", {0.25, 0.25, 0.05}, 1, {0, 0, 0.05}) + gravity("a", {g * std::sin(angle), 0, -g * std::cos(angle)}) +
                    contact("a ground", "Direct", mu),
                "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(10);
        const double x = s.vec("a", "position").x, slid = 0.5 * g * std::cos(angle) * std::tan(angle) * std::fmax(0.0, -off) * 100;
        CHECK(std::fabs(x - slid) < 1e-9);
    }
}

TEST_CASE("C15: a sliding ball begins to roll at the time and the speed of the closed form")
{
    const double v0 = 5, mu = 0.3, g = 9.81, end = 2 * v0 / (7 * mu * g);
    Scene s(kGround + ball("a", 0.1, 1, {0, 0, 0.1}, "linear_velocity=\"5 0 0\"") + gravity("a") + contact("a ground", "Direct", mu),
            "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1);
    CHECK(near(s.vec("a", "position").x, v0 * end - 0.5 * mu * g * end * end + 25.0 / 7 * (1 - end), 1e-11));
    CHECK(near(s.vec("a", "linear_velocity").x, 25.0 / 7, 1e-11));
    CHECK(near(s.vec("a", "angular_velocity").y, 250.0 / 7, 1e-10));
}

TEST_CASE("bounces without event location conserve energy exactly: the time of impact is wrong, not the speed")
{
    Scene s(kGround + ball("a", 0.1, 1, {0, 0, 1.1}) + gravity("a") + contact("a ground", "Direct", 0, 1), "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    for (int i = 0; i < 600; ++i)
    {
        s.step();
        const double v = s.vec("a", "linear_velocity").z;
        CHECK(std::fabs(0.5 * v * v + 9.81 * (s.vec("a", "position").z - 1.1)) < 1e-11);
    }
}

// Simultaneous where the manager answers (None), sequential where impacts are located (LocalRoot): two results, both symmetric.
// LocalBisection distinguishes touching from separated only to rounding (1e-16 m), and its result is not symmetric.
TEST_CASE("C13: a ball hits a rack of fifteen: the symmetry is kept to 1e-12, whatever the names of the bodies")
{
    for (const auto& [resolution, renamed] : {std::pair{"None", false}, {"None", true}, {"LocalRoot", false}, {"LocalRoot", true}})
    {
        CAPTURE(resolution);
        std::string body, ids;
        std::vector<std::array<std::string, 2>> mirrored;
        int n = 0;
        for (int row = 0; row < 5; ++row)
            for (int k = 0; k <= row; ++k)
            {
                const auto id = [&](int r, int i)
                { return (renamed ? "z" + std::to_string(97 * (5 * r + i) % 31) : "a") + std::to_string(10 * r + i); };
                body += ball(id(row, k), 0.5, 1, {row * 0.86602540378443865, k - 0.5 * row, 0});
                ids += id(row, k) + " ";
                mirrored.push_back({id(row, k), id(row, row - k)});
                ++n;
            }
        body += ball("cue", 0.5, 1, {-2, 0, 0}, "linear_velocity=\"3 0 0\"");
        Scene s(body + contact(ids + "cue", "Direct", 0, 1, resolution), "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(1);
        double energy = 0, momentum = s.vec("cue", "linear_velocity").x;
        for (const auto& [one, other] : mirrored)
        {
            const Vec3 v = s.vec(one, "linear_velocity"), w = s.vec(other, "linear_velocity");
            CHECK(distance(v, {w.x, -w.y, w.z}) < 1e-12);
            energy += 0.5 * length_squared(v), momentum += v.x;
        }
        energy += 0.5 * length_squared(s.vec("cue", "linear_velocity"));
        CHECK(near(energy, 4.5, 1e-12));
        CHECK(near(momentum, 3, 1e-12));
    }
}

TEST_CASE("D5: ten books overhang by sum of 1/2k of their length, less a thousandth: they stand; with more they fall")
{
    for (const bool stands : {true, false})
    {
        std::string body, ids;
        // The lowest lies on the table's edge at x = 0; book k from the top overhangs the one below by length / 2k.
        body +=
            "<component id=\"table.shape\" type=\"Shape/Box\" half_extents=\"2 1 0.5\"/><component id=\"table\" type=\"State/Static\" "
            "shape=\"table.shape\" position=\"-2 0 -0.5\"/>";
        const double length_of_book = 1, factor = stands ? 1 - 1e-3 : 1 + 1e-3;
        double end = 0;
        for (int level = 0; level < 10; ++level)
        {
            const int from_top = 10 - level;
            end += factor * length_of_book / (2 * from_top);
            const std::string id = name_of_box(static_cast<std::size_t>(level));
            body += box(id, {0.5, 0.3, 0.05}, 1, {end - 0.5, 0, 0.05 + 0.1 * level});
            ids += id + " ";
        }
        Scene s(body + gravity(ids) + contact(ids + "table", "Direct", 0.8), "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        const Vec3 before = s.vec("b009", "position");
        s.run(4);
        const double moved = distance(s.vec("b009", "position"), before);
        if (stands)
            CHECK(moved < 1e-9);
        else
            CHECK(moved > 0.05);
    }
}

TEST_CASE("a manager is exchanged under a resting stack: nothing is thrown up")
{
    std::string body = kGround, ids;
    for (std::size_t i = 0; i < 5; ++i)
    {
        body += box(name_of_box(i), {0.5, 0.5, 0.5}, 1, {0, 0, static_cast<double>(i) + 0.5});
        ids += name_of_box(i) + " ";
    }
    Scene s(body + gravity(ids) + contact(ids + "ground", "Direct", 0.8), "dt=\"1/120\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(0.5);
    REQUIRE(s.ask(simulation::SwapOperation{"contact.response.manager", "Manager/SequentialImpulse", {}}).done);
    for (int i = 0; i < 60; ++i)
    {
        s.step();
        CHECK(length(s.vec("b004", "linear_velocity")) < 1e-6);
    }
    CHECK(std::fabs(s.vec("b004", "position").z - 4.5) < 1e-6);
}
