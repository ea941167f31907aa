// Frictional impacts whose slip changes direction, stops or reverses, against a direct integration of Mirtich's equations.
#include <doctest/doctest.h>

#include "bodies.h"
#include "response/impact_law.h"

using namespace plab;
using namespace plab::test;

namespace
{
/// du/dJ_n = K (-mu s, 1) by n Euler-midpoint steps of fixed normal impulse, as in Mirtich's thesis, equation 3.30; no
/// shared code with the solver. First compression to u_n = 0, then restitution to W = e^2 |W_c|.
Vec3 reference(const Mat3& K, Vec3 u, double mu, double e, double dj)
{
    Vec3 impulse;
    double work = 0, goal = -1;
    const auto rate = [&](const Vec3& v)
    {
        const double slip = std::hypot(v.x, v.y);
        // Smoothed below 1e-7 m/s: there the law's value is any force inside the cone.
        const double s = 1 / std::max(slip, 1e-7);
        return Vec3{-mu * v.x * s, -mu * v.y * s, 1};
    };
    for (long i = 0; i < 100'000'000; ++i)
    {
        const Vec3 f = rate(u + K * rate(u) * (0.5 * dj));
        const Vec3 next = u + K * f * dj;
        const double w = work + 0.5 * (u.z + next.z) * dj;
        if (goal >= 0 && w >= goal) return impulse + f * (dj * (goal - work) / (w - work));
        impulse += f * dj, work = w, u = next;
        if (goal < 0 && u.z >= 0) goal = -e * e * work, work = 0;
        if (goal == 0) return impulse;
    }
    return {NAN, NAN, NAN};
}

/// Collision matrix of a rod of mass 1, length 2, tilted by `angle` in the plane of x and z, hit at its lower end.
Mat3 rod(double angle)
{
    Bodies b;
    add_body(b, 0, {}, {});
    const double I = 1.0 / 3;
    add_body(b, 1, {I, I, 1e-4}, {std::sin(angle), 0, std::cos(angle)}, {}, {std::cos(angle / 2), 0, std::sin(angle / 2), 0});
    return response::ContactPoint(contact_point(0, 1, {}, {0, 0, 1}), b).K();
}

/// A symmetric positive matrix with strong coupling of all three directions.
Mat3 random_matrix(std::uint64_t& seed)
{
    Mat3 A;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) A(i, j) = uniform(seed, -1, 1);
    return A * transposed(A) + Mat3::identity() * 0.2;
}

void check_against_reference(const Mat3& K, const Vec3& u, double mu, double e, double tolerance)
{
    const double size = length(u) / K(2, 2);
    const response::ImpactResult r = response::solve_impact(K, u, mu, e);
    const Vec3 want = reference(K, u, mu, e, 4e-6 * size);
    CHECK(length(r.impulse - want) / length(want) < tolerance);
    CHECK(length(r.velocity - (u + K * r.impulse)) < 1e-12 * length(u));
    CHECK(std::hypot(r.impulse.x, r.impulse.y) <= mu * r.impulse.z * (1 + 1e-12));
}
}  // namespace

TEST_CASE("a rod with friction: slip that stops, reverses or continues agrees with the direct integration")
{
    for (const double angle : {-0.9, -0.3, 0.0, 0.5, 1.1})
        for (const double slip : {-3.0, -0.2, 0.0, 0.4, 5.0})
            for (const double mu : {0.05, 0.3, 0.9})
            {
                CAPTURE(angle);
                CAPTURE(slip);
                CAPTURE(mu);
                check_against_reference(rod(angle), {slip, 0, -1}, mu, 0.6, 2e-5);
            }
}

TEST_CASE("slip that changes direction in three dimensions agrees with the direct integration")
{
    std::uint64_t seed = 3;
    for (int i = 0; i < 40; ++i)
    {
        const Mat3 K = random_matrix(seed);
        const Vec3 u{uniform(seed, -2, 2), uniform(seed, -2, 2), uniform(seed, -2, -0.2)};
        CAPTURE(i);
        check_against_reference(K, u, uniform(seed, 0.05, 1), uniform(seed, 0, 1), 1e-4);
    }
}

TEST_CASE("the impulse rotates with the scene")
{
    std::uint64_t seed = 5;
    for (int i = 0; i < 20; ++i)
    {
        const Mat3 K = random_matrix(seed);
        const Vec3 u{uniform(seed, -2, 2), uniform(seed, -2, 2), -1};
        const double angle = uniform(seed, 0, 6), c = std::cos(angle), s = std::sin(angle);
        const Mat3 R{{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
        const Vec3 j = response::solve_impact(K, u, 0.4, 0.5).impulse;
        const Vec3 turned = response::solve_impact(R * K * transposed(R), R * u, 0.4, 0.5).impulse;
        CHECK(length(turned - R * j) < 1e-11 * length(j));
    }
}

TEST_CASE("the law never gains energy, for any matrix, friction and restitution")
{
    std::uint64_t seed = 11;
    double worst = -1, lost = 0;
    for (int i = 0; i < 20000; ++i)
    {
        const Mat3 K = random_matrix(seed);
        const Vec3 u{uniform(seed, -2, 2), uniform(seed, -2, 2), uniform(seed, -2, -0.01)};
        const double mu = uniform(seed, 0, 3), e = uniform(seed, 0, 1);
        const response::ImpactResult r = response::solve_impact(K, u, mu, e);
        const double gain = 0.5 * dot(r.impulse, u + (u + K * r.impulse));
        worst = std::max(worst, gain / (length(r.impulse) * length(u)));
        lost = std::max(lost, length(r.velocity - (u + K * r.impulse)) / length(u));
        REQUIRE(r.velocity.z >= 0);
    }
    MESSAGE("largest relative gain ", worst, ", drift of the path ", lost);
    CHECK(worst < 1e-13);
    CHECK(lost < 1e-11);
}
