// Newton's method on the contact law, against closed forms of the law.
#include <algorithm>
#include <cmath>

#include "islands.h"
#include "managers/newton.h"
#include "plab/random.h"
#include "support/gravity.h"

using namespace plab;
using namespace plab::managers;
using plab::test::IslandWorld;
using plab::test::kG;
using plab::test::kStep;
using plab::test::problem_of;

namespace
{

double normal_sum(const Problem& p, std::size_t first, std::size_t count)
{
    double sum = 0;
    for (std::size_t i = first; i < first + count; ++i) sum += p.points[i].impulse.z;
    return sum;
}

}  // namespace

TEST_CASE("a stack of n boxes carries its weight, from a cold start, in a few iterations for any n")
{
    for (const std::size_t n : {1u, 2u, 10u, 50u, 100u})
    {
        CAPTURE(n);
        IslandWorld w;
        w.add_stack(std::vector<double>(n, 1.0), 0.8);
        w.kick({0, 0, -kG * kStep});
        Problem p = problem_of(w);
        const Solved s = NewtonSolver().solve(p, {});
        CHECK(s.converged);
        CHECK_FALSE(s.fell_back);
        CHECK(s.steps <= 12);
        const double weight = kG * kStep;
        for (std::size_t k = 0; k < n; ++k)
            CHECK(normal_sum(p, 4 * k, 4) == doctest::Approx(weight * static_cast<double>(n - k)).epsilon(1e-10));
    }
}

TEST_CASE("D1: a heavy box on a light one, mass ratios to 1e8: both loads to 1e-10")
{
    for (const double r : {1.0, 1e2, 1e4, 1e6, 1e8})
    {
        CAPTURE(r);
        IslandWorld w;
        w.add_stack({1, r}, 0.8);
        w.kick({0, 0, -kG * kStep});
        Problem p = problem_of(w);
        const Solved s = NewtonSolver().solve(p, {});
        CHECK(s.converged);
        CHECK(normal_sum(p, 0, 4) == doctest::Approx((1 + r) * kG * kStep).epsilon(1e-10));
        CHECK(normal_sum(p, 4, 4) == doctest::Approx(r * kG * kStep).epsilon(1e-10));
    }
}

TEST_CASE("a solution is a fixed point: no iteration is made from it")
{
    IslandWorld w;
    w.add_stack(std::vector<double>(20, 1.0), 0.8);
    w.kick({0, 0, -kG * kStep});
    Problem p = problem_of(w);
    NewtonSolver solver;
    (void)solver.solve(p, {});
    CHECK(solver.solve(p, {}).steps == 0);
}

TEST_CASE("friction is a cone: a sliding box is braked by mu m g against its slip, equally in every direction")
{
    const double mu = 0.3;
    for (int k = 0; k < 12; ++k)
    {
        const double angle = 0.5235987755982988 * k + 0.05;
        IslandWorld w;
        w.add_stack({2}, mu);
        const Vec3 along{std::cos(angle), std::sin(angle), 0};
        w.kick(along * 3.0 + Vec3{0, 0, -kG * kStep});
        Problem p = problem_of(w);
        const Solved s = NewtonSolver().solve(p, {});
        CHECK(s.converged);
        // Its corners slip equally only if it does not tip over: mu h < half its width.
        CHECK(length(p.movers[0].v - along * (3 - mu * kG * kStep)) < 1e-12);
        for (const Point& q : p.points) CHECK(std::hypot(q.impulse.x, q.impulse.y) == doctest::Approx(mu * q.impulse.z).epsilon(1e-9));
    }
}

TEST_CASE("D6: a table with four legs: the load is distributed evenly, as nothing determines otherwise")
{
    IslandWorld w;
    const auto ground = w.add_box(0, {5, 5, 1}, {0, 0, -1}), table = w.add_box(8, {1, 0.6, 0.4}, {0, 0, 0.4});
    w.add_face(ground, table, {0, 0, 0}, 1, 0.6, 0.5);
    w.kick({0, 0, -kG * kStep});
    Problem p = problem_of(w);
    CHECK(NewtonSolver().solve(p, {}).converged);
    for (const Point& q : p.points) CHECK(q.impulse.z == doctest::Approx(2 * kG * kStep).epsilon(1e-9));
}

