// From catalogue and state to geometry and text: no bus, no picture.
#include "viewer/scene_model.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "plab/rotation.h"
#include "viewer/painter.h"

namespace
{

using namespace plab;
using namespace plab::view;

doctest::Approx near(double value) { return doctest::Approx(value).epsilon(1e-12); }

link::Object body(const std::string& id, std::uint32_t handle, const std::string& motion, const std::string& shape)
{
    link::Object o;
    o.component_id = id, o.handle = handle, o.run = 1, o.motion = motion, o.position = {0, 0, 9}, o.shapes = {shape};
    return o;
}

link::Interaction interaction(const std::string& id, const std::string& type, std::int64_t since = 0)
{
    link::Interaction i;
    i.component_id = id, i.type_name = type, i.since = since, i.run = 1;
    return i;
}

/// A ball (handle 1, its sphere 0.5 m off the body's origin), a floor, a wheel on a shaft along x (handle 2).
link::CatalogueContents sample()
{
    link::CatalogueContents s;
    s.scene.emplace();
    s.scene->run = 1, s.scene->title = "Sample";
    s.shapes["round"] = {"round", "Shape/Sphere", "sphere", {0.5, 0, 0}, {}, {0.25, 0, 0}, {}, {}};
    s.shapes["flat"] = {"flat", "Shape/Plane", "plane", {}, {}, {}, {}, {}};
    s.objects["ball"] = body("ball", 1, "dynamic", "round");
    s.objects["floor"] = body("floor", 7, "static", "flat");
    link::Object wheel = body("wheel", 2, "dynamic", "");
    wheel.shape_of = "shaft", wheel.shapes.clear(), wheel.mass = 0.01, wheel.position = {0, 5, 0};
    wheel.orientation = {std::sqrt(0.5), 0, std::sqrt(0.5), 0};  // z of the axle along x
    s.objects["wheel"] = wheel;
    s.interactions["contact"] = interaction("contact", "CDetection/ODE");
    return s;
}

State at(double time, std::int64_t step = 0)
{
    State s{1, 0, step, time, {}, {}};
    s.bodies.push_back({1, {{0, 0, 2}, {}}});
    s.shafts.push_back({2, 0});
    return s;
}

const render::Item* find_form(const render::Drawing& drawing, render::Form form)
{
    for (const render::Item& item : drawing.items)
        if (item.form == form) return &item;
    return nullptr;
}

SceneModel model_of(const link::CatalogueContents& snapshot)
{
    SceneModel model({true, true});
    model.use(std::make_shared<link::CatalogueContents>(snapshot));
    return model;
}

}  // namespace

TEST_CASE("a body is drawn in the pose of its state, together with its shape; a static one in the pose of the catalogue")
{
    SceneModel model = model_of(sample());
    State state = at(0);
    state.bodies[0].pose.q = exp_rotation({0, 0, std::numbers::pi / 2});
    const render::Drawing& drawing = model.draw(state);
    const render::Item* const ball = find_form(drawing, render::Form::Sphere);
    REQUIRE(ball != nullptr);
    CHECK(ball->pose.p.x == doctest::Approx(0).epsilon(1e-12));
    CHECK(ball->pose.p.y == near(0.5));
    CHECK(ball->pose.p.z == near(2));
    CHECK(ball->size.x == 0.25);
    const render::Item* const floor = find_form(drawing, render::Form::Plane);
    REQUIRE(floor != nullptr);
    CHECK(floor->pose.p.z == 9);
}

TEST_CASE("capsules and cylinders have shapes of their own; a compound is drawn as its triangles")
{
    link::CatalogueContents snapshot = sample();
    snapshot.shapes["round"].form = "capsule";
    CHECK(find_form(model_of(snapshot).draw(at(0)), render::Form::Capsule) != nullptr);
    snapshot.shapes["round"].form = "compound";
    snapshot.shapes["round"].vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    snapshot.shapes["round"].triangles = {0, 1, 2};
    SceneModel model = model_of(snapshot);
    const render::Drawing& drawing = model.draw(at(0));
    REQUIRE(find_form(drawing, render::Form::Mesh) != nullptr);
    CHECK(drawing.meshes.size() == 1);
    snapshot.objects["wheel"].shapes = {"round"};
    snapshot.shapes["round"].form = "cylinder";
    CHECK(find_form(model_of(snapshot).draw(at(0)), render::Form::Cylinder) != nullptr);
}

