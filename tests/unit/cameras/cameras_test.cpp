/// When a camera draws, what it shows, and which errors it reports.
#include <doctest/doctest.h>

#include <set>

#include "objects/cameras/osmesa_camera.h"
#include "plab/plugin.h"
#include "support/scene.h"
#include "unit/objects/table.h"

using namespace plab;
using namespace plab::cameras;
using plab::test::TableFixture;

extern "C" void plab_plugin_register(plab::Registrar& registrar);

namespace
{

struct Viewer final : ImageSink
{
    bool is_present = true;
    std::uint32_t component = kNoIndex;
    std::vector<std::vector<std::uint8_t>> pictures;
    std::uint32_t width = 0, height = 0;

    bool wanted() const override { return is_present; }
    void show(std::uint32_t camera, std::uint32_t w, std::uint32_t h, std::vector<std::uint8_t> rgba) override
    {
        component = camera, width = w, height = h;
        pictures.push_back(std::move(rgba));
    }
    /// Red, green, blue of the picture's middle.
    Vec3 middle() const
    {
        const std::uint8_t* p = pictures.back().data() + 4 * (height / 2 * width + width / 2);
        return Vec3{double(p[0]), double(p[1]), double(p[2])};
    }
};

struct Events final : EventSink
{
    std::vector<Event> all;
    void emit(Event event) override { all.push_back(std::move(event)); }
};

/// One small camera that looks along y at a red ball.
struct Room
{
    TableFixture<CameraRows> camera;
    Geometry ball;
    std::vector<Visual> visuals;
    std::vector<NamedView> views{{"front", {0, -5, 0}, {}, {0, 0, 1}, 0.7}, {"above", {0, 0, 5}, {}, {0, 1, 0}, 0.7}};
    std::vector<std::string> algorithms;
    Viewer viewer;
    Events events;
    std::uint64_t revision = 1;

    Room()
    {
        camera.indices[0] = 7;
        camera.rows.width[0] = 64, camera.rows.height[0] = 48;
        camera.rows.position[0] = {0, -5, 0};
        camera.rows.captions[0] = false;
        ball.kind = GeometryKind::Sphere, ball.size = {1, 0, 0};
        visuals.push_back({&ball, {}, {}, {0.9, 0.05, 0.05}, 0});
    }
    void step(double time)
    {
        StepContext context = camera.context();
        context.time = time, context.events = &events;
        const RenderScene render_scene{visuals, views, algorithms, revision};
        draw(context, 0, camera.rows, render_scene, viewer);
    }
};

bool is_red(const Vec3& c) { return c.x > 2 * c.y && c.x > 2 * c.z; }

}  // namespace

TEST_CASE("pictures are drawn at their rate in simulated time, at most one per step")
{
    Room room;
    room.camera.rows.frames_per_second[0] = 25;
    for (int step = 1; step <= 240; ++step) room.step(step / 240.0);
    CHECK(room.viewer.pictures.size() == 26);  // at the first step, and at 1/25, 2/25 .. 1 s
    CHECK(room.viewer.component == 7);
    CHECK(room.viewer.width == 64);
    CHECK(room.viewer.height == 48);
    CHECK(room.viewer.pictures[0].size() == 4 * 64 * 48);

    room.viewer.pictures.clear();
    room.camera.rows.frames_per_second[0] = 1000;
    for (int step = 241; step <= 250; ++step) room.step(step / 240.0);
    CHECK(room.viewer.pictures.size() == 10);
    room.step(1 / 240.0);  // a reset
    CHECK(room.viewer.pictures.size() == 11);
}

TEST_CASE("without a viewer nothing is drawn and no renderer is created; the next picture is drawn as soon as there is one")
{
    Room room;
    room.viewer.is_present = false;
    for (int step = 1; step <= 10; ++step) room.step(step / 10.0);
    CHECK(room.viewer.pictures.empty());
    CHECK(room.camera.rows.studio[0].renderer == nullptr);
    room.viewer.is_present = true;
    room.step(1.01);
    CHECK(room.viewer.pictures.size() == 1);
}

TEST_CASE("the view is the scene's camera of that name, the camera's own pose, or one that shows everything")
{
    Room room;
    room.step(1);
    CHECK(is_red(room.viewer.middle()));
    room.camera.rows.look_at[0] = {0, -10, 0};
    room.step(2);
    CHECK_FALSE(is_red(room.viewer.middle()));
    room.camera.rows.view[0] = "above";
    room.step(3);
    CHECK(is_red(room.viewer.middle()));
    room.camera.rows.view[0].clear();
    room.camera.rows.position[0] = *std::get_if<Vec3>(&room.camera.schema.find_field("position")->fallback);
    room.step(4);
    CHECK(is_red(room.viewer.middle()));
    // It does not move while the ball leaves, until an object is added or removed.
    room.visuals[0].pose.p = {0, 0, 50};
    room.step(5);
    CHECK_FALSE(is_red(room.viewer.middle()));
    room.revision = 2;
    room.step(6);
    CHECK(is_red(room.viewer.middle()));
}

