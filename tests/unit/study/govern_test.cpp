// A governor compared with one level for all: what its point is worth.
#include "study/govern.h"

#include <doctest/doctest.h>

#include <cmath>

#include "support/load.h"
#include "support/text.h"

using namespace plab;
using namespace plab::study;

namespace
{

GovernPoint point(double cpu, double pixels, bool governed = false)
{
    GovernPoint out;
    out.governed = governed, out.cpu = cpu, out.error.pixels = pixels;
    return out;
}

GovernResult with_governed(double cpu, double pixels)
{
    GovernResult out;
    out.points = {point(cpu, pixels, true), point(1, 1), point(3, 2), point(100, 1e-4)};  // the second level is worth nothing
    return out;
}

}  // namespace

TEST_CASE("the gain is the cost of the same error on the line that joins the levels, in logarithms")
{
    CHECK(*gain(with_governed(5, 1e-2)) == doctest::Approx(2));  // half of the way in logarithms: 10 instead of 5
    CHECK(*gain(with_governed(20, 1e-2)) == doctest::Approx(0.5));
    CHECK(*gain(with_governed(50, 1e-4)) == doctest::Approx(2));
    CHECK_FALSE(gain(with_governed(50, 1e-5)));  // more exact than every level
    CHECK_FALSE(gain(with_governed(0.5, 10)));
}

TEST_CASE("a level is beaten only by a governed run that is both cheaper and more exact; of several the cheapest one is named")
{
    GovernResult r = with_governed(5, 1e-2);
    r.points.insert(r.points.begin() + 1, {point(60, 5e-5, true), point(90, 4e-5, true), point(110, 1e-6, true)});
    CHECK(better_than(r, r.points[4]) == nullptr);  // nothing is cheaper than the cheapest one
    CHECK(better_than(r, r.points[5]) == nullptr);
    REQUIRE(better_than(r, r.points[6]));
    CHECK(better_than(r, r.points[6])->cpu == 60);
    CHECK(better_than(r, point(1, 1e-2)) == nullptr);  // as exact is not more exact
    CHECK_FALSE(gain(r, r.points[3]));
    const std::string found = [&]
    {
        std::string all;
        for (const std::string& sentence : govern_findings(r)) all += sentence + "\n";
        return all;
    }();
    CHECK(test::has(found, "is beaten in both by"));
    CHECK(test::has(found, "1.67 times as fast and 2 times as exact"));
}

TEST_CASE("a governed scene and its single levels: the cheapest level has the largest error, and the governor's is that of what is seen")
{
    std::string text =
        "<scene dt='1/60'/><component id='ball' type='Shape/Sphere' radius='0.3'/>"
        "<component id='eye' type='Viewer/Free'/>"
        "<component id='lod' type='Governor/Visibility' watches='bob.*.solver' pixels='1' every='0.1' dwell='0' "
        "levels='Solver/SemiImplicitEuler; Solver/RungeKutta4'/>";
    for (int i = 0; i < 8; ++i)
    {
        const std::string id = std::to_string(i), x = std::to_string(i % 2 == 0 ? 8 : -8), y = std::to_string(i / 2);
        text += "<component id='post." + id + "' type='State/Static' position='" + x + " " + y + " 1'/>";
        text += "<component id='bob." + id + "' type='State/RigidBody' mass='1' shape='ball' position='" + x + " " + y +
                " 0.2' solver='Solver/RungeKutta4'/>";
        text += "<component id='spring." + id + "' type='Constraint/SpringDamper' a='post." + id + "' b='bob." + id +
                "' length='1' stiffness='60'/>";
    }
    auto scene = test::compile_text("<plab version='1'>" + text + "</plab>");
    REQUIRE(scene.ok());
    GovernPlan plan;
    plan.scene = scene.take(), plan.until = 2, plan.governor = "lod";
    const auto result = compare_governor(test::library(), plan);
    REQUIRE(result.ok());
    REQUIRE(result->points.size() == 3);
    CHECK(result->components == 8);
    const GovernError &governed = result->points[0].error, &cheap = result->points[1].error, &exact = result->points[2].error;
    CHECK(cheap.pixels > 10 * exact.pixels);
    CHECK(governed.pixels == doctest::Approx(exact.pixels).epsilon(0.2));
    CHECK(governed.metres > 3 * exact.metres);  // nobody looks behind
    CHECK(governed.worst.starts_with("bob."));
    CHECK(governed.worst_level == "Solver/RungeKutta4");
    CHECK(governed.worst_at > 0);
    // Of a variant that gives the cheapest level to all, the error is that of the cheapest level.
    plan.variants = {{"lod.pixels", "1e9"}};
    const auto varied = compare_governor(test::library(), plan);
    REQUIRE(varied.ok());
    REQUIRE(varied->points.size() == 4);
    CHECK(varied->points[1].name == "governed, lod.pixels=1e9");
    CHECK(varied->points[1].governed);
    CHECK(varied->points[1].error.pixels == doctest::Approx(cheap.pixels).epsilon(0.05));
    CHECK_FALSE(varied->points[2].governed);
    plan.variants = {{"lod.pixel", "1"}};
    CHECK_FALSE(compare_governor(test::library(), plan).ok());
    plan.variants.clear();
    plan.governor = "other";
    const auto refused = compare_governor(test::library(), plan);
    REQUIRE_FALSE(refused.ok());
    CHECK(test::has(refused.error().text(), "no governor 'other'"));
}