TEST_CASE("a shaft without shapes is drawn as an axle with a mark that rotates by its angle")
{
    SceneModel model = model_of(sample());
    State state = at(0);
    state.shafts[0].angle = 0.3;
    const render::Drawing& drawing = model.draw(state);
    const render::Item* const axle = find_form(drawing, render::Form::Cylinder);
    const render::Item* const mark = find_form(drawing, render::Form::Box);
    REQUIRE(axle != nullptr);
    REQUIRE(mark != nullptr);
    const Vec3 along = rotate(axle->pose.q, {0, 0, 1});
    CHECK(along.x == near(1));
    // The axle's frame has x along -z of the world and y along y: at angle a the mark is at (0, sin a, -cos a).
    const Vec3 arm = mark->pose.p - Vec3{0, 5, 0};
    const double radius = length(arm);
    CHECK(radius > 0.5 * axle->size.x);
    CHECK(arm.y == near(radius * std::sin(0.3)));
    CHECK(arm.z == near(-radius * std::cos(0.3)));
}

TEST_CASE("the radius of an axle depends on its inertia, within bounds")
{
    // A disk of radius 0.1 m, length 0.05 m, density 1000: J = m r^2 / 2.
    const double mass = 1000 * std::numbers::pi * 0.1 * 0.1 * 0.05;
    CHECK(link::axle_of_inertia(mass * 0.1 * 0.1 / 2).radius == near(0.1));
    CHECK(link::axle_of_inertia(0).radius == 0.05);
    CHECK(link::axle_of_inertia(1e6).radius == 0.5);
}

TEST_CASE("objects that the catalogue or the state does not have yet are left out until it has them")
{
    link::CatalogueContents snapshot = sample();
    SceneModel model = model_of(snapshot);
    State state = at(0);
    state.bodies.push_back({3, {{1, 1, 1}, {}}});
    CHECK(model.draw(state).items.size() == 4);  // ball, floor, axle, mark
    snapshot.objects["late"] = body("late", 3, "dynamic", "round");
    model.use(std::make_shared<link::CatalogueContents>(snapshot));
    CHECK(model.draw(state).items.size() == 5);
    CHECK(model.draw(at(0)).items.size() == 4);
    SUBCASE("a handle of another run means another object")
    {
        state.run = 2;
        CHECK(model.draw(state).items.size() == 1);
    }
}

