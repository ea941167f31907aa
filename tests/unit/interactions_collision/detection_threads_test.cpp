// Detection divides its work among threads: no part of it is left out or done twice, and the order of contacts does not depend on them.
#include <doctest/doctest.h>

#include <algorithm>
#include <tuple>

#include "bodies.h"

using namespace plab;
using namespace plab::test;

namespace
{
/// Says that it has any number of threads, and runs the jobs alone in an order that no detection should rely on.
class ShuffledWorkers final : public Workers
{
public:
    explicit ShuffledWorkers(int threads) : threads_(threads) {}
    int threads() const override { return threads_; }
    std::size_t jobs() const { return jobs_; }

private:
    void run_jobs(std::size_t count, Call call, void* job) override
    {
        std::vector<std::size_t> order(count);
        for (std::size_t i = 0; i < count; ++i) order[i] = i;
        for (std::size_t k = count; k-- > 1;) std::swap(order[k], order[next_random(seed_) % (k + 1)]);
        for (const std::size_t i : order) call(job, i);
        jobs_ += count;
    }
    int threads_;
    std::uint64_t seed_ = 5;
    std::size_t jobs_ = 0;
};

constexpr double kRadius = 0.1, kSide = 1.5;

/// Balls, boxes, hulls and compounds of two balls over a plane, as dense as a heap. The first `balls` of them are balls.
struct Heap
{
    Bodies bodies;
    Shapes shapes;

    explicit Heap(std::uint32_t balls, std::uint32_t others)
    {
        const std::uint32_t ball = add_shape(shapes, GeometryKind::Sphere, {kRadius, 0, 0});
        const std::uint32_t box = add_shape(shapes, GeometryKind::Box, {0.08, 0.09, 0.1});
        shapes.geometry.push_back(mesh_of(box_corners({0.1, 0.05, 0.08})));
        const std::uint32_t left = add_shape(shapes, GeometryKind::Sphere, {kRadius, 0, 0}, {{-0.07, 0, 0}, {}});
        const std::uint32_t right = add_shape(shapes, GeometryKind::Sphere, {kRadius, 0, 0}, {{0.07, 0, 0}, {}});
        const std::uint32_t plane = add_shape(shapes, GeometryKind::Plane);
        std::uint64_t seed = 71;
        for (std::uint32_t i = 0; i < balls + others; ++i)
        {
            const std::uint32_t b =
                add_body(bodies, 1, {1, 1, 1}, random_vector(seed, kSide), random_vector(seed, 1), random_rotation(seed));
            const std::uint32_t k = i < balls ? 0 : i % 4;
            bodies.shapes[b] = {{Facet::Shape, std::array{ball, box, 2u, left}[k]}};
            if (k == 3) bodies.shapes[b].push_back({Facet::Shape, right});
        }
        bodies.shapes[add_body(bodies, 0, {1, 1, 1}, {0, 0, -kSide})] = {{Facet::Shape, plane}};
    }
    void advance(double h)
    {
        for (std::uint32_t b = 0; b < bodies.size(); ++b) bodies.position[b] += bodies.velocity[b] * h;
    }
};

bool same_contacts(const std::vector<Contact>& x, const std::vector<Contact>& y)
{
    const auto key = [](const Contact& c)
    { return std::tuple(c.a, c.b, c.feature, c.point.x, c.point.y, c.point.z, c.normal.x, c.normal.y, c.normal.z, c.depth); };
    return std::equal(x.begin(), x.end(), y.begin(), y.end(), [&](const Contact& c, const Contact& d) { return key(c) == key(d); });
}
}  // namespace

TEST_CASE("with threads, each pair of touching balls is found exactly once")
{
    Heap heap(2500, 0);
    Detection d;
    d.between_all(heap.bodies);
    ShuffledWorkers workers(4);
    StepContext context;
    context.workers = &workers;
    for (int step = 0; step < 4; ++step, heap.advance(step == 2 ? 1e-3 : 0.02))
    {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> want, found;
        for (std::uint32_t i = 0; i < 2500; ++i)
        {
            for (std::uint32_t j = i + 1; j < 2500; ++j)
                if (length(heap.bodies.position[i] - heap.bodies.position[j]) < 2 * kRadius) want.emplace_back(i, j);
            if (heap.bodies.position[i].z < kRadius - kSide) want.emplace_back(i, 2500u);
        }
        for (const Contact& c : d.detect(heap.bodies, heap.shapes, context)) found.emplace_back(c.a.index, c.b.index);
        CHECK(want.size() > 3000);  // many chunks
        CHECK(found == want);       // in the order of pairs
    }
    CHECK(workers.jobs() > 4 * 30);
}

TEST_CASE("contacts of a heap of mixed shapes do not depend on the number of threads or on the search")
{
    std::vector<ShuffledWorkers> workers{ShuffledWorkers(1), ShuffledWorkers(2), ShuffledWorkers(3), ShuffledWorkers(16)};
    std::vector<Detection> detections(workers.size());
    Detection simple("simple"), alone;
    Heap heap(300, 1200);
    for (Detection& d : detections) d.between_all(heap.bodies);
    simple.between_all(heap.bodies), alone.between_all(heap.bodies);
    // Few boxes are left in the second half of the run, many in the first.
    for (int step = 0; step < 40; ++step, heap.advance(step < 20 ? 0.01 : 5e-4))
    {
        const std::vector<Contact>& want = alone.detect(heap.bodies, heap.shapes);
        REQUIRE(want.size() > 2000);
        if (step % 8 == 0) CHECK(same_contacts(want, simple.detect(heap.bodies, heap.shapes)));
        for (std::size_t k = 0; k < workers.size(); ++k)
        {
            StepContext context;
            context.workers = &workers[k];
            CHECK(same_contacts(want, detections[k].detect(heap.bodies, heap.shapes, context)));
            CHECK(detections[k].rows.pairs[0] == alone.rows.pairs[0]);
            CHECK(detections[k].rows.penetration[0] == alone.rows.penetration[0]);
        }
    }
}
