// Collision/Exclude: bodies and shapes that do not collide although a detection names them.
#include <doctest/doctest.h>

#include "bodies.h"
#include "detection/exclude.h"

using namespace plab;
using namespace plab::test;

namespace
{

Ref shape(std::uint32_t i) { return {Facet::Shape, i}; }

/// Four balls of radius 0.5 in a row, each of which overlaps its neighbours; the first has a second ball below.
struct Row4
{
    Bodies bodies;
    Shapes shapes;
    Detection d;

    explicit Row4(const char* space = "tree") : d(space)
    {
        const std::uint32_t ball = add_shape(shapes, GeometryKind::Sphere, {0.5, 0, 0});
        const std::uint32_t below = add_shape(shapes, GeometryKind::Sphere, {0.5, 0, 0}, {{0.1, 0, -0.1}, {}});
        for (std::uint32_t i = 0; i < 4; ++i)
        {
            add_sphere(bodies, 1, 0.5, {0.9 * i, 0, 0});
            bodies.shapes[i] = {shape(ball)};
        }
        bodies.shapes[0].push_back(shape(below));
        d.between_all(bodies);
    }
    /// "01 12": the pairs of bodies that touch, a digit each; with several contacts several times.
    std::string pairs()
    {
        std::string out;
        for (const Contact& c : d.detect(bodies, shapes))
            out += (out.empty() ? "" : " ") + std::to_string(c.a.index) + std::to_string(c.b.index);
        return out;
    }
    double gap(std::uint32_t a, std::uint32_t b)
    {
        GapQuery query;
        query.a = body(a), query.b = body(b);
        REQUIRE(detection::measure_gap(0, d.rows, bodies, d.filter, query));
        return query.gap;
    }
};

}  // namespace

TEST_CASE("excluded bodies do not touch, whatever space searches for pairs")
{
    for (const char* space : {"tree", "simple", "sweep_and_prune", "quadtree"})
    {
        CAPTURE(space);
        Row4 row(space);
        CHECK(row.pairs() == "01 01 12 23");
        row.d.filter.exclude_within(std::vector{body(1), body(2)});
        CHECK(row.pairs() == "01 01 23");
        row.d.filter.exclude_between(std::vector{body(0), body(3)}, std::vector{body(1), body(2)});
        CHECK(row.pairs() == "");
        row.d.filter.clear();
        CHECK(row.pairs() == "01 01 12 23");
    }
}

TEST_CASE("an exclusion between two sets leaves each of them alone")
{
    Row4 row;
    row.d.filter.exclude_between(std::vector{body(0), body(1)}, std::vector{body(2), body(3)});
    CHECK(row.pairs() == "01 01 23");
}

TEST_CASE("single shapes are excluded from bodies and from shapes")
{
    for (const bool from_shape : {false, true})
    {
        Row4 row;
        row.d.filter.exclude_between(std::vector{shape(1)}, std::vector{from_shape ? shape(0) : body(1)});
        CHECK(row.pairs() == "01 12 23");
        const double gap = row.gap(0, 1);
        CHECK(gap == doctest::Approx(-0.1));  // that of the first ball
        row.d.filter.clear();
        CHECK(row.gap(0, 1) < -0.17);
    }
}

TEST_CASE("excluded bodies have no gap and are no pair that may collide; a pair that touched parts")
{
    struct Near final : ContactSink
    {
        std::vector<double> margins{1, 1, 1, 1};
        std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
        std::span<const PersistentPair> persistent() const override { return {}; }
        std::span<const double> motion_margin() const override { return margins; }
        void near(Ref a, Ref b) override { found.emplace_back(a.index, b.index); }
        void add(const Contact&) override {}
        bool precedes(Ref a, Ref b) const override { return a.index < b.index; }
    };
    Row4 row;
    row.d.sink.pairs = {{body(1), body(2), {}}};
    CHECK(row.pairs() == "12 01 01 23");
    row.d.filter.exclude_within(std::vector{body(0), body(1), body(2)});
    CHECK(row.pairs() == "23");
    CHECK(row.gap(1, 2) == HUGE_VAL);
    Near near;
    REQUIRE(detection::detect({}, 0, row.d.rows, row.bodies, row.shapes, row.d.filter, near));
    std::sort(near.found.begin(), near.found.end());
    CHECK(near.found == std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 3}, {1, 3}, {2, 3}});
}

TEST_CASE("a base with thousands of neighbours costs a search, not a walk")
{
    CollisionFilter filter;
    for (std::uint32_t i = 1; i < 5000; ++i) filter.exclude_within(std::vector{body(0), body(i)});
    CHECK(filter.excludes_bodies(0, 4999));
    CHECK(filter.excludes_bodies(17, 0));
    CHECK(!filter.excludes_bodies(17, 18));
    CHECK(!filter.excludes_bodies(0, 5000));
    CHECK(!filter.has_shapes());
}

TEST_CASE("an exclusion of nothing is refused")
{
    OneRow<detection::ExcludeRows> row;
    const auto refusal = [&]
    {
        const auto done = detection::prepare_exclude(0, row.rows);
        return done ? std::string() : done.error().reason;
    };
    CHECK(refusal() == "excludes nothing: give within, or a and b");
    row.rows.a[0] = {body(0)};
    CHECK(refusal() == "a and b belong together: none of a collides with one of b");
    row.rows.b[0] = {body(1)};
    CHECK(refusal().empty());
    CollisionFilter filter;
    detection::connect_exclude(0, row.rows, filter);
    CHECK(filter.excludes_bodies(1, 0));
}
