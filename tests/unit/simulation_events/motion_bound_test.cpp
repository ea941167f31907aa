// Bounds on the motion inside a piece hold, and are sharp if the motion is simple. Compared with dense sampling.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "plab/rotation.h"
#include "simulation/events/motion_bound.h"
#include "support/random_poses.h"

using namespace plab;
using namespace plab::simulation;
using namespace plab::test;

namespace
{

/// Two bodies with constant acceleration and constant spin about a principal axis of a ball-like inertia.
struct Pair
{
    Bodies bodies;
    Shapes shapes;
    Vec3 acceleration[2];

    std::uint32_t add(const Geometry& g, const Vec3& p, const Vec3& v, const Vec3& w, const Vec3& a)
    {
        const auto i = static_cast<std::uint32_t>(bodies.size());
        shapes.geometry.push_back(g);
        bodies.motion.push_back(Motion::Dynamic), bodies.position.push_back(p), bodies.velocity.push_back(v);
        bodies.orientation.push_back({}), bodies.angular_velocity.push_back(w), bodies.angular_momentum.push_back(w);
        bodies.mass.push_back(1), bodies.inverse_mass.push_back(1), bodies.inertia_B.push_back(Mat3::diagonal(1, 1, 1));
        bodies.inverse_inertia_B.push_back(Mat3::diagonal(1, 1, 1)), bodies.needle.push_back(0), bodies.center_B.push_back({});
        bodies.material.push_back(0), bodies.shapes.push_back({{Facet::Shape, i}});
        acceleration[i] = a;
        return i;
    }
    BodyState at(std::uint32_t b, double t) const
    {
        const Vec3 v = bodies.velocity[b], w = bodies.angular_velocity[b], a = acceleration[b];
        return {bodies.position[b] + v * t + a * (0.5 * t * t), exp_rotation(w * t) * bodies.orientation[b], v + a * t, w};
    }
    /// Width of the gap along n at t.
    double width(const Vec3& n, double t) const
    {
        const BodyState A = at(0, t), B = at(1, t);
        return dot(B.position - A.position, n) - support(bodies, shapes, 0, A.orientation, n) -
               support(bodies, shapes, 1, B.orientation, -n);
    }
    Clearance clearance(double t, double T, MotionBound (&motions)[2], BodyExtent (&extents)[2]) const
    {
        for (std::uint32_t b = 0; b < 2; ++b)
        {
            extents[b] = extent_of(bodies, shapes, b);
            motions[b] = motion_bound_of(bodies, b, extents[b], 0, at(b, 0), T, at(b, T));
        }
        return {bodies, shapes, {0, &motions[0], &extents[0], at(0, t)}, {1, &motions[1], &extents[1], at(1, t)}, T - t};
    }
};

Geometry sphere(double r)
{
    Geometry g;
    g.kind = GeometryKind::Sphere, g.size = {r, 0, 0};
    return g;
}
Geometry box(const Vec3& h)
{
    Geometry g;
    g.kind = GeometryKind::Box, g.size = h;
    return g;
}

}  // namespace

TEST_CASE("balls: the bound is the time of impact itself")
{
    Pair p;
    p.add(sphere(0.1), {}, {1, 0, 0}, {0, 9, 0}, {0, 0, -9.81});
    p.add(sphere(0.2), {2, 0.1, 0}, {-9, 0, 0}, {}, {0, 0, -9.81});
    MotionBound motions[2];
    BodyExtent extents[2];
    const double T = 1, hit = (2 - std::sqrt(0.09 - 0.01)) / 10;
    CHECK(std::fabs(p.clearance(0, T, motions, extents).of_balls() - hit) < 1e-14);
    CHECK(extents[0].arm == 0);
    // For a fall onto a plane, the distance along its normal is exact as well.
    Pair q;
    q.add(box({5, 5, 0.1}), {}, {}, {}, {});
    q.add(sphere(0.1), {0.3, 0.2, 1.2}, {3, 0, -1}, {1, 2, 3}, {0, 0, -9.81});
    const double fall = (-1 + std::sqrt(1 + 2 * 9.81)) / 9.81;
    CHECK(std::fabs(q.clearance(0, T, motions, extents).along({0, 0, 1}, 1) - fall) < 1e-14);
}

