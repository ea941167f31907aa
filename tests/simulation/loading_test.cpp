// Loading a scene, and its first step, take time in proportion to its objects.
#include <algorithm>
#include <chrono>

#include "support/scene.h"

using namespace plab;
using namespace plab::test;

namespace
{

double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Times
{
    double load = 1e9, first_step = 1e9;  ///< s for each object, the best of some trials
};

Times times_for(int n, const std::string& rest, const std::string& settings)
{
    const std::string scene = "<repeat id='all' count='" + std::to_string(n) +
                              "' step='1 0 0'><component id='b' type='State/RigidBody' mass='1' inertia='1 1 1'/></repeat>" + rest;
    Times best;
    for (int trial = 0; trial < 3; ++trial)
    {
        const auto start = std::chrono::steady_clock::now();
        Scene s(scene, settings);
        REQUIRE_MESSAGE(s.loaded(), s.error());
        best.load = std::min(best.load, seconds_since(start) / n);
        const auto loaded = std::chrono::steady_clock::now();
        s.step();
        best.first_step = std::min(best.first_step, seconds_since(loaded) / n);
    }
    return best;
}

}  // namespace

TEST_CASE("ten times the objects take about ten times the time to load and to make their first step")
{
    for (const char* rest :
         {"", "<component id='g' type='Field/Gravity' between='*'/>", "<component id='w' type='Field/Gravity' between='all'/>"})
    {
        CAPTURE(rest);
        const Times few = times_for(2000, rest, "dt='1/240'"), many = times_for(20000, rest, "dt='1/240'");
        MESSAGE("us per object: load ", few.load * 1e6, " and ", many.load * 1e6, ", first step ", few.first_step * 1e6, " and ",
                many.first_step * 1e6);
        // Caches explain a factor of 2; quadratic growth would be a factor of 10.
        CHECK(many.load < 4 * few.load);
        CHECK(many.first_step < 4 * few.first_step);
    }
}

TEST_CASE("an error in each cell of a repeat is reported for its first cells, with the number of the others")
{
    const auto error_of = [](const std::string& cell)
    {
        const Scene s("<repeat id='all' count='500' step='1 0 0'>" + cell + "</repeat>");
        return s.error();
    };
    const auto lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n'); };
    const std::string mass = error_of("<component id='b' type='State/RigidBody' mass='-1' inertia='1 1 1'/>");
    CHECK_MESSAGE(lines(mass) == 4, mass);
    CHECK_MESSAGE(mass.find("and 497 more like it") != std::string::npos, mass);
    // Errors of the scene's structure, which have no position in the text.
    const std::string loop = error_of(
        "<component id='a' type='State/Shaft' inertia='1'/><component id='b' type='State/Shaft' inertia='1'/>"
        "<component id='g' type='Constraint/AngularVelocity/Graph' driver='a' driven='b' velocity_factor='2'/>"
        "<component id='h' type='Constraint/AngularVelocity/Graph' driver='a' driven='b' velocity_factor='3'/>");
    CHECK_MESSAGE(lines(loop) == 4, loop);
    CHECK_MESSAGE(loop.find("and 497 more like it") != std::string::npos, loop);
}

TEST_CASE("a step over a large terrain costs what it costs over a small one: it goes through no list of all vertices")
{
    const auto step_time = [](int points)
    {
        const std::string n = std::to_string(points);
        Scene s(
            "<component id='gravity' type='Field/Gravity' between='*'/>"
            "<component id='field' type='Shape/HeightField' columns='" +
                n + "' rows='" + n +
                "' spacing='0.1' wave_height='0.1' wave_length='2'/><component id='ground' type='State/Static' shape='field'/>"
                "<component id='ball' type='Shape/Sphere' radius='0.1'/><component id='block' type='Shape/Box' half_extents='0.1 0.1 0.1'/>"
                "<component id='a' type='State/RigidBody' shape='ball' mass='1' position='0 0 0.5'/>"
                "<component id='b' type='State/RigidBody' shape='block' mass='1' position='1 0 0.5'/>"
                "<component id='c' type='CDetection/ODE' between='*'/>",
            "dt='1/240'");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        for (int i = 0; i < 20; ++i) s.step();
        double best = 1e9;
        for (int trial = 0; trial < 5; ++trial)
        {
            const auto start = std::chrono::steady_clock::now();
            for (int i = 0; i < 20; ++i) s.step();
            best = std::min(best, seconds_since(start) / 20);
        }
        return best;
    };
    // The larger one has 64 times as many triangles; before, its steps took 40 times as long.
    const double small = step_time(50), large = step_time(400);
    MESSAGE("us per step: ", small * 1e6, " and ", large * 1e6);
    CHECK(large < 5 * small);
}