TEST_CASE("wherever Newton's method says that it converged, the law holds at every contact")
{
    std::uint64_t random = 7;
    int converged = 0, trials = 0;
    for (const double mu : {0.0, 0.2, 0.4})
        for (int t = 0; t < 10; ++t, ++trials)
        {
            IslandWorld w;
            w.add_stack({1, 3, 0.5, 2}, mu);
            const auto any = [&] { return 2 * next_uniform(random) - 1; };
            for (const std::uint32_t b : w.members)
            {
                w.bodies.velocity[b] = {any(), any(), any()};
                w.bodies.angular_velocity[b] = {any(), any(), any()};
            }
            Problem p = problem_of(w);
            const Solved s = NewtonSolver().solve(p, {});
            if (!s.converged) continue;
            ++converged;
            for (const Point& q : p.points)
            {
                const Vec3 u = p.relative_velocity(q);
                const double slip = std::hypot(u.x, u.y), held = std::hypot(q.impulse.x, q.impulse.y);
                CHECK(u.z >= -1e-11);
                CHECK(q.impulse.z >= -1e-11);
                CHECK(std::fabs(u.z * q.impulse.z) < 1e-10);
                CHECK(held <= mu * q.impulse.z + 1e-10);
                // Slip is opposed by friction, and requires the full friction.
                if (slip > 1e-8) CHECK(std::fabs(q.impulse.x * u.x + q.impulse.y * u.y + mu * q.impulse.z * slip) < 1e-9);
            }
        }
    CHECK(converged >= trials * 9 / 10);
}

TEST_CASE("a one-sided row and an equality row share an island with contacts")
{
    // A box on the ground, pulled along x by a row with a target of 1 m/s and at most 2 N, friction 0.1: it accelerates.
    IslandWorld w;
    w.add_stack({1}, 0.1);
    ConstraintRow pull;
    pull.count = 1, pull.kind = RowKind::Rate, pull.rate = 1;
    pull.blocks[0] = {{Facet::Body, w.members[0]}, {1, 0, 0}, {}};
    pull.lower = -2, pull.upper = 2;
    w.rows.push_back(pull);
    w.kick({0, 0, -kG * kStep});
    Problem p = problem_of(w);
    p.lines[0].target = 1, p.lines[0].least = -2 * kStep, p.lines[0].most = 2 * kStep;
    const Solved s = NewtonSolver().solve(p, {});
    CHECK(s.converged);
    CHECK(p.lines[0].impulse == doctest::Approx(2 * kStep).epsilon(1e-12));
    CHECK(p.movers[0].v.x == doctest::Approx((2 - 0.1 * kG) * kStep).epsilon(1e-9));
}

TEST_CASE("D2: the work of one factorisation of a stack is proportional to its height; for a wall it is less than that of a band matrix")
{
    for (const std::uint32_t n : {10u, 20u, 50u, 100u})
    {
        std::vector<linear::SparseEdge> chain;
        for (std::uint32_t i = 0; i + 1 < n; ++i) chain.push_back({i, i + 1});
        linear::SparseBlocks m(linear::SparseBlocks::Kind::General);
        m.analyse(std::vector<linear::SparseNode>(n, {6}), chain);
        CHECK(m.blocks() == n - 1);
        CHECK(m.products() == 2 * (n - 1));
    }
    const auto wall = [](std::uint32_t wide, std::uint32_t high)
    {
        std::vector<linear::SparseEdge> edges;
        for (std::uint32_t k = 0; k < high; ++k)
            for (std::uint32_t i = 0; i < wide; ++i)
            {
                const std::uint32_t at = k * wide + i;
                if (i + 1 < wide) edges.push_back({at, at + 1});
                if (k + 1 == high) continue;
                // Every second row stands half a brick further: a brick lies on two.
                edges.push_back({at, at + wide});
                if (k % 2 == 0 && i > 0) edges.push_back({at, at + wide - 1});
                if (k % 2 == 1 && i + 1 < wide) edges.push_back({at, at + wide + 1});
            }
        std::sort(edges.begin(), edges.end());
        linear::SparseBlocks m(linear::SparseBlocks::Kind::General);
        m.analyse(std::vector<linear::SparseNode>(wide * high, {6}), edges);
        return static_cast<double>(m.products());
    };
    const double small = wall(10, 10), large = wall(40, 40);
    // 16 times the bricks: 256 times the work for a band, 64 for the best order of elimination. A count, the same everywhere: 160.9.
    CHECK(large / small < 161);
    CHECK(wall(40, 25) <= 409008);
}
