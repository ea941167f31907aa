// Names that ROS accepts, whatever ids a scene has.
#include <doctest/doctest.h>

#include "idl/ros_topics.h"
#include "idl/values/ros_names.h"
#include "ros/names.h"

namespace plab::test
{
namespace
{

TEST_CASE("a namespace of ROS has tokens without a digit in front, and nothing empty")
{
    using wire::ros::is_namespace;
    for (const char* fine : {"", "/", "sim", "/sim", "/lab_2/sim", "a/b/c"}) CHECK_MESSAGE(is_namespace(fine), fine);
    for (const char* wrong : {"//", "/sim/", "2nd", "/a//b", "a b", "a-b", "sim__x", "\xC3\xBC", "~sim"})
        CHECK_MESSAGE(!is_namespace(wrong), wrong);
    CHECK_FALSE(is_namespace(std::string(151, 'a')));
    CHECK(wire::ros::normal_namespace("sim") == "/sim");
    CHECK(wire::ros::normal_namespace("/") == "");
}

TEST_CASE("topics and services have the names that rmw_cyclonedds_cpp gives them")
{
    CHECK(wire::ros::topic_name("", "clock") == "rt/clock");
    CHECK(wire::ros::topic_name("/lab/sim", "tf") == "rt/lab/sim/tf");
    CHECK(wire::ros::request_name("", "plab", "get_entities") == "rq/plab/get_entitiesRequest");
    CHECK(wire::ros::reply_name("/sim", "plab", "get_entities") == "rr/sim/plab/get_entitiesReply");
    CHECK(std::string(wire::ros::kTransforms.type->m_typename) == "tf2_msgs::msg::dds_::TFMessage_");
}

TEST_CASE("a server's name becomes the name of a node")
{
    CHECK(wire::ros::token_of("plab") == "plab");
    CHECK(wire::ros::token_of("my.server-2") == "my_server_2");
    CHECK(wire::ros::token_of("2nd") == "n2nd");
    CHECK(wire::ros::is_token(wire::ros::token_of("a__b..c")));
}

TEST_CASE("names of frames are valid and unique, and stay with their ids")
{
    ros::NameTable names;
    CHECK(names.name_of("red.wheel/left-2") == "red.wheel/left-2");
    CHECK(names.name_of("a b") == "a_b");
    CHECK(names.name_of("a*b") == "a_b_2");
    CHECK(names.name_of("a b") == "a_b");
    CHECK(names.name_of("/x") == "_/x");
    CHECK(names.name_of("world") == "world_2");
    CHECK(names.id_of("a_b_2") == "a*b");
    CHECK(names.id_of("nothing") == "");
    names.keep_only({"a*b"});
    CHECK(names.id_of("a_b") == "");
    CHECK(names.name_of("a*b") == "a_b_2");
    CHECK(names.name_of("a b") == "a_b");
}

}  // namespace
}  // namespace plab::test
