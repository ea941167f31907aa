// The parts of a rule: search for near pairs, expressions, templates, relations and loops.
#include <random>
#include <set>

#include "doctest/doctest.h"
#include "rules/expression.h"
#include "rules/links.h"
#include "rules/loops.h"
#include "rules/pair_search.h"
#include "rules/relation.h"
#include "rules/template_text.h"

using namespace plab;
using namespace plab::rules;

TEST_CASE("the search finds each near pair, whatever the points do, and few others")
{
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> place(-3, 3), shift(-0.02, 0.02);
    std::vector<Vec3> points(400);
    for (Vec3& p : points) p = {place(random), place(random), place(random)};
    PairSearch search;
    constexpr double kReach = 0.4;
    for (int step = 0; step < 60; ++step)
    {
        search.follow(points, kReach);
        const std::set<PairSearch::Pair> found(search.pairs().begin(), search.pairs().end());
        CHECK(found.size() == search.pairs().size());
        std::size_t near = 0;
        for (std::uint32_t i = 0; i < points.size(); ++i)
            for (std::uint32_t j = i + 1; j < points.size(); ++j)
            {
                if (length(points[i] - points[j]) > kReach) continue;
                ++near;
                CHECK(found.contains({i, j}));
            }
        CHECK(found.size() < 4 * near);
        for (Vec3& p : points) p += Vec3{shift(random), shift(random), shift(random)};
    }
    // Another reach, fewer points, a jump, places that fit into no cell.
    points.resize(3);
    points[0] = {1e300, 0, 0}, points[1] = {1e300, 0, 0}, points[2] = {-1e300, 5, 0};
    search.follow(points, 0.1);
    CHECK(search.pairs().size() == 1);
}

TEST_CASE("expressions")
{
    const Names names = [](std::string_view name) -> Result<double>
    {
        if (name == "a.radius") return 0.1;
        if (name == "b.radius") return 0.25;
        return reason("there is no '" + std::string(name) + "'");
    };
    const auto value = [&](const char* text) { return evaluate(text, names); };
    CHECK(*value("-a.radius / b.radius") == -0.1 / 0.25);
    CHECK(*value("1 + 2 * 3 - 4 / 2") == 5);
    CHECK(*value("(1 + 2) * -3") == -9);
    CHECK(*value("2 - 3 - 4") == -5);
    CHECK(*value("1.5e-3*2") == 3e-3);
    for (const char* const wrong : {"", "1 +", "(1", "1 2", "1 / 0", "c", "a.radius b", "1e", "*2", "1;2"})
    {
        const auto refused = value(wrong);
        CHECK_MESSAGE(!refused.ok(), wrong);
    }
    CHECK(value("c").error().reason.find("there is no 'c'") != std::string::npos);
    CHECK(!value(std::string(100, '(').c_str()).ok());
}

TEST_CASE("templates: values in all digits, ids escaped for XML, and the id of the first component")
{
    const Known known = [](std::string_view name) -> std::optional<Value>
    {
        if (name == "a") return Value(std::string("left & <right>"));
        if (name == "x") return Value(0.1 + 0.2);
        if (name == "p") return Value(Vec3{1, -0.5, 1.0 / 3});
        return {};
    };
    CHECK(*fill_template("<component id=\"${a}.k\" v=\"${x}\" w=\"${2 * x}\" p=\"${p}\"/>", known) ==
          "<component id=\"left &amp; &lt;right&gt;.k\" v=\"0.30000000000000004\" w=\"0.6000000000000001\" p=\"1 -0.5 "
          "0.3333333333333333\"/>");
    CHECK(!fill_template("${y}", known).ok());
    CHECK(!fill_template("${2 * p}", known).ok());
    CHECK(!fill_template("${a", known).ok());
    CHECK(first_id(*fill_template("<plab>\n<component type=\"T\" grid=\"2\" id=\"${a}.k\">", known)) == "left & <right>.k");
    CHECK(first_id("<plab><component type='id' id = 'x'/>") == "x");
    CHECK(first_id("<plab/>").empty());
}

