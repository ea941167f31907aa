// Rules in large scenes: a step without changes costs little and allocates nothing; the cost grows in proportion to the objects.
#include <algorithm>
#include <chrono>

#include "rules/pair_search.h"
#include "rules/workbench.h"
#include "support/allocation_counter.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// A square of n x n bodies, 1 m apart, which drift together, and two that come near one another.
std::string crowd(int n, const std::string& rule)
{
    const std::string count = std::to_string(n) + " " + std::to_string(n);
    return "<repeat count='" + count + "' step='1 1 0'><component id='ball' type='State/RigidBody' mass='1' inertia='1 1 1' " +
           "linear_velocity='0.1 0 0'/></repeat>" +
           "<component id='late' type='State/RigidBody' mass='1' inertia='1 1 1' position='0 -2 0' linear_velocity='0.1 2 0'/>" + rule;
}

const std::string kRule =
    "<component id='r' type='Rule/Pair' reach='0.5'><template><component id='${rule}.${a}.${b}' type='Constraint/SpringDamper' a='${a}' "
    "b='${b}' "
    "stiffness='1'/></template></component>";

}  // namespace

TEST_CASE("10,000 objects: a step without changes allocates nothing for a rule, and the one pair that comes near is found")
{
    Scene s(crowd(100, kRule));
    serve(s);
    s.step(12);
    const long before = allocations;
    for (int n = 0; n < 20; ++n) s.simulation().step();
    CHECK(allocations - before == 0);
    s.run(1.2);
    CHECK(s.count("component.made") >= 1);
    CHECK(exists(s, "r.ball.0.0.late"));
}

TEST_CASE("thousands of pairs that meet at once are one transaction, and the one that is impossible is told")
{
    // A chain of wheels that mesh, and a triangle of them at its end.
    const std::string count = "1500";
    std::string chain = "<component id='form' type='Shape/Gear' pitch_radius='0.1' teeth='20' width='0.02'/><repeat count='" + count +
                        "' step='0.2 0 0'><component id='w' type='State/Shaft' inertia='0.01' shape='form'/></repeat>" +
                        "<component id='x' type='State/Shaft' inertia='0.01' shape='form' position='0.1 0.17320508 0'/>";
    for (const std::string couples : {"", "couples='-1'"})
    {
        CAPTURE(couples);
        Scene s(chain + meshing(couples));
        serve(s);
        s.warnings_expected = true;
        const std::uint64_t before = s.simulation().revision();
        s.step();
        CHECK(s.count("component.made") == 1500);
        CHECK(s.count("decide.refused") + s.count("rule.refused") == 1);
        CHECK(s.simulation().revision() - before <= 12);
        CHECK(s.count("component.made") == 1500);
    }
}

TEST_CASE("the search for near pairs grows in proportion to the points, not to the pairs")
{
    double cost[2] = {};
    const std::uint32_t n[2] = {30, 300};
    for (int k = 0; k < 2; ++k)
    {
        std::vector<Vec3> points;
        for (std::uint32_t i = 0; i < n[k] * n[k]; ++i) points.push_back({0.4 * (i % n[k]), 0.4 * (i / n[k]), 0});
        std::size_t found = 0;
        cost[k] = 1e300;
        for (int repeat = 0; repeat < 7; ++repeat)
        {
            rules::PairSearch search;
            const auto begin = std::chrono::steady_clock::now();
            search.follow(points, 0.5);
            cost[k] = std::min(cost[k], std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
            found = search.pairs().size();
        }
        CHECK(found == 4 * n[k] * n[k] - 6 * n[k] + 2);  // neighbours along x, along y, and diagonally
        MESSAGE(n[k] * n[k], " points: ", cost[k], " us");
    }
    CHECK(cost[1] < 4 * 100 * cost[0]);  // 100 times the points, 10,000 times the pairs
}
