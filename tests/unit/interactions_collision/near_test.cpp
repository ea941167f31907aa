// Which pairs may meet within a step, how far bodies are apart, and contacts that are still gaps.
#include <algorithm>
#include <deque>

#include "bodies.h"

using namespace plab;
using namespace plab::test;

namespace
{
struct NearSink final : ContactSink
{
    std::vector<double> how_far;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;

    std::span<const PersistentPair> persistent() const override { return {}; }
    std::span<const double> motion_margin() const override { return how_far; }
    void near(Ref a, Ref b) override { pairs.emplace_back(a.index, b.index); }
    void add(const Contact&) override { CHECK_MESSAGE(false, "no contacts are wanted"); }
    bool precedes(Ref a, Ref b) const override { return a.index < b.index; }
};
struct MarginSink final : ContactSink
{
    double gap = 0;
    std::vector<Contact> contacts;
    std::span<const PersistentPair> persistent() const override { return {}; }
    double margin() const override { return gap; }
    void add(const Contact& c) override { contacts.push_back(c); }
    bool precedes(Ref a, Ref b) const override { return a.index < b.index; }
};

struct MovingCrowd
{
    Bodies bodies;
    Shapes shapes;
    std::uint64_t seed = 5;

    /// `n` balls and boxes in a cube of side `size`, and the ground.
    MovingCrowd(int n, double size)
    {
        const std::uint32_t plane = add_shape(shapes, GeometryKind::Plane), ball = add_shape(shapes, GeometryKind::Sphere, {0.1, 0, 0}),
                            block = add_shape(shapes, GeometryKind::Box, {0.1, 0.05, 0.2});
        bodies.shapes[add_body(bodies, 0, {}, {})].push_back({Facet::Shape, plane});
        for (int i = 0; i < n; ++i)
        {
            const Vec3 p = random_vector(seed, size) + Vec3{0, 0, size};
            const std::uint32_t b = add_body(bodies, 1, {1, 1, 1}, p, {}, random_rotation(seed));
            bodies.shapes[b].push_back({Facet::Shape, i % 2 == 0 ? ball : block});
        }
    }
};
}  // namespace

TEST_CASE("all kinds of search give the same contacts, also the quadtree while bodies leave the bounds for which it was made")
{
    MovingCrowd crowd(300, 1.2);
    std::deque<Detection> spaces;
    for (const char* space : {"simple", "tree", "sweep_and_prune", "quadtree"}) spaces.emplace_back(space);
    for (Detection& d : spaces) d.between_all(crowd.bodies);
    for (int round = 0; round < 8; ++round)
    {
        const std::vector<Contact> want = spaces[0].detect(crowd.bodies, crowd.shapes);
        CHECK(want.size() > 20);
        for (std::size_t k = 1; k < spaces.size(); ++k)
        {
            const std::vector<Contact>& got = spaces[k].detect(crowd.bodies, crowd.shapes);
            REQUIRE(got.size() == want.size());
            for (std::size_t i = 0; i < want.size(); ++i)
            {
                CHECK(got[i].a == want[i].a);
                CHECK(got[i].b == want[i].b);
                CHECK(got[i].feature == want[i].feature);
                CHECK(got[i].depth == want[i].depth);
            }
        }
        // All bodies a little, one of them far.
        for (std::uint32_t b = 1; b < crowd.bodies.size(); ++b) crowd.bodies.position[b] += random_vector(crowd.seed, 0.05);
        for (std::uint32_t b = 1; b < 20; ++b) crowd.bodies.position[b] += random_vector(crowd.seed, 3);
    }
}