TEST_CASE("relations of two frames")
{
    const Quat tilted{std::cos(0.05), std::sin(0.05), 0, 0};  // 0.1 rad about x
    const Measures m = measure({{{0, 0, 0}, {}}, 0.1}, {{{0.3, 0, 0.04}, tilted}, 0.2});
    CHECK(m.along == doctest::Approx(0.04));
    CHECK(m.radial == doctest::Approx(0.3));
    CHECK(m.angle == doctest::Approx(0.1));
    CHECK(m.distance == doctest::Approx(std::sqrt(0.0916)));
    Bounds bounds{Kind::Meshing, 0.5, 1e-6, 0.05, 0.11};
    CHECK(holds(bounds, m, 0.1, 0.2));
    CHECK(!holds(bounds, m, 0.1, 0.21));
    CHECK(!holds({Kind::Meshing, 0.3, 1e-6, 0.05, 0.11}, m, 0.1, 0.2));
    CHECK(holds({Kind::Meshing, 0.3, 1e-6, 0.05, 0.11}, m, 0.1, 0.2, 1.1));
    CHECK(!holds({Kind::Meshing, 0.5, 1e-6, 0.03, 0.11}, m, 0.1, 0.2));
    CHECK(!holds({Kind::Meshing, 0.5, 1e-6, 0.05, 0.09}, m, 0.1, 0.2));
    CHECK(holds({Kind::Inside, 0.5, 1e-6, 0.05, 0.11}, m, 0.5, 0.2));
    CHECK(!holds({Kind::Coaxial, 0.5, 0.2, 0.05, 0.11}, m, 0.1, 0.2));
    CHECK(holds({Kind::Touching, 0.5, 0.01, 0.05, 0.11}, m, 0.1, 0.2));
    // Opposite axes are parallel, too.
    CHECK(measure({{{}, {}}, 0}, {{{}, {0, 1, 0, 0}}, 0}).angle == 0);
}

TEST_CASE("links as text and back; what is no link is left out")
{
    const std::vector<Link> links{{"x y", Progress::Drawing, "one", "two", 0, 1}, {"z", Progress::Refused, "a b", "c", 0, 1}};
    const std::vector<Link> back = to_links(to_entries(links));
    REQUIRE(back.size() == 2);
    CHECK(back[0].id == "x y");
    CHECK(back[0].progress == Progress::Drawing);
    CHECK(back[1].a == "a b");
    CHECK(to_links({{"x", 1.0}, {"y", std::string("made")}, {"z", std::string("mad\ta\tb")}}).empty());
}

TEST_CASE("paths of couplings")
{
    const auto near = [](double x, double y) { return std::fabs(x - y) <= 1e-9 * std::fabs(y); };
    const auto shaft = [](std::uint32_t i) { return Ref{Facet::Shaft, i}; };
    Couplings couplings;
    couplings.add({shaft(0), shaft(1), -2, "p"});
    couplings.add({shaft(2), shaft(1), 4, "q"});
    couplings.add({shaft(3), shaft(4), 1, "r"});
    CHECK(*couplings.ratio(shaft(0), shaft(2)) == -0.5);
    CHECK(*couplings.ratio(shaft(2), shaft(0)) == -2);
    CHECK(!couplings.ratio(shaft(0), shaft(4)));
    CHECK(!couplings.path(shaft(0), shaft(3)));
    couplings.add({shaft(4), shaft(2), 3, "s"});
    CHECK(near(*couplings.ratio(shaft(3), shaft(1)), 12));
    const auto path = couplings.path(shaft(0), shaft(4));
    REQUIRE(path.has_value());
    CHECK(near(path->ratio, -0.5 / 3));
    CHECK(path->ids == "p, q, s");
    // Any order of couplings gives the ratios of the numbers from which they were made.
    std::mt19937_64 random(3);
    std::vector<double> turns;
    for (int i = 0; i < 200; ++i) turns.push_back(std::uniform_real_distribution<double>(0.5, 2)(random) * (i % 2 == 0 ? 1 : -1));
    Couplings many;
    for (int n = 0; n < 300; ++n)
    {
        const auto i = static_cast<std::uint32_t>(random() % 200), k = static_cast<std::uint32_t>(random() % 200);
        if (const auto ratio = many.ratio(shaft(i), shaft(k))) CHECK(near(*ratio, turns[k] / turns[i]));
        many.add({shaft(i), shaft(k), turns[k] / turns[i], "c"});
    }
    CHECK(agree(1.0 / 3, 1.0 / 3 * (1 + 1e-12)));
    CHECK(!agree(1, -1));
}
