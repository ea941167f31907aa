// Contact points: how many, where, how deep, and with which features, of solids that lie, stand, roll and slide.
#include <doctest/doctest.h>

#include <numbers>
#include <set>

#include "bodies.h"

using namespace plab;
using namespace plab::detection;
using namespace plab::test;

namespace
{
const Collider& plane()
{
    static const Collider instance = collider(GeometryKind::Plane, {});
    return instance;
}
std::vector<ContactPoint> points_by_feature(const Collider& a, const Pose& X, const Collider& b, const Pose& Y, double margin = 0)
{
    ContactPoints out(margin);
    collide(a, X, b, Y, out);
    std::vector<ContactPoint> sorted(out.all().begin(), out.all().end());
    std::sort(sorted.begin(), sorted.end(), [](const ContactPoint& s, const ContactPoint& t) { return s.feature < t.feature; });
    return sorted;
}
std::set<std::uint32_t> features(const std::vector<ContactPoint>& t)
{
    std::set<std::uint32_t> out;
    for (const ContactPoint& k : t) out.insert(k.feature);
    return out;
}
Quat about(const Vec3& axis, double angle)
{
    const Vec3 n = normalized(axis) * std::sin(angle / 2);
    return {std::cos(angle / 2), n.x, n.y, n.z};
}
const Quat kLying = about({0, 1, 0}, std::numbers::pi / 2);
}  // namespace

TEST_CASE("stacked boxes: four points at their corners, to the last bit, for a gap as for a depth")
{
    const Collider cube = collider(GeometryKind::Box, {0.5, 0.5, 0.5});
    for (const double depth : {1e-3, 1e-9, 1e-15, -1e-9, -1e-4})
    {
        const auto t = points_by_feature(cube, {}, cube, {{0, 0, 1 - depth}, {}}, 1e-3);
        REQUIRE(t.size() == 4);
        for (const ContactPoint& k : t)
        {
            CHECK(k.normal == Vec3{0, 0, 1});
            CHECK(std::fabs(k.depth - depth) < 3e-16);
            CHECK(std::fabs(std::fabs(k.point.x) - 0.5) < 1e-15);
            CHECK(std::fabs(std::fabs(k.point.y) - 0.5) < 1e-15);
            CHECK(std::fabs(k.point.z - 0.5) < 1e-3);
        }
    }
    CHECK(points_by_feature(cube, {}, cube, {{0, 0, 1 + 1e-9}, {}}).empty());
    CHECK(points_by_feature(cube, {}, cube, {{0, 0, 1 + 2e-3}, {}}, 1e-3).empty());
}

TEST_CASE("an overhanging block ends exactly at the edge below it")
{
    const Collider block = collider(GeometryKind::Box, {0.5, 0.25, 0.05});
    for (const double overhang : {0.1, 0.5 - 1e-6, 0.5 + 1e-6, 0.9})
    {
        const auto t = points_by_feature(block, {}, block, {{overhang, 0, 0.1 - 1e-9}, {}});
        REQUIRE(t.size() == 4);
        double from = 1, to = -1;
        for (const ContactPoint& k : t) from = std::min(from, k.point.x), to = std::max(to, k.point.x);
        CHECK(from == doctest::Approx(overhang - 0.5).epsilon(1e-15).scale(1));
        CHECK(to == doctest::Approx(0.5).epsilon(1e-15).scale(1));
    }
}

TEST_CASE("a point says of which solid it is a corner, in either order, and what round solids pivot about")
{
    const auto count = [](const std::vector<ContactPoint>& points, Pivot::Of of) {
        return std::count_if(points.begin(), points.end(),
                             [&](const ContactPoint& k) { return k.pivot.of == of && k.pivot.arm == Vec3{}; });
    };
    const Collider block = collider(GeometryKind::Box, {0.5, 0.25, 0.05});
    const Collider narrow = collider(GeometryKind::Box, {0.5, 0.2, 0.05});
    const Pose above{{0.1, 0, 0.1 - 1e-9}, {}};
    for (const bool swapped : {false, true})
    {
        CAPTURE(swapped);
        const Pivot::Of upper = swapped ? Pivot::Of::A : Pivot::Of::B;
        const auto pair = swapped ? points_by_feature(narrow, above, block, {}) : points_by_feature(block, {}, narrow, above);
        REQUIRE(pair.size() == 4);
        for (const ContactPoint& k : pair)
        {
            // The narrow block ends inside the other one at x = -0.4. Its sides cross the edge of the other one at 0.5: a pivot of either.
            if (k.point.x < 0) CHECK(k.pivot.of == upper);
            CHECK(k.pivot.of != Pivot::Of::Neither);
        }
        const Pose on_plane{{0, 0, 0.05}, {}};
        const auto stands =
            swapped ? points_by_feature(plane(), {}, block, on_plane, 1e-6) : points_by_feature(block, on_plane, plane(), {}, 1e-6);
        CHECK(count(stands, swapped ? Pivot::Of::B : Pivot::Of::A) == 4);
    }
}

