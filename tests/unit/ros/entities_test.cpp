// Which entities a filter selects, and how large they are.
#include "ros/entities.h"
#include "unit/ros/scene_of.h"

namespace plab::test
{
namespace
{

/// A filter of ROS that owns its texts and points.
struct TestFilter
{
    wire::ros::EntityFilters filters{};
    std::vector<char*> tags;
    std::vector<wire::ros::RosVector> points;
    std::string text;

    TestFilter& named(const std::string& pattern)
    {
        text = pattern, filters.filter = text.data();
        return *this;
    }
    TestFilter& tagged(std::vector<const char*> names, bool all)
    {
        for (const char* name : names) tags.push_back(const_cast<char*>(name));
        ros::show(filters.tags.tags, tags);
        filters.tags.filter_mode = all ? 1 : 0;
        return *this;
    }
    TestFilter& within(std::uint8_t type, const Vec3& a, const Vec3& b)
    {
        points = {ros::vector_of(a), ros::vector_of(b)};
        filters.bounds.type = type;
        ros::show(filters.bounds.points, points);
        return *this;
    }
};

TEST_CASE("a filter selects by name, tags, category and place, all of them together")
{
    link::CatalogueContents scene;
    add(scene, object("ball", 1)), add_shape(scene, "ball", "sphere", {0.5, 0, 0});
    const link::Object& ball = scene.objects["ball"];
    const auto fits = [&](TestFilter filter, const Pose& pose = {})
    {
        ros::EntityFilter read;
        const ros::Outcome outcome = read.read(filter.filters);
        REQUIRE_MESSAGE(outcome.ok(), outcome.text);
        return read.fits("ball", ball, scene, pose);
    };
    CHECK(fits(TestFilter{}));
    CHECK(fits(TestFilter{}.named("^b.*l$")));
    CHECK_FALSE(fits(TestFilter{}.named("^all")));
    CHECK(fits(TestFilter{}.tagged({"body", "nothing"}, false)));
    CHECK_FALSE(fits(TestFilter{}.tagged({"body", "nothing"}, true)));
    CHECK(fits(TestFilter{}.tagged({"body", "dynamic"}, true)));
    // A ball of 0.5 m at x = 2 touches a sphere of 1.6 m about the origin, and no sphere of 1.4 m.
    const Pose there{{2, 0, 0}, {}};
    CHECK(fits(TestFilter{}.within(3, {}, {1.6, 0, 0}), there));
    CHECK_FALSE(fits(TestFilter{}.within(3, {}, {1.4, 0, 0}), there));
    CHECK(fits(TestFilter{}.within(1, {1.6, 1, 1}, {-1, -1, -1}), there));
    CHECK_FALSE(fits(TestFilter{}.within(1, {1.4, 1, 1}, {-1, -1, -1}), there));
    CHECK_FALSE(fits(TestFilter{}.named("x").within(3, {}, {9, 0, 0}), there));
}

TEST_CASE("filters that could take forever, or that are none, are refused")
{
    const auto code = [](TestFilter filter) { return ros::EntityFilter().read(filter.filters).code; };
    CHECK(code(TestFilter{}.named("((a{1,255}){1,255}){1,255}")) == ros::Code::Unsupported);
    CHECK(code(TestFilter{}.named("(a*)*\\1")) == ros::Code::Unsupported);
    CHECK(code(TestFilter{}.named(std::string(300, 'a'))) == ros::Code::Unsupported);
    CHECK(code(TestFilter{}.named("(")) == ros::Code::Failed);
    CHECK(code(TestFilter{}.within(2, {}, {})) == ros::Code::Unsupported);
}

TEST_CASE("a box around turned shapes is the smallest one along the axes")
{
    link::CatalogueContents scene;
    add(scene, object("one", 1));
    add_shape(scene, "one", "box", {1, 2, 3}, {{10, 0, 0}, turn_about_z(std::acos(0.0))});
    auto box = ros::box_of(scene.objects["one"], scene);
    REQUIRE(box);
    CHECK(box->low.x == doctest::Approx(8));
    CHECK(box->high.y == doctest::Approx(1));
    CHECK(box->high.z == doctest::Approx(3));
    // A cylinder that lies along x.
    const double half = std::sqrt(0.5);
    add_shape(scene, "one", "cylinder", {0.5, 0, 4}, {{}, {half, 0, half, 0}});
    box = ros::box_of(scene.objects["one"], scene);
    CHECK(box->low.x == doctest::Approx(-4));
    add_shape(scene, "one", "plane", {});
    CHECK_FALSE(ros::box_of(scene.objects["one"], scene));
}

}  // namespace
}  // namespace plab::test
