// Many bodies that bounce at times of their own: each impact is exact, and costs what it touches, however many others there are.
#include <cmath>

#include "plab/random.h"
#include "reference/impacts.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kRadius = 0.1, kGravity = 9.81;

std::string ball(int i, const Vec3& place) { return sphere("b" + std::to_string(i), kRadius, at(place)); }

/// Balls at the corners of squares 2 m wide, `heights` above the ground.
std::string balls_over_ground(const std::vector<double>& heights, double restitution)
{
    std::string out = kGround + gravity("*") + contact("*", "LocalRoot", text(restitution));
    const int side = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(heights.size()))));
    for (int i = 0; i < static_cast<int>(heights.size()); ++i)
        out += ball(i, {2.0 * (i % side), 2.0 * (i / side), kRadius + heights[static_cast<std::size_t>(i)]});
    return out;
}

std::vector<double> random_heights(int n)
{
    std::uint64_t random = 7;
    std::vector<double> out;
    for (int i = 0; i < n; ++i) out.push_back(0.2 + 3.8 * next_uniform(random));
    return out;
}

/// m: height of a ball that is dropped from h and bounces with restitution e, at time t. Adds its bounces to `bounces`.
double height_after(long double h, long double e, long double t, int& bounces)
{
    constexpr long double g = kGravity;
    const long double fall = std::sqrt(2 * h / g);
    if (t < fall) return static_cast<double>(h - g * t * t / 2);
    long double up = e * g * fall;
    for (t -= fall, ++bounces; t > 2 * up / g; ++bounces) t -= 2 * up / g, up *= e;
    return static_cast<double>(up * t - g * t * t / 2);
}

}  // namespace

TEST_CASE("a thousand balls dropped from random heights are where the closed form has them after many bounces")
{
    constexpr double kRestitution = 0.95, kTime = 4;
    const std::vector<double> heights = random_heights(1000);
    Scene s(balls_over_ground(heights, kRestitution), "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    int events = 0;
    while (s.simulation().time() < kTime - 1e-9) s.step(), events += s.simulation().stepper().report().events;
    int bounces = 0;
    double worst = 0;
    for (int i = 0; i < 1000; ++i)
    {
        const double expected = height_after(heights[static_cast<std::size_t>(i)], kRestitution, kTime, bounces);
        worst = std::max(worst, std::fabs(s.vec("b" + std::to_string(i), "position").z - kRadius - expected));
    }
    CHECK(worst < 1e-12);
    CHECK(events == bounces);
    CHECK(bounces > 4000);
}

TEST_CASE("what an impact looks at does not grow with the number of bodies that rest or fly elsewhere")
{
    // Per impact, in the second of two steps: the same scene without the balls that bounce shows what a step looks at anyway.
    const auto visited_per_impact = [](int n)
    {
        constexpr int kBouncing = 50;
        const auto count = [&](double height, int& events)
        {
            std::vector<double> heights(static_cast<std::size_t>(n), 0.0);
            for (int i = 0; i < n; ++i)
                if (i % 2 == 1) heights[static_cast<std::size_t>(i)] = 100;
            for (int i = 0; i < kBouncing; ++i) heights[static_cast<std::size_t>(2 * i + 1)] = height;
            Scene s(balls_over_ground(heights, 0.8), "dt=\"1/60\"");
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.run(0.1);
            double sum = 0;
            while (s.simulation().time() < 0.5)
                s.step(), sum += static_cast<double>(s.simulation().stepper().report().visited),
                    events += s.simulation().stepper().report().events;
            return sum;
        };
        int without = 0, with = 0;
        const double plain = count(100, without), all = count(0.3, with);
        REQUIRE(without == 0);
        REQUIRE(with >= kBouncing);
        return (all - plain) / with;
    };
    const double few = visited_per_impact(200), many = visited_per_impact(3200);
    CHECK(few > 1);
    CHECK(many < 1.5 * few);
}

TEST_CASE("where many balls bounce and come to rest, the number of threads changes no bit")
{
    std::uint64_t hashes[3] = {};
    for (std::size_t k = 0; k < 3; ++k)
    {
        Scene s(balls_over_ground(random_heights(1000), 0.5), "dt=\"1/60\"", 1 << k);
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(2.5);
        CHECK(s.simulation().stepper().report().resting_pairs > 100);
        hashes[k] = s.simulation().state_hash();
    }
    CHECK(hashes[1] == hashes[0]);
    CHECK(hashes[2] == hashes[0]);
}
