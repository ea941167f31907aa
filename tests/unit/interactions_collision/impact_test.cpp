// Impacts against closed forms: reference problems C1, C2, C3 and what follows from conservation.
#include <doctest/doctest.h>

#include "bodies.h"
#include "response/impact_law.h"

using namespace plab;
using namespace plab::test;

namespace
{
double relative(double got, double want, double scale) { return std::fabs(got - want) / std::max(std::fabs(want), scale); }

struct Spun
{
    double speed, spin;
};
/// C2: a sphere hits a wall (normal z) obliquely, sliding at `azimuth`.
Spun oblique(double tangential, double azimuth)
{
    Bodies b;
    add_body(b, 0, {}, {});
    const Vec3 t{std::cos(azimuth), std::sin(azimuth), 0};
    add_sphere(b, 1, 0.1, {0, 0, 0.1}, t * tangential + Vec3{0, 0, -4});
    std::vector<Contact> c{contact_point(0, 1, {}, {0, 0, 1}, 0.3, 0.8)};
    respond(b, c);
    CHECK(b.velocity[1].z == near(3.2, 1e-14));
    CHECK(std::fabs(dot(b.velocity[1], cross(t, {0, 0, 1}))) < 1e-14);
    return {dot(b.velocity[1], t), dot(b.angular_velocity[1], cross({0, 0, 1}, t))};
}
}  // namespace

TEST_CASE("C1: head-on spheres keep 14 digits at mass ratios up to 1e9")
{
    for (const double m2 : {1.0, 1e3, 1e6, 1e9})
        for (const double e : {0.0, 0.5, 1.0})
            for (const bool swapped : {false, true})
            {
                const double ma = swapped ? m2 : 1, mb = swapped ? 1 : m2;
                Bodies b;
                add_sphere(b, ma, 1, {-1, 0, 0}, {1, 0, 0});
                add_sphere(b, mb, 1, {1, 0, 0});
                std::vector<Contact> c{contact_point(0, 1, {}, {1, 0, 0}, 0, e)};
                const Impact impact = respond(b, c);
                const double M = ma + mb;
                const double want = (ma - mb * e) / M;
                if (want == 0)
                    CHECK(b.velocity[0].x == 0);
                else
                    CHECK(relative(b.velocity[0].x, want, 0) <= 1e-14);
                CHECK(relative(b.velocity[1].x, ma * (1 + e) / M, 0) <= 1e-14);
                CHECK(impact.converged);
                CHECK(c[0].impulse.x == near((1 + e) * ma * mb / M, 1e-14));
            }
}

TEST_CASE("C2: an oblique impact slides or sticks, alike at all azimuths")
{
    constexpr double kPi = 3.14159265358979312;
    std::vector<double> slow, fast;
    for (int i = 0; i < 8; ++i)
    {
        const Spun stick = oblique(3, i * kPi / 4 + 0.1), slide = oblique(12, i * kPi / 4 + 0.1);
        CHECK(relative(stick.speed, 15.0 / 7, 0) < 1e-13);
        CHECK(relative(stick.spin, 150.0 / 7, 0) < 1e-13);
        CHECK(relative(slide.speed, 9.84, 0) < 1e-13);
        CHECK(relative(slide.spin, 54, 0) < 1e-13);
        slow.push_back(stick.speed), fast.push_back(slide.speed);
    }
    const auto spread = [](const std::vector<double>& v)
    {
        const auto [lo, hi] = std::minmax_element(v.begin(), v.end());
        return (*hi - *lo) / *hi;
    };
    CHECK(spread(slow) < 1e-15);
    CHECK(spread(fast) < 1e-15);
}

TEST_CASE("C2: slip ends within the impact exactly where the closed form requires")
{
    CHECK(oblique(7.56 * (1 - 1e-9), 0).spin == near(oblique(7.56, 0).speed / 0.1, 1e-8));
    CHECK(oblique(7.56 * (1 + 1e-6), 0).speed > oblique(7.56 * (1 + 1e-6), 0).spin * 0.1);
}

TEST_CASE("C3: the end of a rod hits an edge")
{
    Bodies b;
    add_body(b, 0, {}, {});
    const double I = 1.0 / 12;
    add_body(b, 1, {1e-3, I, I}, {-0.5, 0, 0}, {0, 0, -1});
    std::vector<Contact> c{contact_point(0, 1, {}, {0, 0, 1}, 0, 0.5)};
    respond(b, c);
    CHECK(c[0].impulse.z == near(0.375, 1e-14));
    CHECK(b.velocity[1].z == near(-0.625, 1e-14));
    CHECK(std::fabs(b.angular_velocity[1].y) == near(2.25, 1e-14));
    CHECK(b.velocity_at(1, {}).z == near(0.5, 1e-14));
}

