#include "foxglove/scene.h"
#include "foxglove/contact_arrows.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>

using namespace plab;
using namespace plab::foxglove;

namespace
{

link::Object made_object(const std::string& id, const std::string& motion, std::uint32_t handle)
{
    link::Object out;
    out.component_id = id, out.name = id, out.type_name = "State/RigidBody", out.motion = motion, out.handle = handle, out.run = 1;
    out.shape_of = "body", out.shapes = {"ball"};
    return out;
}

DrawnScene small_scene()
{
    DrawnScene out;
    out.objects["moves"] = made_object("moves", "dynamic", 1);
    out.objects["stands"] = made_object("stands", "static", 2);
    out.shapes["ball"] = {"ball", "Shape/Sphere", "sphere", {}, {}, {0.5, 0, 0}, {}, {}};
    return out;
}

/// The first number behind the encapsulation: how many deletions, or transforms.
std::uint32_t first_count(const std::string& cdr)
{
    std::uint32_t out = 0;
    std::memcpy(&out, cdr.data() + 4, sizeof out);
    return out;
}

}  // namespace

TEST_CASE("the scene is sent anew only where it looks other")
{
    const DrawnScene before = small_scene();
    CHECK(scene_changes(before, before, 0).empty());
    DrawnScene now = before;
    now.objects["moves"].position = {1, 2, 3};
    now.objects["moves"].parameters = {{"mass", "2", "kg", "param"}};
    CHECK(scene_changes(before, now, 0).empty());
    now.objects["stands"].position = {1, 2, 3};
    auto changes = scene_changes(before, now, 0);
    REQUIRE(changes.size() == 1);
    CHECK(first_count(changes[0]) == 0);
    CHECK(changes[0].find("stands") != std::string::npos);
    CHECK(changes[0].find("moves") == std::string::npos);
    now = before;
    now.shapes["ball"].size.x = 1;
    changes = scene_changes(before, now, 0);
    REQUIRE(changes.size() == 1);
    CHECK(changes[0].find("moves") != std::string::npos);
    now = before;
    now.objects.erase("moves");
    changes = scene_changes(before, now, 0);
    REQUIRE(changes.size() == 1);
    CHECK(first_count(changes[0]) == 1);
    CHECK(changes[0].find("stands") == std::string::npos);
}

TEST_CASE("a large scene comes in pieces, and removes what was there before")
{
    DrawnScene scene = small_scene();
    for (int i = 0; i < 10000; ++i)
    {
        const std::string id = "object_" + std::to_string(i);
        scene.objects[id] = made_object(id, "dynamic", static_cast<std::uint32_t>(10 + i));
    }
    const SceneUpdates updates = whole_scene(scene, 0);
    REQUIRE(updates.size() > 1);
    CHECK(first_count(updates[0]) == 1);
    CHECK(first_count(updates[1]) == 0);
    for (const std::string& update : updates) CHECK(update.size() < (1u << 20) + 1000);
    CHECK(whole_scene(DrawnScene{}, 0).size() == 1);
}

TEST_CASE("frames have what moves, in the run to which it belongs")
{
    const DrawnScene scene = small_scene();
    FrameWriter writer;
    writer.use(scene.objects);
    plab_v2_BodyState bodies[2] = {};
    bodies[0].handle = 1, bodies[1].handle = 77;
    plab_v2_Frame frame{};
    frame.run = 1, frame.bodies._buffer = bodies, frame.bodies._length = 2;
    CHECK(first_count(writer.transforms(frame, 0)) == 1);
    CHECK(writer.transforms(frame, 0).find("moves") != std::string::npos);
    frame.run = 2;
    CHECK(first_count(writer.transforms(frame, 0)) == 0);
    CHECK(first_count(writer.transforms(scene.objects, 0)) == 1);
}

TEST_CASE("contact forces are arrows on what moves, in a scale that fits its weight")
{
    DrawnScene scene = small_scene();
    scene.objects["moves"].mass = 2;
    ContactArrows arrows;
    arrows.use(scene);
    // The weight of 2 kg is as long as the ball is thick.
    CHECK(arrows.scale() * 2 * 9.81 == doctest::Approx(1));
    wire::ContactForces contacts;
    const wire::ContactPoint down{{1, 2, 0}, {0, 0, -1}, 0, 2 * 9.81, {0, 0, 0}, false}, weak{{1, 2, 0}, {0, 0, -1}, 0, 1e-9, {}, false};
    contacts.entries = {{"contact", "moves", "stands", false, {down, weak}}};
    const std::string cdr = arrows.update(contacts, scene, 1'500'000'000);
    const auto number_at = [&](std::size_t offset)
    {
        double out = 0;
        std::memcpy(&out, cdr.data() + 4 + offset, sizeof out);
        return out;
    };
    // Deletions, entities, time, "world", "contacts", lifetime, frame_locked, metadata, then the arrows: a length, then position and
    // rotation.
    constexpr std::size_t kArrows = 4 + 4 + 8 + 4 + 8 + 4 + 12 + 8 + 4 + 0;
    std::uint32_t count = 0;
    std::memcpy(&count, cdr.data() + 4 + kArrows + 4, sizeof count);
    CHECK(count == 1);
    const std::size_t first = (kArrows + 8 + 7) / 8 * 8;
    CHECK(number_at(first) == 1);
    CHECK(number_at(first + 16) == 0);
    // x is turned to z, as the ground pushes the ball up: about -y by 90 degrees.
    CHECK(number_at(first + 32) == doctest::Approx(-std::sqrt(0.5)));
    CHECK(number_at(first + 48) == doctest::Approx(std::sqrt(0.5)));
    const double shaft = number_at(first + 56), head = number_at(first + 72);
    CHECK(shaft + head == doctest::Approx(1));
}
