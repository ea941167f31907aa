// Contacts that persist over a step.
#include <doctest/doctest.h>

#include "bodies.h"

using namespace plab;
using namespace plab::test;

namespace
{
constexpr double kG = 9.81, kStep = 0.01;

/// A unit box of 1 kg on a plane whose normal is n, with the four lower corners in contact, after gravity acted for a
/// step.
struct BoxOnPlane
{
    Bodies b;
    std::vector<Contact> c;

    explicit BoxOnPlane(double friction, double slope = 0, const Vec3& v = {})
    {
        // Gravity is inclined instead of the plane, so that the closed forms stay short.
        const Vec3 g{kG * std::sin(slope), 0, -kG * std::cos(slope)};
        add_body(b, 0, {}, {});
        add_body(b, 1, {1.0 / 6, 1.0 / 6, 1.0 / 6}, {0, 0, 0.5}, v + g * kStep);
        for (const Vec3& p : box_corners({0.5, 0.5, 0.5}))
        {
            if (p.z > 0) continue;
            c.push_back(contact_point(0, 1, {p.x, p.y, 0}, {0, 0, 1}, friction));
            c.back().id = c.size(), c.back().resting = true;
        }
    }
    Impact solve() { return respond(b, c, ImpactMode::Rest, kStep); }
    double normal_impulse() const
    {
        double sum = 0;
        for (const Contact& k : c) sum += k.impulse.z;
        return sum;
    }
};
}  // namespace

TEST_CASE("a sphere at rest on a plane has no normal velocity at all")
{
    for (const double friction : {0.0, 0.4})
        for (const double mass : {0.1, 1.0, 7.3, 1e6})
        {
            Bodies b;
            add_body(b, 0, {}, {});
            add_sphere(b, mass, 0.13, {0.3, 0.1, 0.13}, {0, 0, -kG / 240});
            std::vector<Contact> c{contact_point(0, 1, {0.3, 0.1, 0}, {0, 0, 1}, friction)};
            const Impact impact = respond(b, c, ImpactMode::Rest, 1.0 / 240);
            CHECK(b.velocity[1] == Vec3{});
            CHECK(b.angular_momentum[1] == Vec3{});
            CHECK(impact.residual == 0);
            CHECK(c[0].impulse.z == near(mass * kG / 240, 1e-14));
        }
}

TEST_CASE("a box on a plane stays, and its corners carry its weight")
{
    BoxOnPlane box(0.5);
    const Impact impact = box.solve();
    CHECK(impact.converged);
    CHECK(length(box.b.velocity[1]) < 1e-11);
    CHECK(length(box.b.angular_velocity[1]) < 1e-11);
    CHECK(box.normal_impulse() == near(kG * kStep, 1e-10));
}

TEST_CASE("the impulses of the previous step reduce the iterations of the next one")
{
    BoxOnPlane first(0.5), second(0.5);
    const int cold = first.solve().iterations;
    for (std::size_t i = 0; i < 4; ++i) second.c[i].impulse = first.c[i].impulse;
    const Impact warm = second.solve();
    CHECK(warm.iterations < cold);
    CHECK(warm.iterations <= 2);
    CHECK(warm.residual < 1e-11);
}

TEST_CASE("on a slope a box holds below the friction angle and slides above it")
{
    const double mu = 0.5, hold = std::atan(mu);
    BoxOnPlane below(mu, hold * 0.95), above(mu, hold * 1.05);
    CHECK(below.solve().converged);
    CHECK(length(below.b.velocity[1]) < 1e-10);
    CHECK(above.solve().converged);
    const double slope = hold * 1.05;
    CHECK(above.b.velocity[1].x == near(kG * (std::sin(slope) - mu * std::cos(slope)) * kStep, 1e-9));
}