TEST_CASE("random impacts never gain energy, conserve momentum and separate at the right speed")
{
    std::uint64_t seed = 7;
    double worst_gain = 0, worst_momentum = 0, worst_spin = 0;
    for (int i = 0; i < 10000; ++i)
    {
        Bodies b;
        for (int k = 0; k < 2; ++k)
        {
            const Vec3 s{uniform(seed, 0.1, 1), uniform(seed, 0.1, 1), uniform(seed, 0.1, 1)};
            const double m = std::pow(10, uniform(seed, -3, 3));
            const Vec3 I = Vec3{s.y * s.y + s.z * s.z, s.x * s.x + s.z * s.z, s.x * s.x + s.y * s.y} * (m / 3);
            const std::uint32_t n = add_body(b, m, I, random_vector(seed, 1), random_vector(seed, 5), random_rotation(seed));
            set_spin(b, n, random_vector(seed, 5));
        }
        const Vec3 n = normalized(random_vector(seed, 1));
        std::vector<Contact> c{contact_point(0, 1, random_vector(seed, 1), n, uniform(seed, 0, 2), uniform(seed, 0, 1))};
        const auto momentum = [&] { return b.velocity[0] * b.mass[0] + b.velocity[1] * b.mass[1]; };
        const auto spin = [&]
        {
            Vec3 sum;
            for (std::uint32_t k = 0; k < 2; ++k) sum += cross(b.position[k], b.velocity[k] * b.mass[k]) + b.angular_momentum[k];
            return sum;
        };
        const double before = total_energy(b);
        const Vec3 p = momentum(), L = spin();
        const double p_size = length(b.velocity[0]) * b.mass[0] + length(b.velocity[1]) * b.mass[1];
        const double closing = dot(n, b.velocity_at(1, c[0].point) - b.velocity_at(0, c[0].point));
        const Impact impact = respond(b, c);
        REQUIRE(impact.converged);
        const double separation_speed = dot(n, b.velocity_at(1, c[0].point) - b.velocity_at(0, c[0].point));
        CHECK(separation_speed >= -1e-12 * 20);
        if (closing >= 0) CHECK(c[0].impulse == Vec3{});
        worst_gain = std::max(worst_gain, (total_energy(b) - before) / before);
        worst_momentum = std::max(worst_momentum, length(momentum() - p) / p_size);
        worst_spin = std::max(worst_spin, length(spin() - L) / (p_size + length(L)));
    }
    MESSAGE("energy gain ", worst_gain, ", momentum ", worst_momentum, ", angular momentum ", worst_spin);
    CHECK(worst_gain < 1e-14);
    CHECK(worst_momentum < 1e-14);
    CHECK(worst_spin < 1e-14);
}

TEST_CASE("a bounce below the visible height is suppressed")
{
    Bodies b;
    add_body(b, 0, {}, {});
    add_sphere(b, 1, 0.1, {0, 0, 0.1}, {0, 0, -4e-7});
    std::vector<Contact> c{contact_point(0, 1, {}, {0, 0, 1}, 0, 0.9)};
    c[0].normal_acceleration = -9.81;
    respond(b, c);
    CHECK(c[0].resting);
    CHECK(b.velocity[1].z == 0);
    b.velocity[1].z = -1e-6;
    respond(b, c);
    CHECK_FALSE(c[0].resting);
    CHECK(b.velocity[1].z == near(9e-7, 1e-12));
}

TEST_CASE("without a pressing force, a plastic impact leaves the bodies in contact")
{
    Bodies b;
    add_sphere(b, 1, 1, {-1, 0, 0}, {1, 0, 0});
    add_sphere(b, 1, 1, {1, 0, 0});
    std::vector<Contact> c{contact_point(0, 1, {}, {1, 0, 0}, 0, 0)};
    respond(b, c);
    CHECK(c[0].resting);
    CHECK(b.velocity[0].x == 0.5);
    CHECK(b.velocity[1].x == 0.5);
}

TEST_CASE("Newton's cradle: with e = 1 one ball in, one ball out")
{
    Bodies b;
    std::vector<Contact> c;
    for (std::uint32_t i = 0; i < 5; ++i) add_sphere(b, 1, 0.5, {i * 1.0, 0, 0}, {i == 0 ? 1.0 : 0.0, 0, 0});
    for (std::uint32_t i = 0; i < 4; ++i) c.push_back(contact_point(i, i + 1, {i + 0.5, 0, 0}, {1, 0, 0}, 0, 1)), c.back().id = 9 - i;
    respond(b, c);
    for (std::uint32_t i = 0; i < 4; ++i) CHECK(b.velocity[i].x == 0);
    CHECK(b.velocity[4].x == 1);
}

TEST_CASE("of several simultaneous impacts the fastest is answered first, whatever the ids")
{
    for (const bool swapped : {false, true})
    {
        Bodies b;
        add_sphere(b, 1, 1, {-2, 0, 0}, {3, 0, 0});
        add_sphere(b, 1, 1, {0, 0, 0});
        add_sphere(b, 1, 1, {2, 0, 0}, {-1, 0, 0});
        std::vector<Contact> c{contact_point(0, 1, {-1, 0, 0}, {1, 0, 0}, 0, 0.5), contact_point(1, 2, {1, 0, 0}, {1, 0, 0}, 0, 0.5)};
        c[0].id = 5, c[1].id = swapped ? 3 : 7;
        if (swapped) std::swap(c[0], c[1]);
        CHECK(respond(b, c).iterations == 3);  // left, right, left again
        CHECK(b.velocity[0].x == near(0.046875, 1e-14));
        CHECK(b.velocity[1].x == near(0.515625, 1e-14));
        CHECK(b.velocity[2].x == near(1.4375, 1e-14));
    }
}

TEST_CASE("a box that lands flat bounces flat, at Newton's speed and with less energy")
{
    Bodies b;
    add_body(b, 0, {}, {});
    add_body(b, 2, {0.3, 0.4, 0.5}, {0, 0, 0.5}, {1, 0, -2});
    std::vector<Contact> c;
    for (const Vec3& p : box_corners({0.5, 0.5, 0.5}))
        if (p.z < 0) c.push_back(contact_point(0, 1, {p.x, p.y, 0}, {0, 0, 1}, 0.1, 0.5)), c.back().id = c.size();
    const double before = total_energy(b);
    const Impact impact = respond(b, c);
    CHECK(impact.converged);
    for (const Contact& k : c) CHECK(b.velocity_at(1, k.point).z >= 1.0 - 1e-9);
    CHECK(total_energy(b) < before);
    CHECK(std::fabs(b.velocity[1].y) < 1e-12);
}
