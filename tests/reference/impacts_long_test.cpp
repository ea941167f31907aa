// The same claims as in impacts_*_test.cpp, at full size.
//
// | problem | algorithm           | bound                                                                                  |
// |---------|---------------------|----------------------------------------------------------------------------------------|
// | C6      | LocalRoot + Impulse | 31415 exactly; a step of 0.1 s has 9700 of them, so it may take more than others       |
// | C10     | LocalRoot, sensor   | 0 wrong in 1e6                                                                         |
// | D3      | LocalRoot + Impulse | 216 elastic balls: energy to 1e-12 over the fall and the collapse (2 s), no body sinks |
#include <algorithm>

#include "impacts.h"
#include "plab/random.h"

using namespace plab;
using namespace plab::test;

TEST_CASE("C6: 31415 collisions")
{
    Scene s("<component id=\"wall.shape\" type=\"Shape/Plane\"/><component id=\"wall\" type=\"State/Static\" shape=\"wall.shape\"/>" +
                sphere("light", 0.5, at({0, 0, 1.5})) + sphere("heavy", 0.5, at({0, 0, 3}, {0, 0, -0.1}, 1e8)) +
                contact("light heavy wall", "LocalRoot", "1", "resolution.max_work=\"1e5\""),
            "dt=\"0.1\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    std::size_t n = 0;
    while (s.simulation().time() < 600)
    {
        s.step();
        for (const Event& e : s.simulation().events()) n += e.kind == "contact.impact";
    }
    CHECK(n == 31415);
}

TEST_CASE("C10: a million random shots at a moving ball: no hit is missed")
{
    std::uint64_t seed = 11;
    const auto uniform = [&](double low, double high) { return low + (high - low) * next_uniform(seed); };
    Scene s(sphere("bullet", 1e-3, at({0, 0, 0}, {1000, 0, 0}, 1e-3)) + sphere("target", 0.05, at({}), "RigidBody") +
                sensor("bullet target", "LocalRoot"),
            "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    auto& bodies = s.simulation().world().host().bodies;
    const std::uint32_t bullet = s.simulation().world().component(s.simulation().world().find("bullet")).host_index,
                        target = s.simulation().world().component(s.simulation().world().find("target")).host_index;
    int wrong = 0, hit = 0;
    for (int shot = 0; shot < 1000000; ++shot)
    {
        const Vec3 p{uniform(2, 14), uniform(-0.1, 0.1), uniform(-0.1, 0.1)}, drift{uniform(-100, 100), uniform(-5, 5), uniform(-5, 5)};
        bodies.position[bullet] = {}, bodies.position[target] = p, bodies.velocity[target] = drift;
        s.simulation().step();
        const Vec3 w = drift - Vec3{1000, 0, 0};
        const double R = 0.051, b = dot(p, w), square = b * b - length_squared(w) * (length_squared(p) - R * R);
        const bool hits = square >= 0 && (length_squared(p) - R * R) / (-b + std::sqrt(square)) < 1.0 / 60;
        int begins = 0;
        for (const Event& e : s.simulation().events()) begins += e.kind == "contact.begin";
        wrong += begins != (hits ? 1 : 0), hit += hits;
    }
    CHECK(wrong == 0);
    CHECK(hit > 100000);
}

TEST_CASE("D3: 6 x 6 x 6 elastic balls fall in a heap and keep their energy to rounding")
{
    std::uint64_t seed = 666;
    const auto jitter = [&] { return 1e-3 * (next_uniform(seed) - 0.5); };
    std::string balls, all;
    for (int i = 0; i < 216; ++i)
    {
        const std::string id = "b" + std::to_string(1000 + i);
        const double x = jitter(), y = jitter();
        balls += sphere(id, 0.1, at({0.21 * (i % 6) + x, 0.21 * (i / 6 % 6) + y, 1 + 0.21 * (i / 36)}, {}, 10));
        all += id + " ";
    }
    Scene s(kGround + balls + gravity(all) + contact(all + "ground", "LocalRoot", "1"), "dt=\"0.01\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const double e0 = energy(s);
    CHECK(e0 > 3e4);
    double worst = 0, lowest = 1;
    std::size_t impacts = 0;
    for (int i = 0; i < 200; ++i)
    {
        s.step();
        worst = std::max(worst, std::fabs(energy(s) / e0 - 1));
        for (const Event& e : s.simulation().events()) impacts += e.kind == "contact.impact";
    }
    for (int i = 0; i < 216; ++i) lowest = std::min(lowest, s.vec("b" + std::to_string(1000 + i), "position").z);
    CHECK(worst < 1e-12);
    CHECK(lowest > 0.1 - 1e-12);
    CHECK(impacts > 2000);
    MESSAGE("D3: E0 ", e0, " J, energy to ", worst, ", ", impacts, " impacts");
}