TEST_CASE("a pattern compares several governors at once: of each ladder the ends, and what lies between them")
{
    std::string text = "<scene dt='1/60'/><component id='ball' type='Shape/Sphere' radius='0.3'/><component id='eye' type='Viewer/Free'/>";
    const char* kLadders[] = {"Solver/SemiImplicitEuler; Solver/DormandPrince54",
                              "Solver/SemiImplicitEuler; Solver/RungeKutta4; Solver/DormandPrince54"};
    for (int i = 0; i < 4; ++i)
    {
        const std::string id = std::to_string(i);
        text += "<component id='post." + id + "' type='State/Static' position='8 " + id + " 1'/><component id='bob." + id +
                "' type='State/RigidBody' mass='1' shape='ball' position='8 " + id +
                " 0.2' solver='Solver/RungeKutta4'/><component id='spring." + id + "' type='Constraint/SpringDamper' a='post." + id +
                "' b='bob." + id + "' length='1' stiffness='60'/>";
        if (i < 3)
            text += "<component id='lod." + id + "' type='Governor/Visibility' watches='bob." + id + ".solver' pixels='" +
                    (i == 0 ? "1" : "1 2") + "' every='0.1' dwell='0' levels='" + kLadders[i == 0 ? 0 : 1] + "'/>";
    }
    auto scene = test::compile_text("<plab version='1'>" + text + "</plab>");
    REQUIRE_MESSAGE(scene.ok(), test::reasons(scene));
    GovernPlan plan;
    plan.scene = scene.take(), plan.until = 1;
    const auto names = [&](const char* pattern)
    {
        plan.governor = pattern;
        const auto result = governed_levels(test::library(), plan);
        REQUIRE_MESSAGE(result.ok(), test::reasons(result));
        CHECK(result->type == "Governor/Visibility");
        return std::pair(result->governor, result->levels);
    };
    const std::vector<std::string> three{"cheapest levels", "levels 2 of 3", "most exact levels"};
    CHECK(names("lod.?") == std::pair(std::string("lod.0, lod.1, lod.2"), three));
    CHECK(names("*.1 *.2") == std::pair(std::string("lod.1, lod.2"), three));
    CHECK(names("lod.0").second == std::vector<std::string>{"Solver/SemiImplicitEuler", "Solver/DormandPrince54"});
    plan.governor = "*";
    const auto result = compare_governor(test::library(), plan);
    REQUIRE_MESSAGE(result.ok(), test::reasons(result));
    CHECK(result->components == 3);
    CHECK(result->objects == 3);  // the fourth body is not watched
    REQUIRE(result->points.size() == 4);
    // The governed run gives the most exact levels to all, because all are near, at its first boundary.
    const std::vector<GovernPoint>& points = result->points;
    CHECK(points[0].error.pixels == doctest::Approx(points[3].error.pixels).epsilon(1e-9));
    CHECK(points[1].error.pixels > 2 * points[2].error.pixels);
    CHECK(points[2].error.pixels > 2 * points[3].error.pixels);
    CHECK(points[0].steps.size() == 59);  // without the step after the snapshot
    CHECK(points[0].steps[0].exchanged == 3);
    CHECK(points[0].steps[0].deciding > 0);
    CHECK(points[0].steps[1].exchanged == 0);
    CHECK(points[3].steps[0].exchanged == 0);
    const std::string folder = std::string(PLAB_BINARY_DIR) + "/unit_study_govern";
    REQUIRE(write_govern(*result, folder).ok());
    const std::string table = test::content_of(folder + "/steps.csv");
    CHECK(test::has(table, "step,governed,cheapest levels,levels 2 of 3,most exact levels,deciding,trials,exchanged\n"));
}
