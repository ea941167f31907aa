// Scripts as forces of reference problems, through force() at every stage of RK4, and what a call costs.
#include <doctest/doctest.h>

#include <cstdlib>
#include <new>

#include "lab.h"

using namespace plab;
using scripts::test::Lab;
using scripts::test::seconds_since;

namespace
{

thread_local std::int64_t allocations = 0;

/// One classical Runge-Kutta step of body 0 (mass 1) with the script's force plus `gravity`.
void advance(Lab& lab, double h, const Vec3& gravity)
{
    Vec3& x = lab.bodies.position[0];
    Vec3& v = lab.bodies.velocity[0];
    const Vec3 x0 = x, v0 = v;
    const double t0 = lab.context.time, share[4] = {0, 0.5, 0.5, 1}, weight[4] = {1, 2, 2, 1};
    Vec3 dx, dv, sum_x, sum_v;
    for (int i = 0; i < 4; ++i)
    {
        x = x0 + dx * (share[i] * h), v = v0 + dv * (share[i] * h);
        lab.context.time = t0 + share[i] * h;
        lab.force();
        dx = v, dv = lab.wrenches.force[0] + gravity;
        sum_x += dx * weight[i], sum_v += dv * weight[i];
    }
    x = x0 + sum_x * (h / 6), v = v0 + sum_v * (h / 6);
    lab.context.time = t0 + h;
}

}  // namespace

// Counted: what the plugin allocates; Lua's memory is the script's own block.
void* operator new(std::size_t n)
{
    ++allocations;
    if (void* p = std::malloc(n ? n : 1)) return p;
    throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

TEST_CASE("B3: quadratic drag by a script")
{
    Lab lab("function force(t, state) local v = driven.velocity driven:add_force(v * (-0.01 * v:length())) end");
    lab.rows.driven[0] = Lab::kBody0;
    REQUIRE(lab.prepare() == "");
    lab.bodies.velocity[0] = {0, -3, 4};
    lab.force();
    CHECK(lab.wrenches.force[0].y == doctest::Approx(0.15).epsilon(1e-15));
    CHECK(lab.wrenches.force[0].z == doctest::Approx(-0.2).epsilon(1e-15));

    lab.bodies.velocity[0] = {};
    const int steps = 1200;
    for (int i = 0; i < steps; ++i) advance(lab, 5.0 / steps, {0, 9.81, 0});
    CHECK(std::fabs(lab.bodies.velocity[0].y - 28.7023194557054083) < 1e-10);
    CHECK(std::fabs(lab.bodies.position[0].y - 91.5600402510837169) < 1e-10);
    for (int i = 0; i < 20000; ++i) advance(lab, 1.0 / 240, {0, 9.81, 0});
    CHECK(lab.bodies.velocity[0].y == doctest::Approx(31.3209195267316505).epsilon(1e-12));
    CHECK(lab.events.all.empty());
}

TEST_CASE("A6: a Kepler orbit of eccentricity 0.9 with a script as the force")
{
    Lab lab(R"lua(
        local mu = 1
        function force(t, state)
            local r = driven.position
            local d = r:length()
            driven:add_force(r * (-mu * driven.mass / (d * d * d)))
        end)lua");
    lab.rows.driven[0] = Lab::kBody0;
    REQUIRE(lab.prepare() == "");
    lab.bodies.position[0] = {3, 0, 4};
    lab.force();
    CHECK(length(lab.wrenches.force[0] - Vec3{-3.0 / 125, 0, -4.0 / 125}) < 1e-16);

    const double e = 0.9;
    lab.bodies.position[0] = {1 - e, 0, 0}, lab.bodies.velocity[0] = {0, std::sqrt((1 + e) / (1 - e)), 0};
    const int steps = 100000;
    for (int i = 0; i < steps; ++i) advance(lab, 10.0 / steps, {});
    CHECK(std::fabs(lab.bodies.position[0].x - -1.8538537094055792) < 1e-9);
    CHECK(std::fabs(lab.bodies.position[0].y - -0.130885404839925551) < 1e-9);
    CHECK(lab.events.all.empty());
}

TEST_CASE("a warm script allocates nothing")
{
    Lab lab(R"lua(
        function drive(step)
            local t = {}
            for i = 1, 20 do t[i] = vec(i, 0, 0) end
            for k, v in pairs(t) do state.n = state.n + v.x end
            table.sort(t, function(a, b) return a.x > b.x end)
            state.s = string.format("%.17g", math.random())
        end
        function force(t, state) driven:add_force(driven.position * -3 + vec(0, state.n, 0)) end)lua");
    lab.rows.driven[0] = Lab::kBody0;
    lab.rows.state[0] = {{"n", 0.0}, {"s", std::string()}};
    REQUIRE(lab.prepare() == "");
    for (int i = 0; i < 100; ++i) lab.step();
    const std::int64_t before = allocations;
    for (int i = 0; i < 1000; ++i)
    {
        lab.drive();
        scripts::finish(lab.context, {}, lab.rows);
        lab.wrenches.force[0] = {};
        static constexpr Row row[] = {0};
        for (int stage = 0; stage < 4; ++stage)
            scripts::force(lab.context, row, lab.rows, lab.bodies, lab.shafts, lab.quantities, lab.wrenches);
    }
    CHECK(allocations == before);
    CHECK(lab.events.all.empty());
}

TEST_CASE("the cost of a call")
{
    const auto cost = [](const char* body, bool shaft)
    {
        Lab lab(std::string("local k = 2.5 function force(t, state) ") + body + " end");
        lab.rows.driven[0] = shaft ? Lab::kShaft0 : Lab::kBody0;
        REQUIRE(lab.prepare() == "");
        static constexpr Row row[] = {0};
        const int calls = 500;
        double best = 1e9;
        for (int repeat = 0; repeat < 100; ++repeat)
        {
            const auto start = std::chrono::steady_clock::now();
            for (int i = 0; i < calls; ++i)
                scripts::force(lab.context, row, lab.rows, lab.bodies, lab.shafts, lab.quantities, lab.wrenches);
            best = std::min(best, seconds_since(start) / calls * 1e9);
        }
        CHECK(lab.events.all.empty());
        return best;
    };
    const double empty = cost("", true);
    const double torque = cost("driven:add_torque(-k * driven.angle - 0.1 * driven.speed)", true);
    const double drag = cost("local v = driven.velocity driven:add_force(v * (-0.01 * v:length()))", false);
    MESSAGE("force(): empty " << empty << " ns, shaft torque " << torque << " ns, quadratic drag " << drag << " ns");
    CHECK(torque < 20000);
}