TEST_CASE("for any spinning, flying and falling bodies, no gap along a normal closes before its bound")
{
    std::uint64_t seed = 11;
    int hits = 0, early = 0;
    double sharp = 0;
    for (int round = 0; round < 400; ++round)
    {
        Pair p;
        p.add(box({0.3, 0.1, 0.2}), {}, random_vector(seed, 1), random_vector(seed, round % 2 == 0 ? 3 : 30), {0, 0, -9.81});
        p.add(round % 3 == 0 ? sphere(0.2) : box({0.2, 0.2, 0.1}), Vec3{uniform(seed, 0.6, 1), 0, 0}, random_vector(seed, 3),
              random_vector(seed, 3), {});
        const Vec3 n{1, 0, 0};
        const double T = 0.2, gap = p.width(n, 0);
        if (!(gap > 0)) continue;
        MotionBound motions[2];
        BodyExtent extents[2];
        const double clear = p.clearance(0, T, motions, extents).along(n, gap);
        double first = T;
        for (int i = 1; i <= 4000 && first == T; ++i)
            if (p.width(n, T * i / 4000) < 0) first = T * i / 4000;
        early += clear > first;
        if (first < T) ++hits, sharp += clear / first;
    }
    CHECK(early == 0);
    REQUIRE(hits > 60);
    CHECK(sharp / hits > 0.4);  // and the bound is often sharp
}

TEST_CASE("steps by the bound converge to a corner's impact like Newton's method")
{
    Pair p;
    p.add(box({9, 9, 0.1}), {0, 0, -0.1}, {}, {}, {});
    p.add(box({0.5, 0.1, 0.1}), {0, 0, 0.505}, {}, {0, 40, 0}, {});
    const Vec3 n{0, 0, 1};
    const double T = 0.05, r = std::hypot(0.5, 0.1), want = (std::asin(0.505 / r) - std::atan2(0.1, 0.5)) / 40;
    double t = 0;
    int evaluations = 0;
    for (; evaluations < 30 && p.width(n, t) > 1e-13; ++evaluations)
    {
        MotionBound motions[2];
        BodyExtent extents[2];
        t += p.clearance(t, T, motions, extents).along(n, p.width(n, t));
        CHECK(t <= want + 1e-14);
    }
    CHECK(std::fabs(t - want) < 1e-13);
    CHECK(evaluations <= 12);
}

TEST_CASE("a spin that is not visible at either end of a piece is bounded by the momentum")
{
    // I = (1, 2, 3), almost about the middle axis: it flips within the piece.
    Pair p;
    p.add(box({0.1, 0.1, 0.1}), {}, {}, {0.01, 5, 0.01}, {});
    p.bodies.inertia_B[0] = Mat3::diagonal(1, 2, 3), p.bodies.inverse_inertia_B[0] = Mat3::diagonal(1, 0.5, 1.0 / 3);
    // The spin changes to the opposite one and is 5 all the time: I w^2 / 2 = 25, L = 10, and the bound must contain it.
    const MotionBound c = motion_bound_of(p.bodies, 0, extent_of(p.bodies, p.shapes, 0), 0, p.at(0, 0), 1, p.at(0, 0));
    CHECK(c.turning.spin >= std::sqrt(100.0 / 2 * (1 + 1.0 / 3) - 100.0 / 3));
    CHECK(c.turning.spin < 6);
    CHECK(c.turning.spin_up >= 5 * 5 / 4.0);
}

TEST_CASE("the bound on a body's displacement is no less than that of any of its points")
{
    Pair p;
    p.add(box({0.3, 0.1, 0.2}), {1, 2, 3}, {2, 0, 4}, {0, 20, 0}, {0, 0, -40});
    const double T = 0.2;
    const BodyExtent e = extent_of(p.bodies, p.shapes, 0);
    const double reach = swept_distance(motion_bound_of(p.bodies, 0, e, 0, p.at(0, 0), T, p.at(0, T)), e);
    double most = 0;
    for (int i = 0; i <= 200; ++i)
    {
        const BodyState s = p.at(0, T * i / 200), end = p.at(0, T);
        for (int k = 0; k < 8; ++k)
        {
            const Vec3 corner{k & 1 ? 0.3 : -0.3, k & 2 ? 0.1 : -0.1, k & 4 ? 0.2 : -0.2};
            const Vec3 there = s.position + rotate(s.orientation, corner), then = end.position + rotate(end.orientation, corner);
            most = std::max(most, length(there - then));
        }
    }
    CHECK(reach >= most);
    CHECK(reach < 2.5 * most);
}
