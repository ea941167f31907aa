// A13: 1000 bodies that drag brings to rest, c/m = 5 1/s, for 300 s, i.e. by a factor of e^-1500; and the floating-point
// environment of a step.
//
// Arithmetic with denormal numbers takes a hundred times as long. pLab leaves the environment unchanged (rounding to nearest,
// denormals neither flushed nor treated as zero, no traps) and instead sets speeds below 1e-150 to 0, so that no decaying value
// stays denormal. Checked in two ways: by the processor's own flag for denormal operands (x86), which other load on the machine
// does not affect, and by the ratio of the times of steps at the end and at the start, measured alternately.
#include <cfenv>
#include <ctime>
#include <limits>

#include "reference/algorithms.h"
#include "reference/motion.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// The flag for denormal operands, where the processor has one.
void forget_denormals()
{
#if defined(__SSE2__)
    __builtin_ia32_ldmxcsr(__builtin_ia32_stmxcsr() & ~2u);
#endif
}
bool met_denormals()
{
#if defined(__SSE2__)
    return (__builtin_ia32_stmxcsr() & 2u) != 0;
#else
    return false;
#endif
}

/// Processor time of some steps, s.
double time_of(Scene& s, int steps)
{
    const std::clock_t begin = std::clock();
    s.step(steps);
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

}  // namespace

TEST_CASE("A13: every solver gives e^-5t, no denormal number in the state, and zeros at the end")
{
    for (const SolverAlgorithm& algorithm : kEverySolver)
    {
        const std::string name = name_of(algorithm);
        CAPTURE(name);
        Scene s(solver(algorithm) + braked(1), per_second(10));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        int slow = 0;
        double from = 300, to = 0;
        while (s.simulation().time() < 299.95)
        {
            forget_denormals();
            s.step();
            if (met_denormals()) ++slow, from = std::fmin(from, s.simulation().time()), to = s.simulation().time();
            const Vec3 v = s.vec("b0", "linear_velocity"), w = s.vec("b0", "angular_velocity");
            for (const double number : {v.x, v.y, v.z, w.x, w.y, w.z})
                REQUIRE((number == 0 || std::fabs(number) > std::numeric_limits<double>::min()));
            if (std::fabs(s.simulation().time() - 1) < 0.01) MESSAGE(name << " at 1 s: " << v.x / std::exp(-5.0));
        }
        MESSAGE(name << ": denormal operands in " << slow << " of 3000 steps, " << from << " .. " << to << " s");
        CHECK(s.vec("b0", "linear_velocity") == Vec3{});
        // Powers are squares of speeds times masses and drags: 83 of 3000 steps at the most. Exponential: 375, from 28 s on (e^-140), in
        // its matrices.
        const bool exponential = name == "Exponential";
        CHECK(s.vec("b0", "angular_velocity") == Vec3{});
        CHECK(slow <= (exponential ? 750 : 166));
    }
}

TEST_CASE("A13: 1000 bodies: a step at rest takes no longer than one in motion")
{
    // With RungeKutta4 in steps of 0.4 s each speed is a third of the one before: 1e-140 m/s after 120 s, nothing after 130 s.
    const std::string scene = solver({"RungeKutta4"}) + braked(1000);
    Scene moving(scene, "dt=\"0.4\""), fading(scene, "dt=\"0.4\""), resting(scene, "dt=\"0.4\"");
    REQUIRE_MESSAGE(moving.loaded(), moving.error());
    fading.run(120), resting.run(300);
    CHECK(resting.vec("b999", "linear_velocity") == Vec3{});
    // The minimum of many alternating measurements: other load on the machine affects both alike.
    double first = 1e9, middle = 1e9, last = 1e9;
    for (int i = 0; i < 12; ++i)
    {
        first = std::fmin(first, time_of(moving, 5));
        middle = std::fmin(middle, time_of(fading, 5));
        last = std::fmin(last, time_of(resting, 5));
    }
    MESSAGE("time of a step at 1e-140 m/s and at rest over one in motion: " << middle / first << " " << last / first);
    CHECK(last < 1.1 * first);
    CHECK(middle < 1.1 * first);
}

TEST_CASE("A13: the floating-point environment inside a step rounds to nearest and keeps denormals, on every thread")
{
    // A shaft receives its torque of 1 N m only if both hold where its forces are evaluated.
    std::string parts;
    for (int i = 0; i < 12; ++i)
        parts += "<component id=\"s" + std::to_string(i) + "\" type=\"State/Shaft\" inertia=\"1\"/><component id=\"law" +
                 std::to_string(i) + "\" type=\"Script/Lua\" driven=\"s" + std::to_string(i) + R"("><param name="code">
        function force(t, state)
            local half = 2.0^-53
            local nearest = 1 + half == 1 and 1 + 1.5 * half > 1 and -1 - half == -1
            if nearest and 2.0^-1074 > 0 and 2.0^-1022 / 2 == 2.0^-1023 then driven:add_torque(1) end
        end</param></component>)";
    for (const int threads : {1, 3})
    {
        CAPTURE(threads);
        Scene s(parts, per_second(10), threads);
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(1);
        for (int i = 0; i < 12; ++i) CHECK(s.spin("s" + std::to_string(i)) == doctest::Approx(1).epsilon(1e-12));
    }
    CHECK(std::fegetround() == FE_TONEAREST);
}
