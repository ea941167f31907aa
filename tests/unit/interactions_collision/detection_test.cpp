// The detection component: which pairs are tested, in what order, and the effect of persistent pairs.
#include <doctest/doctest.h>

#include <array>
#include <tuple>

#include "bodies.h"
#include "support/events.h"

using namespace plab;
using namespace plab::test;

namespace
{
/// A cloud of spheres, boxes and hulls over a plane; `order` says in which order the bodies were made.
struct Cloud
{
    Bodies bodies;
    Shapes shapes;
    std::vector<std::uint32_t> rank;  // place in the order of ids, by row

    explicit Cloud(const std::vector<std::uint32_t>& order)
    {
        const std::uint32_t ball = add_shape(shapes, GeometryKind::Sphere, {0.4, 0, 0});
        const std::uint32_t box = add_shape(shapes, GeometryKind::Box, {0.3, 0.4, 0.35});
        const std::uint32_t plane = add_shape(shapes, GeometryKind::Plane);
        shapes.geometry.push_back(mesh_of({{-0.4, -0.4, -0.3}, {0.5, 0, -0.3}, {-0.4, 0.5, -0.2}, {0, 0, 0.6}, {0.1, 0.1, -0.5}}));
        for (const std::uint32_t id : order)
        {
            std::uint64_t seed = 100 + id;
            const std::uint32_t i = add_body(bodies, id == 0 ? 0 : 1, {1, 1, 1}, id == 0 ? Vec3{} : random_vector(seed, 1.2), {},
                                             id == 0 ? Quat{} : random_rotation(seed));
            bodies.shapes[i] = {{Facet::Shape, id == 0 ? plane : std::array{ball, box, 3u}[id % 3]}};
            rank.push_back(id);
        }
    }
    /// Contacts with rows replaced by ids, sorted as the host would.
    std::vector<Contact> detect(const char* space, bool stir) const
    {
        Detection d(space);
        d.sink.rank = rank;
        d.between_all(bodies);
        auto& between = d.rows.between[0];
        std::sort(between.begin(), between.end(), [&](Ref a, Ref b) { return rank[a.index] < rank[b.index]; });
        if (stir)
        {
            Bodies moved = bodies;
            for (std::uint32_t k = 0; k < 5; ++k)
                for (std::uint32_t i = static_cast<std::uint32_t>(moved.size()); i-- > 1;)
                {
                    moved.position[i].x += (i + k) % 3 ? 0.7 : -0.9;
                    if ((i + k) % 4 == 0) d.detect(moved, shapes);
                }
        }
        std::vector<Contact> out = d.detect(bodies, shapes);
        for (Contact& c : out) c.a.index = rank[c.a.index], c.b.index = rank[c.b.index];
        std::sort(out.begin(), out.end(),
                  [](const Contact& x, const Contact& y) { return std::tie(x.a, x.b, x.feature) < std::tie(y.a, y.b, y.feature); });
        return out;
    }
};
bool same(const std::vector<Contact>& x, const std::vector<Contact>& y)
{
    return std::equal(
        x.begin(), x.end(), y.begin(), y.end(),
        [](const Contact& a, const Contact& b)
        { return a.a == b.a && a.b == b.b && a.feature == b.feature && a.point == b.point && a.normal == b.normal && a.depth == b.depth; });
}

/// A ball of radius 0.1 above a level plane.
struct BallOnPlane
{
    Bodies bodies;
    Shapes shapes;
    Detection d;
    explicit BallOnPlane(double height)
    {
        add_body(bodies, 0, {}, {});
        add_sphere(bodies, 1, 0.1, {0, 0, height});
        bodies.shapes[0] = {{Facet::Shape, add_shape(shapes, GeometryKind::Plane)}};
        bodies.shapes[1] = {{Facet::Shape, add_shape(shapes, GeometryKind::Sphere, {0.1, 0, 0})}};
        d.between_all(bodies);
    }
    const std::vector<Contact>& detect(const StepContext& context = {}) { return d.detect(bodies, shapes, context); }
};

}  // namespace

TEST_CASE("no order of creation or of moves, and no kind of space, affects the contacts")
{
    std::vector<std::uint32_t> order(40);
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto first = Cloud(order).detect("simple", false);
    CHECK(first.size() > 60);
    CHECK(same(first, Cloud(order).detect("simple", true)));
    CHECK(same(first, Cloud(order).detect("tree", true)));
    CHECK(same(first, Cloud(order).detect("sweep_and_prune", true)));
    std::uint64_t seed = 17;
    for (int i = 0; i < 5; ++i)
    {
        for (std::size_t k = order.size(); k-- > 1;) std::swap(order[k], order[next_random(seed) % (k + 1)]);
        for (const char* space : {"simple", "tree", "sweep_and_prune"})
        {
            CHECK(same(first, Cloud(order).detect(space, false)));
            CHECK(same(first, Cloud(order).detect(space, true)));
        }
    }
}

