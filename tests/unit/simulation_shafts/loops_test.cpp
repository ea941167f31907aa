// Loops of couplings: redundant ones are counted, contradictions named (problems F4, F5), and rationals at their
// limits.
#include <cmath>

#include "train.h"

using namespace plab;
using namespace plab::test;
using simulation::ExactRatio;

namespace
{

Train ring(const Ratio& a, const Ratio& b, const Ratio& c)
{
    Train t;
    for (int i = 0; i < 3; ++i) t.add_shaft(1 + i);
    t.gear(0, 1, a), t.gear(1, 2, b), t.gear(2, 0, c);
    return t;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

ExactRatio exact(std::int64_t n, std::int64_t d) { return *ExactRatio::from(exact_ratio(n, d)); }

}  // namespace

TEST_CASE("F4: a consistent ring with 50 duplicates moves as its tree, with redundancy 51")
{
    Train t = ring(exact_ratio(2, 1), exact_ratio(3, 1), exact_ratio(1, 6));
    for (int i = 0; i < 50; ++i) t.gear(0, 1, exact_ratio(2, 1));
    t.build();
    CHECK(t.graph.redundant().size() == 51);
    CHECK(t.graph.redundant()[0] == 2);
    REQUIRE(t.graph.trees().size() == 1);
    CHECK(t.graph.trees()[0].redundant == 51);
    CHECK(t.graph.trees()[0].count == 3);

    Train tree;
    for (int i = 0; i < 3; ++i) tree.add_shaft(1 + i);
    tree.gear(0, 1, exact_ratio(2, 1)), tree.gear(1, 2, exact_ratio(3, 1));
    tree.build();
    CHECK(t.accelerations({1, 2, 3}) == tree.accelerations({1, 2, 3}));
    t.react(), tree.react();
    CHECK(t.torque(0) == tree.torque(0));
    CHECK(t.torque(1) == tree.torque(1));
    CHECK_FALSE(t.torques.torque(2).has_value());
    CHECK_FALSE(t.torques.torque(30).has_value());
}

TEST_CASE("F5: a contradiction is refused with edges and product, and nothing is changed")
{
    Train t = ring(real_ratio(2), real_ratio(3), real_ratio(1 / 6.0001));
    const std::string error = t.build_error();
    CHECK(error ==
          "g2: contradiction: the loop g0 -> g1 -> g2 multiplies to 0.999983333611106, must be 1; change a factor or "
          "remove one of them");
    CHECK(t.shafts.root == std::vector<std::uint32_t>{0, 1, 2});
    CHECK(t.graph.trees().empty());

    Train good = ring(real_ratio(2), real_ratio(3), real_ratio(1.0 / 6));  // factors that are not exact: to 1e-12
    good.build();
    CHECK(good.graph.redundant().size() == 1);
    const Shafts before = good.shafts;
    good.gear(0, 2, 6.1);
    CHECK(contains(good.build_error(), "the loop g1 -> g0 -> g3 multiplies to"));
    CHECK(good.shafts.ratio == before.ratio);
    CHECK(good.graph.trees().size() == 1);  // the existing graph is kept
    CHECK(good.graph.redundant().size() == 1);
}

TEST_CASE("F5 with tooth counts is exact: 60/10 closes the ring, 61/10 does not, nor an error of one tooth in a million")
{
    Train good = ring(exact_ratio(20, 40), exact_ratio(15, 45), exact_ratio(60, 10));
    good.build();
    CHECK(good.graph.redundant().size() == 1);
    Train bad = ring(exact_ratio(20, 40), exact_ratio(15, 45), exact_ratio(61, 10));
    CHECK(contains(bad.build_error(), "g0 -> g1 -> g2 multiplies to 1.01666666666667 (61/60), must be 1"));
    const std::int64_t big = 1'000'000'007;  // the product differs from 1 by less than a double can resolve
    Train close = ring(exact_ratio(big, big + 1), exact_ratio(big + 2, big + 1), exact_ratio(1, 1));
    CHECK(contains(close.build_error(), "(1000000016000000063/1000000016000000064)"));
}

TEST_CASE("a sign alone is a contradiction: three external meshes in a ring lock")
{
    Train t = ring(exact_ratio(-1, 1), exact_ratio(-1, 1), exact_ratio(-1, 1));
    CHECK(contains(t.build_error(), "multiplies to -1, must be 1"));
}

TEST_CASE("all contradictions are reported at once")
{
    Train t;
    for (int i = 0; i < 4; ++i) t.add_shaft(1);
    t.gear(0, 1, 2.0), t.gear(0, 1, 3.0), t.gear(2, 3, 1.0), t.gear(3, 2, 5.0);
    const auto r = t.try_build();
    REQUIRE(r.errors().size() == 2);
    CHECK(r.errors()[0].element == "g1");
    CHECK(r.errors()[1].element == "g3");
}

TEST_CASE("impossible couplings are refused by name")
{
    SUBCASE("two prescribed shafts")
    {
        Train t;
        t.add_shaft(1, 1, Motion::Kinematic), t.add_shaft(1), t.add_shaft(1, 2, Motion::Kinematic);
        t.gear(0, 1, 1.0), t.gear(1, 2, 2.0);
        CHECK(t.build_error() == "g1: joins s0 and s2, but the motion of both is prescribed; at most one may be");
    }
    SUBCASE("itself")
    {
        Train t;
        t.add_shaft(1);
        t.gear(0, 0, 1.0);
        CHECK(t.build_error() == "g0: couples s0 to itself; driver and driven must be two shafts");
    }
    SUBCASE("no factor")
    {
        for (const double f : std::vector<double>{0.0, INFINITY, NAN})
        {
            Train t;
            t.add_shaft(1), t.add_shaft(1);
            t.gear(0, 1, f);
            CHECK(t.build_error() == "g0: the velocity factor must be finite and other than 0");
        }
    }
    SUBCASE("beyond double precision")
    {
        Train t;
        for (int i = 0; i < 50; ++i) t.add_shaft(1);
        for (std::uint32_t i = 0; i < 49; ++i) t.gear(i, i + 1, 1e6);
        CHECK(contains(t.build_error(), "times per turn of s0; must be between 2^-400 and 2^400"));
    }
    SUBCASE("one-way drives in a cycle, also through a gear")
    {
        Train t;
        for (int i = 0; i < 4; ++i) t.add_shaft(1);
        t.graph.drive(t.components++, shaft(0), shaft(1));
        t.graph.drive(t.components++, shaft(2), shaft(3));
        t.graph.drive(t.components++, shaft(3), shaft(0));
        t.build();
        t.gear(1, 2, 2.0);
        CHECK(t.build_error() == "g0: one-way drives form a cycle: g0 -> g1 -> g2 -> g0; one of them must react to its driven shaft");
    }
    SUBCASE("a drive of its own train, or of a prescribed shaft")
    {
        Train t;
        t.add_shaft(1), t.add_shaft(1), t.add_shaft(1, 0, Motion::Static);
        t.gear(0, 1, 1.0);
        t.graph.drive(7, shaft(0), shaft(1));
        CHECK(contains(t.build_error(), "form a cycle: g7 -> g7"));
        t.graph.clear();
        t.graph.drive(7, shaft(0), shaft(2));
        CHECK(t.build_error() == "g7: drives s2, whose motion is prescribed; it must be dynamic");
    }
}

TEST_CASE("rationals stay exact up to 128 bits and then fall back to double, without overflow")
{
    CHECK(exact(20, -40).text() == "-0.5 (-1/2)");
    CHECK((exact(7, 3) * exact(3, 7)).text() == "1");
    CHECK(exact(1, 3).inverse().text() == "3");

    ExactRatio up, down;
    const std::int64_t prime = 1'000'003;
    for (int i = 0; i < 6; ++i) up = up * exact(prime, prime + 6);
    CHECK(up.exact());  // 6 factors of 20 bits
    for (int i = 0; i < 60; ++i) up = up * exact(prime, prime + 6);
    CHECK_FALSE(up.exact());
    for (int i = 0; i < 66; ++i) down = down * exact(prime + 6, prime);
    CHECK((up * down).same(ExactRatio{}, 1e-12));
    CHECK_FALSE((up * down).same(ExactRatio{}, 0));
    CHECK(up.value() == doctest::Approx(std::pow(1.0 * prime / (prime + 6), 66)).epsilon(1e-13));

    ExactRatio huge;
    for (int i = 0; i < 500; ++i) huge = huge * exact(prime, 1);
    CHECK(huge.exponent() == static_cast<int>(std::floor(500 * std::log2(1.0 * prime))) + 1);
    for (int i = 0; i < 500; ++i) huge = huge * exact(1, prime);
    CHECK(huge.same(ExactRatio{}, 1e-12));
    CHECK_FALSE(huge.same(exact(-1, 1), 1e-12));
    CHECK_FALSE(huge.same(exact(2, 1), 1e-12));
    const std::int64_t most = std::numeric_limits<std::int64_t>::min();
    CHECK((exact(most, 1) * exact(most, 1)).exact());
    CHECK_FALSE((exact(most, 1) * exact(most, 1) * exact(2, 1)).exact());
    CHECK((exact(most, 1) * exact(most, 1) * exact(-2, 1)).value() == -0x1p127);
}

TEST_CASE("a ring of 1000 random gears with teeth closes up to rounding errors")
{
    Train t;
    for (int i = 0; i < 1000; ++i) t.add_shaft(1);
    for (std::uint32_t i = 0; i + 1 < 1000; ++i) t.gear(i, i + 1, exact_ratio(20 + i % 37, 20 + (i * 7) % 41));
    ExactRatio product;
    for (std::uint32_t i = 0; i + 1 < 1000; ++i) product = product * exact(20 + i % 37, 20 + (i * 7) % 41);
    t.gear(999, 0, product.inverse().value());
    t.build();
    CHECK(t.graph.redundant().size() == 1);
    t.gear(999, 0, product.inverse().value() * (1 + 1e-11));
    CHECK_FALSE(t.try_build().ok());
}
