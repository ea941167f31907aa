// Every pair of shapes: depth, normal and point against closed forms or brute force.
#include <doctest/doctest.h>

#include "bodies.h"

using namespace plab;
using namespace plab::detection;
using namespace plab::test;

namespace
{
Collider hull_of(std::vector<Vec3> vertices) { return Collider(mesh_of(std::move(vertices))); }

std::vector<ContactPoint> contact_points(const Collider& a, const Pose& X_a, const Collider& b, const Pose& X_b)
{
    ContactPoints out;
    collide(a, X_a, b, X_b, out);
    return {out.all().begin(), out.all().end()};
}
double deepest(const std::vector<ContactPoint>& t)
{
    double d = 0;
    for (const ContactPoint& k : t) d = std::max(d, k.depth);
    return d;
}
std::vector<Vec3> random_points(std::uint64_t& seed, int n, double size)
{
    std::vector<Vec3> out;
    for (int i = 0; i < n; ++i) out.push_back(normalized(random_vector(seed, 1)) * size);
    return out;
}
/// The least overlap of two point sets along any of the axes that can be least for convex polyhedra: face normals and
/// products of edges. Every face and every edge is tried; no cleverness.
double brute_depth(const Hull& a, const Pose& X_a, const Hull& b, const Pose& X_b)
{
    const auto spread = [](const Hull& h, const Pose& X, const Vec3& n, double sign)
    {
        double most = -HUGE_VAL;
        for (const Vec3& p : h.vertices) most = std::max(most, sign * dot(n, X * p));
        return most;
    };
    double least = HUGE_VAL;
    const auto try_axis = [&](const Vec3& n)
    {
        if (length(n) > 0.5) least = std::min(least, spread(a, X_a, n, 1) + spread(b, X_b, n, -1));
    };
    for (const Vec3& n : a.normals) try_axis(rotate(X_a.q, n));
    for (const Vec3& n : b.normals) try_axis(-rotate(X_b.q, n));
    for (const auto& e : a.edges)
        for (const auto& f : b.edges)
        {
            const Vec3 c = cross(rotate(X_a.q, a.vertices[e[1]] - a.vertices[e[0]]), rotate(X_b.q, b.vertices[f[1]] - b.vertices[f[0]]));
            if (length(c) < 1e-9) continue;
            try_axis(normalized(c)), try_axis(-normalized(c));
        }
    return least;
}
}  // namespace

TEST_CASE("sphere and sphere")
{
    const Collider a = collider(GeometryKind::Sphere, {0.3, 0, 0}), b = collider(GeometryKind::Sphere, {0.5, 0, 0});
    std::uint64_t seed = 1;
    for (int i = 0; i < 200; ++i)
    {
        const Vec3 n = normalized(random_vector(seed, 1));
        const double depth = uniform(seed, -0.1, 0.3);
        const auto t = contact_points(a, {{1, 2, 3}, {}}, b, {Vec3{1, 2, 3} + n * (0.8 - depth), random_rotation(seed)});
        REQUIRE(t.size() == (depth > 0 ? 1 : 0));
        if (t.empty()) continue;
        CHECK(std::fabs(t[0].depth - depth) < 1e-15);
        CHECK(length(t[0].normal - n) < 1e-14);
        CHECK(length(t[0].point - (Vec3{1, 2, 3} + n * (0.3 - depth / 2))) < 1e-14);
    }
    CHECK(contact_points(a, {}, b, {})[0].depth == 0.8);  // same centre
}

TEST_CASE("sphere and plane, in either order")
{
    const Collider a = collider(GeometryKind::Sphere, {0.25, 0, 0}), b = collider(GeometryKind::Plane);
    std::uint64_t seed = 2;
    for (int i = 0; i < 200; ++i)
    {
        const Pose X{random_vector(seed, 1), random_rotation(seed)};
        const double height = uniform(seed, -0.1, 0.3);
        const Pose S{X * Vec3{uniform(seed, -1, 1), uniform(seed, -1, 1), height}, random_rotation(seed)};
        const auto t = contact_points(a, S, b, X), back = contact_points(b, X, a, S);
        REQUIRE(t.size() == (height < 0.25 ? 1 : 0));
        REQUIRE(back.size() == t.size());
        if (t.empty()) continue;
        CHECK(std::fabs(t[0].depth - (0.25 - height)) < 2e-15);
        CHECK(length(t[0].normal + rotate(X.q, Vec3{0, 0, 1})) < 1e-15);
        CHECK(back[0].depth == t[0].depth);
        CHECK(back[0].normal == -t[0].normal);
    }
}