TEST_CASE("round solids pivot about their centres, the centres of their ends and of their rims, on a plane, a box and a hull alike")
{
    const Collider ball = collider(GeometryKind::Sphere, {0.1, 0, 0}), capsule = collider(GeometryKind::Capsule, {0.1, 0, 0.3}),
                   cylinder = collider(GeometryKind::Cylinder, {0.1, 0, 0.3});
    const Collider box = collider(GeometryKind::Box, {2, 2, 0.5}), hull(mesh_of(box_corners({2, 2, 0.5})));
    const Quat tilted = about({0, 1, 0}, 0.4) * about({0, 0, 1}, 0.3);
    const double sine = std::sin(0.4), cosine = std::cos(0.4);
    struct Case
    {
        const Collider* solid;
        Pose X;
        Pivot::Arm kind;
        Vec3 arm;
    };
    const Case cases[] = {
        {&ball, {{0, 0, 0.1}, {}}, Pivot::Arm::Constant, {0, 0, -0.1}},
        {&capsule, {{0, 0, 0.1}, kLying}, Pivot::Arm::Constant, {0, 0, -0.1}},
        {&capsule, {{0, 0, 0.1 + 0.3 * cosine}, tilted}, Pivot::Arm::Constant, {0, 0, -0.1}},
        {&cylinder, {{0, 0, 0.1}, kLying}, Pivot::Arm::OnRim, {0, 0, -0.1}},
        {&cylinder, {{0, 0, 0.1 * sine + 0.3 * cosine}, tilted}, Pivot::Arm::OnRim, {0.1 * cosine, 0, -0.1 * sine}},
    };
    for (const Case& k : cases)
        for (const Collider* floor : {static_cast<const Collider*>(nullptr), &box, &hull})
            for (const bool swapped : {false, true})
            {
                CAPTURE(swapped);
                CAPTURE(floor == nullptr);
                CAPTURE(&k - cases);
                const Collider flat = floor ? *floor : plane();
                const Pose below{{0.3, 0.2, floor ? -0.5 : 0}, {}};
                const auto points =
                    swapped ? points_by_feature(flat, below, *k.solid, k.X, 1e-6) : points_by_feature(*k.solid, k.X, flat, below, 1e-6);
                std::size_t pressing = 0;
                for (const ContactPoint& at : points)
                {
                    if (at.depth < -1e-9 || at.pivot.of == Pivot::Of::Neither) continue;
                    ++pressing;
                    CHECK(at.pivot.of == (swapped ? Pivot::Of::B : Pivot::Of::A));
                    CHECK(at.pivot.kind == k.kind);
                    CHECK(length(at.pivot.arm - k.arm) < 1e-9);
                }
                CHECK(pressing >= 1);
            }
    // A cylinder across a narrow box pivots about its axis where it crosses the sides of the box.
    const Collider beam = collider(GeometryKind::Box, {0.2, 2, 0.5});
    const auto across = points_by_feature(cylinder, {{0, 0, 0.1}, kLying}, beam, {{0, 0, -0.5}, {}}, 1e-6);
    REQUIRE(across.size() == 2);
    for (const ContactPoint& at : across)
    {
        CHECK(at.pivot.of == Pivot::Of::A);
        CHECK(at.pivot.kind == Pivot::Arm::Constant);
        CHECK(length(at.pivot.arm - Vec3{0, 0, -0.1}) < 1e-9);
    }
    // A block that tips over the edge of another: its face turns about a point of that edge.
    const Collider block = collider(GeometryKind::Box, {0.5, 0.2, 0.05}), table = collider(GeometryKind::Box, {1, 1, 0.5});
    const Quat tips = about({0, 1, 0}, 0.05);
    const auto tipping = points_by_feature(block, {Vec3{1, 0, 0} + rotate(tips, {0.1, 0, 0.05 - 1e-9}), tips}, table, {{0, 0, -0.5}, {}});
    REQUIRE(tipping.size() == 2);
    for (const ContactPoint& at : tipping) CHECK(at.pivot.of == Pivot::Of::B);
    // A ball at the edge of a box pivots about no face.
    const auto at_edge = points_by_feature(ball, {{2.07, 0, 0.07}, {}}, box, {{0, 0, -0.5}, {}}, 1e-2);
    REQUIRE(at_edge.size() == 1);
    CHECK(at_edge.front().pivot.of == Pivot::Of::Neither);
}