TEST_CASE("all kinds of geometry, and shafts without any, are visible")
{
    Room room;
    room.camera.rows.position[0] = {0, -5, 1};
    room.step(1);
    std::set<std::vector<std::uint8_t>> different{room.viewer.pictures.back()};
    room.ball.size = {0.5, 0.9, 0.7};
    room.ball.vertices = {{-1, 0, -1}, {1, 0, -1}, {0, 0, 1}};
    room.ball.triangles = {0, 1, 2};
    double time = 1;
    for (const GeometryKind kind : {GeometryKind::Box, GeometryKind::Plane, GeometryKind::Mesh, GeometryKind::None})
    {
        room.ball.kind = kind, ++room.revision;
        room.step(++time);
        CHECK(different.insert(room.viewer.pictures.back()).second);
    }
    room.visuals[0].geometry = nullptr, room.visuals[0].size = {0.2, 0.2, 0.8};
    room.step(++time);
    CHECK(different.insert(room.viewer.pictures.back()).second);
    CHECK(room.events.all.empty());
}

TEST_CASE("captions show the time and the algorithms, sub-components in the line of their owner")
{
    Room room;
    room.step(1);
    room.camera.rows.captions[0] = true;
    room.step(2);
    room.step(3);
    room.algorithms = {"contact: CDetection/ODE", "contact.response: Response/Impulse", "wind: Script/Lua"};
    room.step(4);
    const auto& captions = room.camera.rows.studio[0].drawing.captions;
    REQUIRE(captions.size() == 3);
    CHECK(captions[0].text == "t = 4.000 s");
    CHECK_FALSE(captions[0].bottom);
    CHECK(captions[1].text == "contact: CDetection/ODE, Response/Impulse");
    CHECK(captions[2].text == "wind: Script/Lua");
    CHECK(captions[2].bottom);
    const auto& pictures = room.viewer.pictures;
    CHECK(pictures[0] != pictures[1]);
    CHECK(pictures[1] != pictures[2]);
}

TEST_CASE("a change of size creates another renderer")
{
    Room room;
    room.step(1);
    room.camera.rows.width[0] = 80;
    room.step(2);
    CHECK(room.viewer.width == 80);
    CHECK(room.viewer.pictures.back().size() == 4 * 80 * 48);
}

TEST_CASE("a camera that cannot draw reports that once, and draws as soon as it can")
{
    Room room;
    room.camera.rows.view[0] = "behind";
    for (int i = 1; i <= 3; ++i) room.step(i);
    CHECK(room.viewer.pictures.empty());
    REQUIRE(room.events.all.size() == 1);
    CHECK(room.events.all[0].kind == "camera.error");
    CHECK(room.events.all[0].component == 7);
    CHECK(room.events.all[0].message == "no picture: the scene has no <camera id=\"behind\">; it has front, above");
    room.camera.rows.view[0] = "front";
    room.step(4);
    CHECK(room.viewer.pictures.size() == 1);
    room.camera.rows.view[0] = "behind";
    room.step(5);
    CHECK(room.events.all.size() == 2);
}

TEST_CASE("a camera in a scene shows the end of each step and changes no bit of it")
{
    const std::string balls = R"(<component id="form" type="Shape/Sphere" radius="0.5"/>
        <component id="ball" type="State/RigidBody" mass="1" shape="form" color="0.9 0.1 0.1" linear_velocity="0 0 -3"/>)";
    const std::string camera = R"(<component id="eye" type="Camera/OSMesa" width="64" height="48" position="0 -5 0" captions="no"/>)";
    plab::test::Scene plain(balls), seen(balls + camera);
    REQUIRE_MESSAGE(seen.loaded(), seen.error());
    Viewer viewer;
    seen.simulation().draw_for(&viewer);
    plain.step(), seen.step();
    REQUIRE(viewer.pictures.size() == 1);
    CHECK(is_red(viewer.middle()));
    plain.step(239), seen.step(239);
    CHECK(viewer.pictures.size() == 26);
    CHECK_FALSE(is_red(viewer.middle()));
    CHECK(seen.vec("ball", "position") == plain.vec("ball", "position"));
    CHECK(seen.hash() == plain.hash());
}

TEST_CASE("the plugin declares the paper's Draw")
{
    Registrar registrar;
    plab_plugin_register(registrar);
    REQUIRE(registrar.types().size() == 1);
    const TypeInfo& type = registrar.types().front();
    CHECK(type.name == "Camera/OSMesa");
    CHECK(type.family == "Camera");
    REQUIRE(type.commands.size() == 1);
    CHECK(type.commands[0].name == "Camera/Draw");
    CHECK(type.commands[0].phase == Phase::Draw);
    for (const Access& access : type.commands[0].access) CHECK(access.writes == (access.table == "own" || access.table == "Images"));
}
