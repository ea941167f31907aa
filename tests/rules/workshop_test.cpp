// The paper's scene, put together by rules from parts that drift near one another: from the moment at which the clutch closes, its course
// is that of the hand-written scene.
#include "rules/workbench.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// Steps until the clutch closes: the boundary at which it was made.
Tick complete(Scene& s)
{
    while (!exists(s, "clutch.axle") && s.simulation().time() < 30) s.step();
    REQUIRE(exists(s, "clutch.axle"));
    return s.simulation().tick() - 1;
}

/// J of the whole train at the axle: the hand-written scene's inertias and ratios.
constexpr double kInertia = 0.001 + 0.002 + 0.25 * (0.008 + 0.001 + 0.005);

}  // namespace

TEST_CASE("the parts are drawn to their places and held there, in the order in which they come")
{
    Scene s = Scene::file("scenes/workshop.xml");
    serve(s);
    s.step();
    std::string made;
    complete(s);
    for (const Event& e : s.events)
        if (e.kind == "component.made" && e.message.find(".draw:") == std::string::npos)
            made += e.message.substr(0, e.message.find(':')) + " ";
    CHECK(made ==
          "blow.red collide.green.red bearing.axle bearing.second_axle key.small_gear key.large_gear mesh.large_gear.small_gear key.fan "
          "bolts.motor clutch.axle ");
    CHECK(s.real("mesh.large_gear.small_gear", "velocity_factor") == -2);
    CHECK(made_by(s, "clutch.axle") == "clutch");
    for (const char* const id : {"axle", "small_gear"}) CHECK(near(s.vec(id, "position").y, 0, 1e-5));
    for (const char* const id : {"second_axle", "large_gear", "fan"}) CHECK(near(s.vec(id, "position").y, 0.3, 1e-5));
    for (const char* const id : {"axle", "small_gear", "second_axle", "large_gear", "fan", "motor"})
        CHECK(near(s.vec(id, "position").z, 1, 1e-5));
    const auto t = s.simulation().totals();
    CHECK(std::fabs(t.kinetic - s.simulation().kinetic_at_start() - t.work) < 1e-6);
    CHECK(t.kinetic < 1e-9);
}

TEST_CASE("its course is that of scenes/fan_and_balloons.xml from the moment of completion")
{
    Scene shop = Scene::file("scenes/workshop.xml"), paper = Scene::file("scenes/fan_and_balloons.xml");
    serve(shop), serve(paper);
    const Tick begin = complete(shop);
    paper.step();
    CHECK(shop.simulation().tick() == begin + 1);
    double spin = 0, place = 0, speed = 0;
    for (int n = 0; n < 10 * 240; ++n)
    {
        shop.step(), paper.step();
        for (const char* const id : {"axle", "small_gear", "large_gear", "second_axle", "fan"})
        {
            const double axis = std::string(id) == "fan" ? -1 : 1;
            spin = std::max(spin, std::fabs(shop.vec(id, "angular_velocity").x - axis * paper.spin(id)));
        }
        for (const char* const id : {"red", "green"})
        {
            place = std::max(place, distance(shop.vec(id, "position"), paper.vec(id, "position")));
            speed = std::max(speed, distance(shop.vec(id, "linear_velocity"), paper.vec(id, "linear_velocity")));
        }
    }
    MESSAGE("spin ", spin, " rad/s, place ", place, " m, speed ", speed, " m/s");
    CHECK(shop.count("contact.impact") == 1);
    CHECK(paper.count("contact.impact") == 1);
    CHECK(spin < 1e-4);
    CHECK(place < 1e-5);
    CHECK(speed < 1e-5);
    // The closed form of the train: J w' = c (40 - w).
    const double t = 2401.0 / 240, w = 40 * (1 - std::exp(-0.01 / kInertia * t));
    CHECK(near(shop.vec("axle", "angular_velocity").x, w, 1e-6));
}

TEST_CASE("a replay of the workshop makes the same at the same steps, on any number of threads")
{
    Scene one = Scene::file("scenes/workshop.xml"), other = Scene::file("scenes/workshop.xml", 3);
    serve(one), serve(other);
    bool same = true;
    for (int n = 0; n < 12 * 240; ++n)
    {
        one.step(), other.step();
        same = same && one.hash() == other.hash();
    }
    CHECK(same);
    CHECK(exists(one, "clutch.axle"));
}