TEST_CASE("features stay the same while boxes slide, turn and rock a little")
{
    const Collider slab = collider(GeometryKind::Box, {2, 2, 0.1}), cube = collider(GeometryKind::Box, {0.3, 0.3, 0.3});
    const auto first = features(points_by_feature(slab, {}, cube, {{0, 0, 0.4}, {}}, 1e-3));
    CHECK(first.size() == 4);
    std::uint64_t seed = 5;
    for (int i = 0; i < 300; ++i)
    {
        const Pose X{{uniform(seed, -1, 1), uniform(seed, -1, 1), 0.4 + uniform(seed, -1e-4, 1e-4)},
                     about({0, 0, 1}, uniform(seed, -3, 3)) * about({1, uniform(seed, -1, 1), 0}, uniform(seed, -1e-4, 1e-4))};
        CHECK(features(points_by_feature(slab, {}, cube, X, 1e-3)) == first);
    }
}

TEST_CASE("crossing edges: one point, with a normal perpendicular to both; no face is preferred")
{
    const Collider beam = collider(GeometryKind::Box, {1, 0.1, 0.1});
    const Quat on_edge = about({1, 0, 0}, std::numbers::pi / 4);
    const Quat across = about({0, 0, 1}, 1.1) * on_edge;
    const double height = 0.2 * std::sqrt(2.0);
    for (const double depth : {1e-3, 1e-8, -1e-8})
    {
        const auto t = points_by_feature(beam, {{}, on_edge}, beam, {{0.1, 0.05, height - depth}, across}, 1e-6);
        REQUIRE(t.size() == 1);
        CHECK(length(t[0].normal - Vec3{0, 0, 1}) < 1e-14);
        CHECK(std::fabs(t[0].depth - depth) < 1e-15);
    }
}

TEST_CASE("(b, a) is the mirror of (a, b) to the last bit, with features exchanged")
{
    std::uint64_t seed = 9;
    const std::vector<Collider> solids{collider(GeometryKind::Box, {0.4, 0.3, 0.2}), collider(GeometryKind::Capsule, {0.2, 0, 0.4}),
                                       collider(GeometryKind::Cylinder, {0.3, 0, 0.3}), Collider(mesh_of(box_corners({0.2, 0.4, 0.3})))};
    int met = 0;
    for (int i = 0; i < 2000; ++i)
    {
        const Collider &a = solids[static_cast<std::size_t>(i) % 4], &b = solids[static_cast<std::size_t>(i / 4) % 4];
        const Quat q = random_rotation(seed);
        const Pose X{random_vector(seed, 0.1), q}, Y{random_vector(seed, 0.6), i % 3 ? random_rotation(seed) : q};
        ContactPoints one(0.01), other(0.01), again(0.01);
        collide(a, X, b, Y, one), collide(b, Y, a, X, other), collide(a, X, b, Y, again);
        REQUIRE(one.all().size() == other.all().size());
        for (std::size_t k = 0; k < one.all().size(); ++k)
        {
            CHECK(one.all()[k].point == other.all()[k].point);
            CHECK(one.all()[k].normal == -other.all()[k].normal);
            CHECK(one.all()[k].depth == other.all()[k].depth);
            CHECK(one.all()[k].point == again.all()[k].point);
        }
        met += one.all().empty() ? 0 : 1;
    }
    CHECK(met > 500);
}

TEST_CASE("the deepest point is as deep as the solids are, and no point is deeper")
{
    std::uint64_t seed = 21;
    const std::vector<Collider> solids{collider(GeometryKind::Box, {0.4, 0.3, 0.2}), collider(GeometryKind::Capsule, {0.2, 0, 0.4}),
                                       collider(GeometryKind::Cylinder, {0.3, 0, 0.3}), Collider(mesh_of(box_corners({0.2, 0.4, 0.3})))};
    for (int i = 0; i < 1000; ++i)
    {
        const Collider &a = solids[static_cast<std::size_t>(i) % 4], &b = solids[static_cast<std::size_t>(i / 4) % 4];
        const Pose X{{}, random_rotation(seed)}, Y{random_vector(seed, 0.7), random_rotation(seed)};
        const Separation s = separation(a, X, b, Y);
        const auto t = points_by_feature(a, X, b, Y);
        CHECK(t.empty() == (s.gap >= 0));
        double deepest = -1;
        for (const ContactPoint& k : t) deepest = std::max(deepest, k.depth);
        CAPTURE(i);
        if (!t.empty()) CHECK(std::fabs(deepest + s.gap) < 2e-3 * std::fabs(s.gap) + 1e-12);
    }
}