TEST_CASE("a sliding sphere loses mu g dt, in the direction of its slip, the same at all azimuths")
{
    for (int i = 0; i < 8; ++i)
    {
        const double angle = 0.3 + i * 0.785;
        const Vec3 t{std::cos(angle), std::sin(angle), 0};
        Bodies b;
        add_body(b, 0, {}, {});
        add_sphere(b, 1, 0.1, {0, 0, 0.1}, t * 5.0 + Vec3{0, 0, -kG * kStep});
        std::vector<Contact> c{contact_point(0, 1, {}, {0, 0, 1}, 0.3)};
        respond(b, c, ImpactMode::Rest, kStep);
        CHECK(length(b.velocity[1] - t * (5 - 0.3 * kG * kStep)) < 1e-14);
        CHECK(dot(b.angular_velocity[1], cross({0, 0, 1}, t)) == near(2.5 * 0.3 * kG * kStep / 0.1, 1e-13));
        CHECK(c[0].slip == near(5 - 3.5 * 0.3 * kG * kStep, 1e-13));
    }
}

TEST_CASE("a gap may close within the step, and no further")
{
    Bodies b;
    add_body(b, 0, {}, {});
    add_sphere(b, 1, 0.1, {0, 0, 0.1001}, {0, 0, -1});
    std::vector<Contact> c{contact_point(0, 1, {}, {0, 0, 1})};
    c[0].depth = -1e-4;
    respond(b, c, ImpactMode::Rest, kStep);
    CHECK(b.velocity[1].z == -1e-2);
    b.velocity[1].z = -5e-3;
    respond(b, c, ImpactMode::Rest, kStep);
    CHECK(b.velocity[1].z == near(-5e-3, 1e-14));  // the previous impulse was an initial guess
    CHECK(c[0].impulse.z == 0);
}

TEST_CASE("contacts never pull")
{
    Bodies b;
    add_body(b, 0, {}, {});
    add_sphere(b, 1, 0.1, {0, 0, 0.1}, {0, 0, 2});
    std::vector<Contact> c{contact_point(0, 1, {}, {0, 0, 1}, 0.5)};
    c[0].impulse = {0.1, 0, 3};
    respond(b, c, ImpactMode::Rest, kStep);
    CHECK(length(b.velocity[1] - Vec3{0, 0, 2}) < 1e-14);
    CHECK(c[0].impulse == Vec3{});
}

TEST_CASE("random heaps: impulses inside the cone, no closing speed, friction dissipates energy")
{
    std::uint64_t seed = 21;
    for (int i = 0; i < 500; ++i)
    {
        Bodies b;
        add_body(b, 0, {}, {});
        const Vec3 I{uniform(seed, 0.1, 0.3), uniform(seed, 0.1, 0.3), uniform(seed, 0.1, 0.3)};
        add_body(b, 1, I, {0, 0, 0.5}, random_vector(seed, 1), random_rotation(seed));
        set_spin(b, 1, random_vector(seed, 1));
        std::vector<Contact> c;
        for (int k = 0; k < 3; ++k)
        {
            c.push_back(
                contact_point(0, 1, random_vector(seed, 0.5), normalized(random_vector(seed, 0.4) + Vec3{0, 0, 1}), uniform(seed, 0, 1)));
            c.back().id = static_cast<std::uint64_t>(k) + 1;
        }
        const double before = total_energy(b);
        const Impact impact = respond(b, c, ImpactMode::Rest, kStep);
        if (!impact.converged) continue;  // a wedge locked by friction has no unique solution
        CHECK(impact.residual < 1e-10);
        CHECK(total_energy(b) <= before * (1 + 1e-10));
        for (const Contact& k : c)
        {
            const double normal = dot(k.impulse, k.normal);
            CHECK(normal >= 0);
            CHECK(length(k.impulse - k.normal * normal) <= k.friction * normal * (1 + 1e-9) + 1e-15);
            if (k.slip > 1e-8) CHECK(length(k.impulse - k.normal * normal) >= k.friction * normal * (1 - 1e-6));
        }
    }
}

TEST_CASE("nothing changes for bodies that do not move, and without contacts")
{
    Bodies b;
    add_body(b, 0, {}, {});
    add_body(b, 0, {}, {});
    std::vector<Contact> c{contact_point(0, 1, {}, {0, 0, 1})}, none;
    for (const ImpactMode mode : {ImpactMode::Impact, ImpactMode::Rest})
    {
        CHECK(respond(b, c, mode, kStep).converged);
        CHECK(respond(b, none, mode, kStep).converged);
        CHECK(c[0].impulse == Vec3{});
    }
}