TEST_CASE("sphere against box and against the same box as a hull")
{
    const Vec3 h{0.4, 0.3, 0.2};
    const Collider s = collider(GeometryKind::Sphere, {0.25, 0, 0}), box = collider(GeometryKind::Box, h), hull = hull_of(box_corners(h));
    std::uint64_t seed = 3;
    int met = 0;
    for (int i = 0; i < 3000; ++i)
    {
        const Pose X{random_vector(seed, 1), random_rotation(seed)};
        const Vec3 c = random_vector(seed, 0.7);
        const auto t = contact_points(s, {X * c, {}}, box, X), u = contact_points(hull, X, s, {X * c, {}});
        double outside = 0, inside = -HUGE_VAL;
        for (int k = 0; k < 3; ++k)
        {
            const double d = std::fabs(c[k]) - h[k];
            outside += std::pow(std::max(0.0, d), 2), inside = std::max(inside, d);
        }
        const double depth = 0.25 - (inside > 0 ? std::sqrt(outside) : inside);
        if (std::fabs(depth) < 1e-12) continue;
        REQUIRE(t.size() == (depth > 0 ? 1 : 0));
        REQUIRE(u.size() == t.size());
        if (t.empty()) continue;
        ++met;
        CHECK(std::fabs(t[0].depth - depth) < 2e-15);
        CHECK(std::fabs(u[0].depth - depth) < 5e-15);
        CHECK(length(u[0].normal + t[0].normal) < 1e-12 / std::max(1e-3, std::sqrt(outside)));
        CHECK(length(u[0].point - t[0].point) < 1e-14);
    }
    CHECK(met > 300);
}

TEST_CASE("box and hull on a plane: every corner that is below")
{
    const Vec3 h{0.4, 0.3, 0.2};
    const Collider plane = collider(GeometryKind::Plane), box = collider(GeometryKind::Box, h), hull = hull_of(box_corners(h));
    std::uint64_t seed = 4;
    for (int i = 0; i < 500; ++i)
    {
        const Pose P{random_vector(seed, 1), random_rotation(seed)};
        const Pose X{P * Vec3{0.2, 0.1, uniform(seed, -0.1, 0.5)}, random_rotation(seed)};
        std::vector<double> below;
        for (const Vec3& c : box_corners(h))
            if (const double z = (inverse(P) * (X * c)).z; z < 0) below.push_back(-z);
        const auto t = contact_points(box, X, plane, P), u = contact_points(plane, P, hull, X);
        REQUIRE(t.size() == below.size());
        for (std::size_t k = 0; k < t.size(); ++k) CHECK(std::fabs(t[k].depth - below[k]) < 2e-15);
        CHECK(std::fabs(deepest(u) - deepest(t)) < 2e-15);
        if (t.size() > 4) continue;  // of more, a hull keeps those that support it
        REQUIRE(t.size() == u.size());
        for (std::size_t k = 0; k < t.size(); ++k)
        {
            CHECK(t[k].feature == u[k].feature);
            CHECK(u[k].normal == -t[k].normal);
        }
    }
    CHECK(contact_points(box, {{0, 0, 0.2 - 1e-9}, {}}, plane, {}).size() == 4);
    CHECK(contact_points(plane, {}, plane, {}).empty());
}

TEST_CASE("a round mesh on a plane rests on few points that surround it")
{
    std::vector<Vec3> prism;
    for (int i = 0; i < 100; ++i)
        for (const double z : {-0.5, 0.5}) prism.push_back({std::cos(i * 0.0628318530717958), std::sin(i * 0.0628318530717958), z});
    const auto t = contact_points(hull_of(prism), {{0, 0, 0.5 - 1e-6}, {}}, collider(GeometryKind::Plane), {});
    CHECK(t.size() >= 8);
    CHECK(t.size() <= 9);
    Vec3 sum;
    for (const ContactPoint& k : t)
    {
        sum += k.point;
        CHECK(k.depth == near(1e-6, 1e-9));
    }
    CHECK(length(sum) / static_cast<double>(t.size()) < 0.15);
}

TEST_CASE("box and box: the depth agrees with all separating axes")
{
    const Collider a = collider(GeometryKind::Box, {0.4, 0.3, 0.2}), b = collider(GeometryKind::Box, {0.1, 0.5, 0.25});
    const Hull hull_a = *make_hull(box_corners({0.4, 0.3, 0.2})), hull_b = *make_hull(box_corners({0.1, 0.5, 0.25}));
    std::uint64_t seed = 5;
    double worst = 0;
    int met = 0;
    for (int i = 0; i < 3000; ++i)
    {
        const Pose X{{}, random_rotation(seed)}, Y{random_vector(seed, 0.8), random_rotation(seed)};
        const double want = brute_depth(hull_a, X, hull_b, Y);
        const auto t = contact_points(a, X, b, Y);
        if (std::fabs(want) < 1e-12) continue;
        CHECK(t.empty() == (want < 0));
        if (want < 0) continue;
        ++met;
        worst = std::max(worst, std::fabs(deepest(t) - want));
    }
    MESSAGE("box-box: deepest point against least overlap, worst ", worst, " m of ", met);
    CHECK(worst < 2e-15);
}

