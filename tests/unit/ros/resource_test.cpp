// Parts of scenes that come as text or as a file.
#include <doctest/doctest.h>

#include <fstream>

#include "ros/resource.h"
#include "support/text.h"

namespace plab::test
{
namespace
{

Result<ros::ReadResource> read(const std::string& uri, const std::string& text)
{
    return ros::read_resource({wire::text(uri), wire::text(text)});
}

TEST_CASE("what a resource is follows from its first element")
{
    CHECK(read("", "<?xml version='1.0'?><!-- <robot> --><component id='a'/>")->format == "plab");
    CHECK(read("", "<robot name='r'/>")->format == "urdf");
    CHECK(read("", "<mujoco/>")->format == "mjcf");
    CHECK(read("", "<sdf/>")->format == "");
    CHECK(read("", "nonsense")->format == "");
    CHECK(read("", "").error().reason == "");
}

TEST_CASE("a URI names a file of this host, which is read whole or not at all")
{
    CHECK(read("file://" + std::string(PLAB_SOURCE_DIR) + "/scenes/imported/arm.urdf", "")->format == "urdf");
    CHECK(read(std::string(PLAB_SOURCE_DIR) + "/scenes/imported/arm.urdf", "")->format == "urdf");
    for (const char* wrong : {"http://example.org/a", "relative.urdf", "package://x/y", "/no/such/file", "/dev/zero", "/"})
        CHECK_MESSAGE(!read(wrong, ""), wrong);
}

TEST_CASE("a component gets its name and its place, and keeps the rest")
{
    const Pose place{{1, 2, 3}, {0.5, 0.5, 0.5, 0.5}};
    const auto made = ros::with_name_and_place(
        "<!-- c -->\n<component id = 'old' type=\"State/RigidBody\"\n position='9 9 9' mass='1 kg'><component/></component>",
        "new & better", place);
    REQUIRE(made);
    CHECK(*made ==
          "<component id=\"new &amp; better\" type=\"State/RigidBody\" mass=\"1 kg\" position=\"1 2 3\" orientation=\"0.5 0.5 0.5 "
          "0.5\"><component/></component>");
    CHECK(*ros::with_name_and_place("<component type='A'/>", "n", {}) ==
          "<component id=\"n\" type=\"A\" position=\"0 0 0\" orientation=\"1 0 0 0\"/>");
    // A group has no place.
    CHECK(*ros::with_name_and_place("<component id='g'><component/></component>", "n", {}) ==
          "<component id=\"n\"><component/></component>");
    CHECK_FALSE(ros::with_name_and_place("<component id='g'><component/></component>", "n", place));
    CHECK_FALSE(ros::with_name_and_place("<plab version='1'/>", "n", {}));
    for (const char* broken : {"", "<", "<component", "<component id='a", "<component id=>", "<component id"})
        CHECK_MESSAGE(!ros::with_name_and_place(broken, "n", {}), broken);
}

}  // namespace
}  // namespace plab::test