TEST_CASE("the pairs that may meet are all those whose bounds, expanded by their motion, overlap; half-spaces too")
{
    for (const char* space : {"simple", "tree", "sweep_and_prune", "quadtree"})
    {
        CAPTURE(space);
        MovingCrowd crowd(120, 3);
        Detection d(space);
        d.between_all(crowd.bodies);
        NearSink sink;
        for (int round = 0; round < 4; ++round)
        {
            sink.how_far.assign(crowd.bodies.size(), 0.0), sink.pairs.clear();
            for (std::uint32_t b = 1; b < crowd.bodies.size(); ++b) sink.how_far[b] = uniform(crowd.seed, 0, round == 2 ? 2 : 0.3);
            sink.how_far[7] = round == 3 ? 16 : 0;
            REQUIRE(detection::detect({}, 0, d.rows, crowd.bodies, crowd.shapes, {}, sink));
            std::size_t missed = 0, idle = 0;
            for (std::uint32_t a = 0; a < crowd.bodies.size(); ++a)
                for (std::uint32_t b = a + 1; b < crowd.bodies.size(); ++b)
                {
                    const bool named = std::find(sink.pairs.begin(), sink.pairs.end(), std::pair(a, b)) != sink.pairs.end();
                    // Balls that contain a shape in any orientation: no pair closer than that may be left out.
                    const double inner = b % 2 == 1 ? 0.1 : 0.05, outer = b % 2 == 1 ? 0.1 : 0.23,
                                 method = sink.how_far[a] + sink.how_far[b];
                    const double inner_a = a % 2 == 1 ? 0.1 : 0.05, outer_a = a % 2 == 1 ? 0.1 : 0.23;
                    const double distance =
                        a == 0 ? crowd.bodies.position[b].z : length(crowd.bodies.position[a] - crowd.bodies.position[b]);
                    missed += !named && distance < method + inner + (a == 0 ? 0 : inner_a);
                    idle += named && distance > 1.8 * method + 1.8 * (outer + (a == 0 ? 0 : outer_a));
                }
            CHECK(missed == 0);
            CHECK(idle == 0);
        }
    }
}

TEST_CASE("gaps: sphere, box and plane, apart and overlapping")
{
    Bodies bodies;
    Shapes shapes;
    const std::uint32_t plane = add_shape(shapes, GeometryKind::Plane), ball = add_shape(shapes, GeometryKind::Sphere, {0.1, 0, 0}),
                        block = add_shape(shapes, GeometryKind::Box, {0.3, 0.2, 0.1});
    for (const auto& [shape, mass] : {std::pair(plane, 0.0), std::pair(ball, 1.0), std::pair(block, 1.0)})
        bodies.shapes[add_body(bodies, mass, {1, 1, 1}, {})].push_back({Facet::Shape, shape});
    bodies.position[1] = {1, 0, 0.35}, bodies.position[2] = {0, 0, 0.5};
    Detection d;
    d.between_all(bodies);
    (void)d.detect(bodies, shapes);
    const auto gap = [&](std::uint32_t a, std::uint32_t b)
    {
        GapQuery q;
        q.a = body(a), q.b = body(b);
        REQUIRE(detection::measure_gap(0, d.rows, bodies, {}, q));
        return q;
    };
    CHECK(gap(0, 1).gap == near(0.25, 1e-15));
    CHECK(length(gap(0, 1).normal - Vec3{0, 0, 1}) < 1e-15);
    CHECK(length(gap(0, 1).point_b - Vec3{1, 0, 0.25}) < 1e-15);
    CHECK(gap(0, 2).gap == near(0.4, 1e-15));
    CHECK(gap(1, 2).gap == near(std::hypot(0.7, 0.05) - 0.1, 1e-14));
    CHECK(gap(1, 2).normal.x == near(-0.7 / std::hypot(0.7, 0.05), 1e-14));
    bodies.position[1].z = 0.09;
    CHECK(gap(0, 1).gap == near(-0.01, 1e-13));
    // The gap to a plane moves with the body at any distance from the origin of W.
    bodies.position[1] = {1e7, 1e7, 0.1 + 1e-9};
    CHECK(gap(0, 1).gap == near(1e-9, 1e-6));
}

TEST_CASE("contacts with a gap up to the margin are reported with a negative depth")
{
    Bodies bodies;
    Shapes shapes;
    const std::uint32_t ball = add_shape(shapes, GeometryKind::Sphere, {0.1, 0, 0});
    for (const double x : {0.0, 0.25, 0.52, 0.9}) bodies.shapes[add_body(bodies, 1, {1, 1, 1}, {x, 0, 0})].push_back({Facet::Shape, ball});
    Detection d;
    d.between_all(bodies);
    MarginSink sink;
    sink.gap = 0.06;
    REQUIRE(detection::detect({}, 0, d.rows, bodies, shapes, {}, sink));
    REQUIRE(sink.contacts.size() == 1);
    CHECK(sink.contacts[0].depth == near(-0.05, 1e-14));
    CHECK(sink.contacts[0].b.index == 1);
    sink.contacts.clear(), sink.gap = 0.3;
    REQUIRE(detection::detect({}, 0, d.rows, bodies, shapes, {}, sink));
    CHECK(sink.contacts.size() == 3);
    sink.contacts.clear(), sink.gap = 0;
    REQUIRE(detection::detect({}, 0, d.rows, bodies, shapes, {}, sink));
    CHECK(sink.contacts.empty());
}