TEST_CASE("hulls: they touch exactly if no axis separates them; the depth is the least one")
{
    std::uint64_t seed = 6;
    double worst = 0;
    int met = 0;
    for (int i = 0; i < 600; ++i)
    {
        const Collider a = hull_of(random_points(seed, 12, 0.5));
        const bool round = i % 2 == 1;
        const std::vector<Vec3> points_b = round ? random_points(seed, 20, 0.5) : box_corners({0.3, 0.4, 0.5});
        const Collider b = round ? hull_of(points_b) : collider(GeometryKind::Box, {0.3, 0.4, 0.5});
        const Vec3 n = normalized(random_vector(seed, 1));
        const Pose X{{}, random_rotation(seed)}, Y{n * uniform(seed, 0.5, 1.1), random_rotation(seed)};
        const double want = brute_depth(a.hull(), X, *make_hull(points_b), Y);
        const auto t = contact_points(a, X, b, Y);
        if (std::fabs(want) < 1e-13) continue;
        CHECK(t.empty() == (want < 0));
        if (want < 0) continue;
        ++met;
        worst = std::max(worst, std::fabs(deepest(t) - want));
    }
    MESSAGE("hulls: depth against the least overlap, worst ", worst, " m of ", met);
    CHECK(worst < 1e-14);
    CHECK(met > 150);
}

TEST_CASE("a located hull impact keeps its normal down to the last bits of depth")
{
    const Collider a = hull_of(box_corners({0.5, 0.5, 0.5}));
    for (const double depth : {1e-2, 1e-6, 1e-10, 1e-14})
    {
        const auto t = contact_points(a, {}, a, {{0.2, 0.1, 1 - depth}, {}});
        REQUIRE(t.size() == 4);
        for (const ContactPoint& k : t)
        {
            CHECK(k.normal == Vec3{0, 0, 1});
            CHECK(std::fabs(k.depth - depth) < 2e-16);
        }
    }
}

TEST_CASE("crossed beams as hulls meet in the four corners of their overlap")
{
    const Collider beam = hull_of(box_corners({2, 0.1, 0.1}));
    const Quat quarter{std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
    const auto t = contact_points(beam, {}, beam, {{0, 0, 0.2 - 1e-5}, quarter});
    REQUIRE(t.size() == 4);
    for (const ContactPoint& k : t)
    {
        CHECK(std::fabs(std::fabs(k.point.x) - 0.1) < 1e-12);
        CHECK(std::fabs(std::fabs(k.point.y) - 0.1) < 1e-12);
        CHECK(std::fabs(k.depth - 1e-5) < 1e-15);
    }
}

TEST_CASE("the hull of random points contains them all and is closed")
{
    std::uint64_t seed = 8;
    for (const int n : {4, 10, 200, 2000})
    {
        std::vector<Vec3> points;
        for (int i = 0; i < n; ++i) points.push_back(random_vector(seed, 1));
        const auto hull = make_hull(points);
        REQUIRE(hull.ok());
        double above = 0;
        for (const Vec3& p : points)
            for (std::size_t f = 0; f < hull->faces.size(); ++f) above = std::max(above, dot(hull->normals[f], p) - hull->offsets[f]);
        CHECK(above <= 1e-11);
        CHECK(hull->vertices.size() + hull->faces.size() - 3 * hull->faces.size() / 2 == 2);  // Euler
        CHECK(hull->edges.size() == 3 * hull->faces.size() / 2);
    }
}

TEST_CASE("a hull drops inner and duplicate points, and refuses points without volume")
{
    auto corners = box_corners({1, 1, 1});
    for (const Vec3& p : box_corners({1, 1, 1})) corners.push_back(p);
    for (const Vec3& p : box_corners({1, 1, 1})) corners.push_back(p * 0.5), corners.push_back({p.x, p.y, 0});
    const auto hull = make_hull(corners);
    REQUIRE(hull.ok());
    CHECK(hull->vertices.size() == 8);
    CHECK(hull->faces.size() == 12);
    CHECK(hull->edges.size() == 12);
    CHECK(length(hull->center) < 1e-15);
    const std::vector<Vec3> flat{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.3, 0.2, 0}};
    REQUIRE_FALSE(make_hull(flat).ok());
    CHECK(make_hull(flat).error().reason == "the vertices lie in a plane: their hull has no volume");
    CHECK(make_hull(std::span(flat).first(3)).error().reason == "a hull needs at least 4 vertices, not 3");
}
