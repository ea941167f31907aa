// tf, markers, contacts and times.
#include "ros/contacts.h"
#include "ros/markers.h"
#include "ros/transforms.h"
#include "unit/ros/scene_of.h"

namespace plab::test
{
namespace
{

TEST_CASE("a time of ROS has whole seconds and nanoseconds from 0 on, also before zero")
{
    const auto check = [](double seconds, std::int32_t sec, std::uint32_t nanosec)
    {
        const wire::ros::Time time = ros::time_of(seconds);
        CHECK(time.sec == sec);
        CHECK(time.nanosec == nanosec);
    };
    check(0, 0, 0), check(1.25, 1, 250'000'000), check(-1.25, -2, 750'000'000), check(0.9999999999, 1, 0);
    check(1e30, 2147483647, 0);
}

TEST_CASE("tf has what moves, tf_static what does not, and a shaft turns about its axle")
{
    link::CatalogueContents scene;
    add(scene, object("ball", 7)), add(scene, object("floor", 8, "static", {{1, 2, 3}, {}}));
    add(scene, shaft("axle", 9, {{0, 0, 1}, {}}));
    ros::NameTable names;
    ros::SceneFrames frames;
    frames.rebuild(scene, names);
    TestFrame frame;
    frame.add(7, {{4, 5, 6}, {0.5, 0.5, -0.5, 0.5}}), frame.add(99, {});
    frame.shafts.push_back({9, 1.0, 0});
    ros::TransformMessage moving, fixed;
    const auto& tf = moving.moving(frames, frame.at(2.5));
    REQUIRE(tf.transforms._length == 2);
    const auto& ball = tf.transforms._buffer[0];
    CHECK(std::string(ball.header.frame_id) == "world");
    CHECK(std::string(ball.child_frame_id) == "ball");
    CHECK(ball.header.stamp.nanosec == 500'000'000);
    CHECK(ball.transform.translation.z == 6);
    // x y z w
    CHECK(ball.transform.rotation.y == -0.5);
    CHECK(ball.transform.rotation.w == 0.5);
    const auto& axle = tf.transforms._buffer[1].transform;
    CHECK(axle.rotation.z == doctest::Approx(std::sin(0.5)));
    CHECK(axle.rotation.w == doctest::Approx(std::cos(0.5)));
    const auto& still = fixed.fixed(frames, 0);
    REQUIRE(still.transforms._length == 1);
    CHECK(std::string(still.transforms._buffer[0].child_frame_id) == "floor");
    CHECK(still.transforms._buffer[0].transform.translation.y == 2);
}

TEST_CASE("markers are the exact shapes in the frames of their bodies, after one that removes the old ones")
{
    link::CatalogueContents scene;
    for (const char* id : {"ball", "box", "can", "pill"}) add(scene, object(id, 1));
    scene.objects["box"].color = {1, 0.5, 0};
    add_shape(scene, "ball", "sphere", {0.5, 0, 0}), add_shape(scene, "box", "box", {1, 2, 3}, {{0, 0, 9}, {}});
    add_shape(scene, "can", "cylinder", {0.5, 0, 2}), add_shape(scene, "pill", "capsule", {0.25, 0, 1}, {{0, 0, 5}, {}});
    ros::NameTable names;
    ros::SceneFrames frames;
    frames.rebuild(scene, names);
    ros::MarkerMessage message;
    const auto& markers = message.of(scene, frames).markers;
    REQUIRE(markers._length == 1 + 3 + 3);
    CHECK(markers._buffer[0].action == 3);
    const auto& ball = markers._buffer[1];
    CHECK(ball.type == 2);
    CHECK(ball.scale.x == 1);
    CHECK(std::string(ball.header.frame_id) == "ball");
    CHECK(ball.frame_locked);
    const auto& box = markers._buffer[2];
    CHECK(box.type == 1);
    CHECK(box.scale.z == 6);
    CHECK(box.pose.position.z == 9);
    CHECK(box.color.g == 0.5f);
    CHECK(box.color.a == 1.0f);
    CHECK(markers._buffer[3].scale.z == 4);
    CHECK(markers._buffer[5].pose.position.z == 4);
    CHECK(markers._buffer[6].pose.position.z == 6);
    std::set<std::int32_t> ids;
    for (std::uint32_t i = 1; i < markers._length; ++i) CHECK(ids.insert(markers._buffer[i].id).second);
    const std::uint64_t before = message.fingerprint();
    (void)message.of(scene, frames);
    CHECK(message.fingerprint() == before);
    scene.objects["box"].color.z = 1;
    (void)message.of(scene, frames);
    CHECK(message.fingerprint() != before);
}

TEST_CASE("an impulse on b is its mean force over the step, and the opposite one on a")
{
    link::CatalogueContents scene;
    add(scene, object("one", 1)), add(scene, object("two", 2));
    ros::NameTable names;
    ros::SceneFrames frames;
    frames.rebuild(scene, names);
    std::vector<plab_v2_CollisionInfo> entries(2);
    std::string begin = "impact", end = "end", a = "one", b = "two", none;
    entries[0] = {begin.data(), 1.5, none.data(), a.data(), b.data(), {1, 2, 3}, {0, 0, 1}, {0, 0, 0.25}, 0.001};
    entries[1] = {end.data(), 1.6, none.data(), a.data(), b.data(), {}, {}, {}, 0};
    plab_v2_Collisions collisions{};
    collisions.entries._buffer = entries.data(), collisions.entries._length = 2;
    ros::ContactMessage message;
    const auto& contacts = message.of(collisions, 1.0 / 240, frames);
    REQUIRE(contacts.contacts._length == 2);
    const auto& hit = contacts.contacts._buffer[0];
    CHECK(std::string(hit.collision1.name) == "one");
    CHECK(hit.collision2.id == 2);
    CHECK(hit.wrenches._buffer[0].body_2_wrench.force.z == doctest::Approx(60));
    CHECK(hit.wrenches._buffer[0].body_1_wrench.force.z == doctest::Approx(-60));
    CHECK(hit.depths._buffer[0] == 0.001);
    CHECK(contacts.contacts._buffer[1].positions._length == 0);
    CHECK(contacts.header.stamp.sec == 1);
}

}  // namespace
}  // namespace plab::test
