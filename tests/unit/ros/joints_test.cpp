// Angles and travels of joints, from the poses of their bodies.
#include "ros/joints.h"
#include "unit/ros/scene_of.h"

namespace plab::test
{
namespace
{

/// One joint, and what ROS says of it.
struct JointScene
{
    explicit JointScene(const link::Interaction& joint, bool with_base = false)
    {
        add(scene, object("b", 2));
        if (with_base) add(scene, object("a", 1));
        scene.interactions[joint.component_id] = joint;
        rebuild();
    }
    void rebuild()
    {
        frames.rebuild(scene, names);
        joints.rebuild(scene, frames, names);
    }

    link::CatalogueContents scene;
    ros::NameTable names;
    ros::SceneFrames frames;
    ros::JointMessage joints;
};

std::vector<link::Parameter> placed(const std::string& frame = "1 0 0 0")
{
    return {{"frame_a", frame, "", "state"},
            {"frame_b", frame, "", "state"},
            {"point_a", "0 0 0", "m", "state"},
            {"point_b", "0 0 0", "m", "state"}};
}

TEST_CASE("a hinge's angle goes on over whole turns, at the speed of the body")
{
    JointScene test(interaction("hinge", "Constraint/Hinge", "", "b", placed()));
    constexpr double kSpeed = 5, kStep = 0.1;  // 0.5 rad a frame
    for (int i = 1; i <= 100; ++i)
    {
        TestFrame frame;
        frame.add(2, {{}, turn_about_z(kSpeed * kStep * i)}, {}, {0, 0, kSpeed});
        const auto& state = test.joints.of(frame.at(kStep * i), nullptr);
        REQUIRE(state.name._length == 1);
        CHECK(std::string(state.name._buffer[0]) == "hinge");
        CHECK(state.position._buffer[0] == doctest::Approx(kSpeed * kStep * i).epsilon(1e-12));
        CHECK(state.velocity._buffer[0] == doctest::Approx(kSpeed));
        CHECK(state.effort._length == 0);
        if (i == 50) test.rebuild();  // a change of the catalogue keeps the turns
    }
}

TEST_CASE("of a joint between two bodies, only their relative motion counts")
{
    // Both turn about z, and drift.
    JointScene test(interaction("hinge", "Constraint/Hinge", "a", "b", placed()), true);
    TestFrame frame;
    frame.add(1, {{1, 0, 0}, turn_about_z(0.3)}, {4, 0, 0}, {0, 0, 2});
    frame.add(2, {{1, 0, 0}, turn_about_z(-0.2)}, {4, 0, 0}, {0, 0, -1});
    const auto& state = test.joints.of(frame.at(0), nullptr);
    CHECK(state.position._buffer[0] == doctest::Approx(-0.5));
    CHECK(state.velocity._buffer[0] == doctest::Approx(-3));
}

TEST_CASE("a slider's travel is along its axis, from where it was placed")
{
    // The axis' frame has z along x.
    auto parameters = placed("0.70710678118654757 0 0.70710678118654757 0");
    parameters.push_back({"travelled", "0.5", "m", "state"});
    JointScene test(interaction("rail", "Constraint/Slider", "a", "b", parameters), true);
    TestFrame frame;
    const Quat quarter = turn_about_z(std::acos(0.0));
    // The base has turned by a quarter: the axis is y now. It turns on at 1 rad/s, and b moves with it and away from it.
    frame.add(1, {{}, quarter}, {}, {0, 0, 1});
    frame.add(2, {{0, 2, 0}, quarter}, {-2, 0.25, 0}, {0, 0, 1});
    const auto& state = test.joints.of(frame.at(0), nullptr);
    CHECK(state.position._buffer[0] == doctest::Approx(2.5));
    CHECK(state.velocity._buffer[0] == doctest::Approx(0.25));
}

TEST_CASE("efforts are those of motors and springs on the same coordinate, and unknown elsewhere")
{
    JointScene test(interaction("hinge", "Constraint/Hinge", "", "b", placed()));
    add(test.scene, shaft("axle", 3));
    test.scene.interactions["spring"] = interaction("spring", "Constraint/TorsionSpring", "", "b", {{"along", "turn", "", "param"}});
    test.scene.interactions["motor"] = interaction("motor", "Constraint/Motor", "", "b", {{"along", "turn", "", "param"}});
    test.scene.interactions["slide"] = interaction("slide", "Constraint/Motor", "", "b", {{"along", "slide", "", "param"}});
    test.rebuild();
    CHECK(test.joints.has_drives());
    link::Metrics metrics;
    for (const auto& [id, name, text] :
         {std::tuple("spring", "effort", "-1.5"), std::tuple("motor", "torque", "7 7 4"), std::tuple("slide", "torque", "0 0 100")})
    {
        link::InteractionMetrics& m = metrics.interactions.emplace_back();
        m.component_id = id, m.outputs.push_back({name, text, "", "output"});
    }
    TestFrame frame;
    frame.add(2, {});
    frame.shafts.push_back({3, 8.0, 9.0});
    const auto& state = test.joints.of(frame.at(0), &metrics);
    REQUIRE(state.name._length == 2);
    REQUIRE(state.effort._length == 2);
    CHECK(std::string(state.name._buffer[0]) == "axle");
    CHECK(state.position._buffer[0] == 8);
    CHECK(state.velocity._buffer[0] == 9);
    CHECK(std::isnan(state.effort._buffer[0]));
    CHECK(state.effort._buffer[1] == doctest::Approx(2.5));
}

TEST_CASE("parameters that are no numbers make no joint, and a body that is missing in a frame none in that frame")
{
    auto parameters = placed();
    parameters[0].text = "1 0 nonsense 0";
    CHECK(JointScene(interaction("hinge", "Constraint/Hinge", "", "b", parameters)).joints.count() == 0);
    JointScene test(interaction("hinge", "Constraint/Hinge", "", "b", placed()));
    TestFrame empty;
    CHECK(test.joints.of(empty.at(0), nullptr).name._length == 0);
}

}  // namespace
}  // namespace plab::test