TEST_CASE("the spaces lose no pair: they find all pairs of a brute-force search")
{
    std::uint64_t seed = 23;
    Bodies bodies;
    Shapes shapes;
    const std::uint32_t small = add_shape(shapes, GeometryKind::Sphere, {0.02, 0, 0}),
                        large = add_shape(shapes, GeometryKind::Sphere, {2, 0, 0});
    for (std::uint32_t i = 0; i < 500; ++i)
    {
        add_sphere(bodies, 1, 1, random_vector(seed, 3));
        bodies.shapes[i] = {{Facet::Shape, i % 50 ? small : large}};
    }
    std::size_t want = 0;
    for (std::uint32_t i = 0; i < 500; ++i)
        for (std::uint32_t j = i + 1; j < 500; ++j)
            want += length(bodies.position[i] - bodies.position[j]) < (i % 50 ? 0.02 : 2.0) + (j % 50 ? 0.02 : 2.0);
    for (const char* space : {"simple", "tree", "sweep_and_prune"})
    {
        Detection d(space);
        d.between_all(bodies);
        CHECK(d.detect(bodies, shapes).size() == want);
        CHECK(d.rows.pairs[0] >= static_cast<std::int64_t>(want));
    }
}

TEST_CASE("depth is exact to the last bit near the ground and to 1e-8 m ten thousand kilometres away")
{
    BallOnPlane ball(0.1 - 1e-15);
    REQUIRE(ball.detect().size() == 1);
    CHECK(ball.detect()[0].depth == 0.1 - (0.1 - 1e-15));
    CHECK(ball.detect()[0].normal == Vec3{0, 0, 1});
    CHECK(ball.d.rows.penetration[0] == ball.detect()[0].depth);
    ball.bodies.position[1] = {1e7, 1e7, 0.1 - 1e-9};
    REQUIRE(ball.detect().size() == 1);
    CHECK(std::fabs(ball.detect()[0].depth - 1e-9) < 1e-16);
}

TEST_CASE("a persistent pair is tested after its shift, and its gap is reported")
{
    BallOnPlane ball(0.1 + 3e-10);
    CHECK(ball.detect().empty());
    ball.d.sink.pairs = {{body(0), body(1), {0, 0, -1e-9}}};
    REQUIRE(ball.detect().size() == 1);
    CHECK(ball.detect()[0].depth == near(-3e-10, 1e-6));
    ball.bodies.position[1].z = 0.1 + 2e-9;
    CHECK(ball.detect().empty());
    ball.bodies.position[1].z = 0.1 - 1e-6;
    REQUIRE(ball.detect().size() == 1);  // once, not twice
    CHECK(ball.detect()[0].depth == near(1e-6, 1e-9));
    ball.d.sink.pairs = {{body(1), body(0), {0, 0, 1e-9}}};  // the reverse order gives the same
    REQUIRE(ball.detect().size() == 1);
    CHECK(ball.detect()[0].a == body(0));
    CHECK(ball.detect()[0].depth == near(1e-6, 1e-9));
}

TEST_CASE("a resting box keeps its four corners, with the same features, despite rounding")
{
    Bodies bodies;
    Shapes shapes;
    add_body(bodies, 0, {}, {});
    add_body(bodies, 1, {1, 1, 1}, {});
    for (std::uint32_t i = 0; i < 2; ++i)
        bodies.shapes[i] = {{Facet::Shape, add_shape(shapes, GeometryKind::Box, {0.5 + 0.5 * (1 - i), 0.5, 0.5})}};
    Detection d;
    d.between_all(bodies);
    d.sink.pairs = {{body(0), body(1), {0, 0, -1e-9}}};
    std::vector<Contact> first;
    std::uint64_t seed = 31;
    const auto tilt = [&] { return uniform(seed, -1e-12, 1e-12); };
    for (int i = 0; i < 200; ++i)
    {
        bodies.position[1] = Vec3{0.1, 0.2, 1} + random_vector(seed, 1e-12);
        bodies.orientation[1] = normalized(Quat{1, tilt(), tilt(), tilt()});
        const std::vector<Contact> now = d.detect(bodies, shapes);
        REQUIRE(now.size() == 4);
        if (first.empty()) first = now;
        for (std::size_t k = 0; k < 4; ++k)
        {
            CHECK(now[k].feature == first[k].feature);
            CHECK(length(now[k].point - first[k].point) < 1e-8);
        }
    }
}

TEST_CASE("only pairs with an active body are tested, and never two bodies that do not move")
{
    BallOnPlane ball(0.05);
    add_sphere(ball.bodies, 1, 0.1, {0.05, 0, 0.05});
    add_body(ball.bodies, 0, {}, {0, 0, 0.02});
    ball.bodies.shapes[2] = ball.bodies.shapes[3] = ball.bodies.shapes[1];
    ball.d.between_all(ball.bodies);
    CHECK(ball.detect().size() == 5);  // 0-1 0-2 1-2 1-3 2-3, not 0-3
    const std::vector<std::uint8_t> active{0, 0, 1, 0};
    StepContext context;
    context.active_bodies = active;
    for (const Contact& c : ball.detect(context)) CHECK((c.a == body(2) || c.b == body(2)));
    CHECK(ball.detect(context).size() == 3);
    ball.bodies.motion[1] = Motion::Kinematic;
    CHECK(ball.detect().size() == 3);
}