TEST_CASE("a capsule lies on two points, and stands on one")
{
    const Collider pill = collider(GeometryKind::Capsule, {0.1, 0, 0.4}), slab = collider(GeometryKind::Box, {1, 1, 0.1});
    for (const bool on_plane : {true, false})
    {
        const Collider& ground = on_plane ? plane() : slab;
        const double level = on_plane ? 0 : 0.1;
        const auto lying = points_by_feature(pill, {{0, 0, level + 0.1 - 1e-9}, kLying}, ground, {});
        REQUIRE(lying.size() == 2);
        CHECK(std::fabs(lying[0].point.x - lying[1].point.x) == doctest::Approx(0.8).epsilon(1e-12));
        for (const ContactPoint& k : lying) CHECK(std::fabs(k.depth - 1e-9) < 1e-15);
        CHECK(points_by_feature(pill, {{0, 0, level + 0.5 - 1e-9}, {}}, ground, {}).size() == 1);
    }
    const auto side = points_by_feature(pill, {}, pill, {{0.2 - 1e-9, 0, 0.3}, {}});
    REQUIRE(side.size() == 2);
    CHECK(std::fabs(side[0].point.z - side[1].point.z) == doctest::Approx(0.5).epsilon(1e-12));
}

TEST_CASE("a cylinder stands on four points, leans on the exact edge, and rolls on two")
{
    const Collider can = collider(GeometryKind::Cylinder, {0.2, 0, 0.3}), slab = collider(GeometryKind::Box, {1, 1, 0.1});
    for (const bool on_plane : {true, false})
    {
        const Collider& ground = on_plane ? plane() : slab;
        const double level = on_plane ? 0 : 0.1;
        CHECK(points_by_feature(can, {{0.1, 0, level + 0.3 - 1e-9}, {}}, ground, {}).size() == 4);
        const auto rolling = points_by_feature(can, {{0, 0, level + 0.2 - 1e-9}, about({0, 0, 1}, 0.3) * kLying}, ground, {});
        REQUIRE(rolling.size() == 2);
        CHECK(length(rolling[0].point - rolling[1].point) == doctest::Approx(0.6).epsilon(1e-12));
        // Tilted by a in a direction between the four: the lowest point of the rim carries it.
        const double a = 0.2, low = 0.3 * std::cos(a) + 0.2 * std::sin(a);
        const auto leaning = points_by_feature(can, {{0, 0, level + low - 1e-6}, about({1, 0.4, 0}, a)}, ground, {});
        REQUIRE(leaning.size() == 1);
        CHECK(std::fabs(leaning[0].depth - 1e-6) < 1e-12);
    }
}

TEST_CASE("a can on the edge of a table: its points are inside both, on the rim, on the edge and at their intersections")
{
    const Collider can = collider(GeometryKind::Cylinder, {0.2, 0, 0.3}), slab = collider(GeometryKind::Box, {1, 1, 0.1});
    const auto t = points_by_feature(can, {{1.1, 0, 0.4 - 1e-9}, {}}, slab, {});
    REQUIRE(t.size() >= 3);
    double furthest = 0, widest = 0;
    for (const ContactPoint& k : t)
    {
        CHECK(k.point.x < 1 + 1e-8);
        CHECK(std::hypot(k.point.x - 1.1, k.point.y) < 0.2 + 1e-8);
        furthest = std::max(furthest, k.point.x);
        if (k.point.x > 1 - 1e-8) widest = std::max(widest, std::fabs(k.point.y));
    }
    CHECK(furthest == doctest::Approx(1).epsilon(1e-9));
    CHECK(widest == doctest::Approx(std::sqrt(0.04 - 0.01)).epsilon(1e-8));
}

TEST_CASE("a compound's parts collide, each with features of its own")
{
    Bodies bodies;
    Shapes shapes;
    const std::uint32_t floor = add_shape(shapes, GeometryKind::Plane);
    const std::uint32_t left = add_shape(shapes, GeometryKind::Sphere, {0.1, 0, 0}, {{-0.5, 0, 0}, {}});
    const std::uint32_t right = add_shape(shapes, GeometryKind::Sphere, {0.1, 0, 0}, {{0.5, 0, 0}, {}});
    const std::uint32_t both = add_shape(shapes, GeometryKind::Compound, {}, {{0, 0, 0.2}, {}});
    shapes.geometry[both].parts = {left, right};
    add_body(bodies, 0, {}, {}), add_body(bodies, 1, {1, 1, 1}, {0, 0, -0.11});
    bodies.shapes[0] = {{Facet::Shape, floor}}, bodies.shapes[1] = {{Facet::Shape, both}};
    Detection detection;
    detection.between_all(bodies);
    auto found = detection.detect(bodies, shapes);
    REQUIRE(found.size() == 2);
    CHECK(found[0].feature != found[1].feature);
    for (const Contact& c : found)
    {
        CHECK(c.depth == doctest::Approx(0.01).epsilon(1e-13));
        CHECK(std::fabs(c.point.x) == doctest::Approx(0.5).epsilon(1e-13));
    }
    shapes.geometry[right].pose.p.z = 1;  // a change of a part takes effect
    CHECK(detection.detect(bodies, shapes).size() == 1);
}
