// The robots of scenes/imported.
#include "unit/import/imported.h"

namespace plab::test
{
namespace
{

TEST_CASE("the arm from URDF and its twin from MJCF move alike")
{
    const auto from_urdf = imported_file("arm.urdf"), from_mjcf = imported_file("arm.mjcf");
    Scene urdf = imported_scene(from_urdf), mjcf = imported_scene(from_mjcf);
    CHECK(from_urdf.bodies == 2);
    CHECK(from_mjcf.bodies == 2);
    double moved = 0;
    for (int i = 0; i < 12; ++i)
    {
        urdf.run(0.25 * (i + 1)), mjcf.run(0.25 * (i + 1));
        for (const char* const joint : {"shoulder", "elbow"})
        {
            CHECK(std::fabs(urdf.real(joint, "angle") - mjcf.real(joint, "angle")) < 1e-9);
            moved = std::fmax(moved, std::fabs(urdf.real(joint, "angle")));
        }
    }
    CHECK(moved > 1);
}

TEST_CASE("colours of body and shape multiply to those of the file")
{
    const Scene scene = imported_scene(imported_file("arm.urdf"));
    const auto shown = [&](const char* shape)
    {
        const Vec3 a = scene.vec("fore", "color"), b = scene.vec(shape, "color");
        return Vec3{a.x * b.x, a.y * b.y, a.z * b.z};
    };
    CHECK(distance(shown("fore.shape"), {0.55, 0.6, 0.68}) < 1e-15);
    CHECK(distance(shown("fore.shape.1"), {0.9, 0.5, 0.15}) < 1e-15);
    CHECK(scene.vec("upper", "color") == Vec3{0.9, 0.5, 0.15});
}

TEST_CASE("the joints of the arm stay within their limits")
{
    Scene scene = imported_scene(imported_file("arm.urdf"));
    for (int i = 0; i < 5 * 240; ++i)
    {
        scene.step();
        CHECK(std::fabs(scene.real("shoulder", "angle")) < 2.5 + 1e-3);
        CHECK(std::fabs(scene.real("elbow", "angle")) < 2 + 1e-3);
    }
}

TEST_CASE("the walker falls and comes to lie on the floor, with its joints within their limits")
{
    const auto imported = imported_file("walker.mjcf");
    CHECK(!lists(imported, "motor"));
    CHECK(!lists(imported, "armature"));
    Scene scene = imported_scene(imported);
    scene.warnings_expected = true;
    scene.run(6);
    CHECK(scene.vec("torso", "position").z < 0.7);
    for (const char* const body : {"torso", "left_thigh", "left_shin", "right_thigh", "right_shin"})
    {
        CHECK(scene.vec(body, "position").z > 0.02);
        CHECK(length(scene.vec(body, "linear_velocity")) < 1e-3);
    }
    for (const char* const knee : {"left_knee", "right_knee"})
    {
        CHECK(scene.real(knee, "angle") > -0.02);
        CHECK(scene.real(knee, "angle") < 140 * 0.0174533 + 0.02);
    }
}

TEST_CASE("a robot as a part of a scene is a group with ids of its own, stands where it is wanted, and moves as it does alone")
{
    const std::string path = std::string(PLAB_SOURCE_DIR) + "/scenes/imported/arm.urdf";
    import::ImportOptions options;
    // A turn about z, so that gravity is the same.
    options.part = import::Part{"left", {{3, 4, 5}, {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}};
    const auto part = import::import_file(path, options);
    REQUIRE_MESSAGE(part.ok(), reasons(part));
    CHECK(part->root == "left/world");
    CHECK(part->blueprint.starts_with("<component id=\"left\">"));
    for (const char* of_scene : {"<scene", "Field/Gravity", "CDetection"})
        CHECK_MESSAGE(part->blueprint.find(of_scene) == std::string::npos, of_scene);
    // Twice in one scene: no id is taken.
    options.part->name = "right";
    const auto other = import::import_file(path, options);
    REQUIRE(other.ok());
    Scene both(part->blueprint + other->blueprint +
               R"(<component id="gravity" type="Field/Gravity" between="*" acceleration="0 0 -9.81"/>)");
    Scene alone = imported_scene(imported_file("arm.urdf"));
    CHECK(distance(both.vec("left/fore", "position"), Vec3{3, 4.5, 6}) < 1e-12);
    both.run(1), alone.run(1);
    CHECK(std::fabs(alone.real("elbow", "angle")) > 0.1);
    for (const char* joint : {"shoulder", "elbow"})
        CHECK(std::fabs(both.real("left/" + std::string(joint), "angle") - alone.real(joint, "angle")) < 1e-9);
}

}  // namespace
}  // namespace plab::test