TEST_CASE("meshes are passed on once, and again only when one changes")
{
    link::CatalogueContents snapshot = sample();
    snapshot.shapes["tetra"] = {
        "tetra", "Shape/Mesh", "mesh", {}, {}, {}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}};
    snapshot.objects["ball"].shapes = {"round", "tetra"};
    SceneModel model = model_of(snapshot);
    const std::uint64_t revision = model.draw(at(0)).meshes_revision;
    const render::Drawing& drawing = model.draw(at(0));
    REQUIRE(drawing.meshes.size() == 1);
    CHECK(drawing.meshes[0].triangles == std::vector<std::uint32_t>{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
    REQUIRE(find_form(drawing, render::Form::Mesh) != nullptr);
    snapshot.interactions["contact"].type_name = "CDetection/Other";
    model.use(std::make_shared<link::CatalogueContents>(snapshot));
    CHECK(model.draw(at(0)).meshes_revision == revision);
    snapshot.shapes["tetra"].vertices[3].z = 2;
    model.use(std::make_shared<link::CatalogueContents>(snapshot));
    CHECK(model.draw(at(0)).meshes_revision != revision);
}

TEST_CASE("a caption shows each algorithm as it was at the step of the state")
{
    link::CatalogueContents snapshot = sample();
    SceneModel model = model_of(snapshot);
    const auto lines = [&](std::int64_t step)
    {
        std::vector<std::string> out;
        for (const render::Caption& c : model.draw(at(1.5, step)).captions) out.push_back(c.text);
        return out;
    };
    CHECK(lines(0) == std::vector<std::string>{"Sample, t = 1.500 s", "contact: CDetection/ODE"});
    snapshot.interactions["contact"] = interaction("contact", "CDetection/Other", 100);
    model.use(std::make_shared<link::CatalogueContents>(snapshot));
    CHECK(lines(99).back() == "contact: CDetection/ODE");
    CHECK(lines(100).back() == "contact: CDetection/Other");
}

TEST_CASE("of many interactions, those with the same algorithm share a line: who runs at which level")
{
    link::CatalogueContents snapshot = sample();
    for (int i = 10; i < 51; ++i)
    {
        const std::string id = "i" + std::to_string(i);
        snapshot.interactions[id] = interaction(id, i < 20 ? "Solver/DormandPrince54" : "Solver/RungeKutta4");
    }
    Captions captions;
    captions.use(snapshot);
    std::vector<std::string> lines = captions.lines(at(0));
    REQUIRE(lines.size() == 4);
    CHECK(lines[1] == "contact: CDetection/ODE");
    CHECK(lines[2] == "Solver/DormandPrince54: 10, such as i10");
    CHECK(lines[3] == "Solver/RungeKutta4: 31, such as i20");
    // Two change their level before step 7.
    for (const char* id : {"i10", "i11"})
        snapshot.interactions[id] = interaction(id, "Solver/RungeKutta4"), snapshot.interactions[id].since = 7;
    captions.use(snapshot);
    CHECK(captions.lines(at(0, 6))[2] == "Solver/DormandPrince54: 10, such as i10");
    CHECK(captions.lines(at(0, 7))[2] == "Solver/DormandPrince54: 8, such as i12");
    CHECK(captions.lines(at(0, 7))[3] == "Solver/RungeKutta4: 33, such as i10");
}

TEST_CASE("of many algorithms the most expensive ones are shown, and the number of the other interactions")
{
    link::CatalogueContents snapshot = sample();
    snapshot.metrics.emplace();
    for (int i = 10; i < 51; ++i)
    {
        const std::string id = "i" + std::to_string(i);
        snapshot.interactions[id] = interaction(id, "Field/F" + std::to_string(i));
        link::InteractionMetrics metrics;
        metrics.component_id = id, metrics.cost_ns = i % 2 == 0 ? i : 0;
        snapshot.metrics->interactions.push_back(metrics);
    }
    Captions captions;
    captions.use(snapshot);
    const std::vector<std::string> lines = captions.lines(at(0));
    REQUIRE(lines.size() == 14);
    CHECK(lines[1] == "i28: Field/F28");
    CHECK(lines[12] == "i50: Field/F50");
    CHECK(lines[13] == "and 30 more");
}

TEST_CASE("an object without a colour gets one from its id; a given colour is kept")
{
    link::CatalogueContents snapshot = sample();
    snapshot.objects["ball"].color = Vec3{0.1, 0.2, 0.3};
    SceneModel model = model_of(snapshot);
    CHECK(find_form(model.draw(at(0)), render::Form::Sphere)->color == Vec3{0.1, 0.2, 0.3});
    CHECK(find_form(model.draw(at(0)), render::Form::Cylinder)->color == link::color_of_id("wheel"));
    CHECK(link::color_of_id("wheel") == link::color_of_id("wheel"));
}

TEST_CASE("the view: a named camera, the front one, everything; and the effect of the options")
{
    link::CatalogueContents snapshot = sample();
    snapshot.scene->cameras = {{"side", {9, 0, 0}, {}, {0, 0, 1}, 0.5}, {"front", {0, -9, 0}, {}, {0, 0, 1}, 0.6}};
    SceneModel model = model_of(snapshot);
    const std::vector<render::Item> items = model.draw(at(0)).items;
    const auto view_of = [&](const ViewChoice& choice, double time = 0)
    {
        view::CameraController controller(choice);
        return controller.find(model, items, at(time));
    };
    CHECK(view_of({})->position == Vec3{0, -9, 0});
    CHECK(view_of({.camera = "side"})->position == Vec3{9, 0, 0});
    CHECK(view_of({.camera = "side"})->field_of_view == 0.5);
    CHECK(view_of({.camera = "top"}).error().reason == "the scene has no camera 'top'; it has: side, front");
    CHECK(view_of({.track = "ball"})->look_at == Vec3{0, 0, 2});
    CHECK(view_of({.track = "bal"}).error().reason == "the scene has no object 'bal' to track");
    CHECK(view_of({.from = Vec3{1, 2, 3}, .look_at = Vec3{0, 1, 0}})->position == Vec3{1, 2, 3});

    const auto orbit = [&](double time) { return *view_of({.look_at = Vec3{1, 0, 0}, .orbit = 4, .orbit_period = 8}, time); };
    const Vec3 start = orbit(0).position - Vec3{1, 0, 0}, quarter = orbit(2).position - Vec3{1, 0, 0};
    CHECK(length(start) == near(4));
    CHECK(quarter.x == doctest::Approx(-start.y).epsilon(1e-9));
    CHECK(quarter.y == doctest::Approx(start.x).epsilon(1e-9));
    CHECK(quarter.z == near(start.z));
}