TEST_CASE("`against` collides with `between` only")
{
    Bodies bodies;
    Shapes shapes;
    const std::uint32_t s = add_shape(shapes, GeometryKind::Sphere, {1, 0, 0});
    for (std::uint32_t i = 0; i < 4; ++i)
    {
        add_sphere(bodies, 1, 1, {0.1 * i, 0, 0});
        bodies.shapes[i] = {{Facet::Shape, s}};
    }
    Detection d;
    d.rows.between[0] = {body(1)};
    d.rows.against[0] = {body(0), body(1), body(2), body(3)};
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (const Contact& c : d.detect(bodies, shapes)) pairs.emplace_back(c.a.index, c.b.index);
    CHECK(pairs == std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 1}, {1, 2}, {1, 3}});
    d.rows.between[0].clear();
    CHECK(d.detect(bodies, shapes).empty());
}

TEST_CASE("a change of shape, pose or membership takes effect at the next detection")
{
    BallOnPlane ball(0.15);
    CHECK(ball.detect().empty());
    ball.shapes.geometry[1].size.x = 0.2;
    CHECK(ball.detect().size() == 1);
    ball.shapes.geometry[1].pose.p = {0, 0, 0.1};
    CHECK(ball.detect().empty());
    ball.shapes.geometry[1] = mesh_of(box_corners({0.2, 0.2, 0.2}));
    CHECK(ball.detect().size() == 4);
    ball.shapes.geometry[1].vertices[0].z = -3;
    CHECK(ball.detect().size() > 0);
    CHECK(ball.d.rows.penetration[0] == near(2.85, 1e-12));
    ball.shapes.geometry[1].hull_collides = false;
    CHECK(ball.detect().empty());
    ball.shapes.geometry[1].hull_collides = true;
    ball.bodies.shapes[1].push_back(ball.bodies.shapes[1][0]);
    const std::size_t twice = ball.detect().size();
    ball.bodies.shapes[1].pop_back();
    CHECK(twice == 2 * ball.detect().size());
    detection::prepare(0, ball.d.rows);
    CHECK(ball.detect().size() * 2 == twice);
    ball.d.rows.between[0].pop_back();
    CHECK(ball.detect().empty());
}

TEST_CASE("a plane tilts with its body, and a centre of mass off the origin is taken into account")
{
    BallOnPlane ball(0.1);
    const double angle = 0.3;
    ball.bodies.orientation[0] = {std::cos(angle / 2), std::sin(angle / 2), 0, 0};
    ball.bodies.center_B[1] = {0, 0, 0.05};
    ball.bodies.position[1] = {0, -0.1 * std::sin(angle), 0.1 * std::cos(angle) + 0.05};  // the ball's centre 0.05 below
    ball.bodies.position[1] += rotate(ball.bodies.orientation[0], {0, 0, -1e-3});
    REQUIRE(ball.detect().size() == 1);
    CHECK(ball.detect()[0].depth == near(1e-3, 1e-12));
    CHECK(length(ball.detect()[0].normal - Vec3{0, -std::sin(angle), std::cos(angle)}) < 1e-15);
}

TEST_CASE("a mesh without volume is reported, once per build")
{
    BallOnPlane ball(0.05);
    ball.shapes.geometry[1] = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
    Events events;
    StepContext context;
    context.events = &events;
    CHECK(ball.detect(context).empty());
    ball.detect(context);
    REQUIRE(events.all.size() == 1);
    CHECK(events.all[0].message == "the shape does not collide: the vertices lie in a plane: their hull has no volume");
    CHECK(events.all[0].a == Ref{Facet::Shape, 1});
}

TEST_CASE("two scenes in one process do not affect one another")
{
    BallOnPlane one(0.05), two(0.07);
    const Contact alone = one.detect()[0];
    two.detect();
    const Contact together = one.detect()[0];
    CHECK(alone.depth == together.depth);
    CHECK(two.detect()[0].depth == near(0.03, 1e-12));
}

TEST_CASE("ten thousand bodies in a heap of cells")
{
    Bodies bodies;
    Shapes shapes;
    const std::uint32_t s = add_shape(shapes, GeometryKind::Sphere, {0.51, 0, 0});
    for (std::uint32_t i = 0; i < 10000; ++i)
    {
        add_sphere(bodies, 1, 0.51, {static_cast<double>(i % 100), static_cast<double>(i / 100), 0});
        bodies.shapes[i] = {{Facet::Shape, s}};
    }
    for (const char* space : {"tree", "sweep_and_prune"})
    {
        Detection d(space);
        d.between_all(bodies);
        CHECK(d.detect(bodies, shapes).size() == 2 * 99 * 100);
    }
}
