// Rewinding affects the bodies of an event, and no others.
#include "support/scene.h"

using namespace plab;
using plab::test::Scene;

namespace
{

/// A bouncing ball, a tumbling box far away, and gears; with or without the ball's floor.
std::string bystanders(const std::string& resolution, bool with_floor)
{
    std::string s =
        "<component id=\"b\" type=\"Shape/Sphere\" radius=\"0.1\"/><component id=\"floor\" type=\"Shape/Plane\"/>"
        "<component id=\"ball\" type=\"State/RigidBody\" mass=\"1\" shape=\"b\" position=\"0 0 0.6\"/>"
        "<component id=\"box\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 2 2.5\" position=\"9 9 50\" angular_velocity=\"1 2 3\"/>"
        "<component id=\"g\" type=\"Field/Gravity\" between=\"ball box\"/>"
        "<component id=\"p\" type=\"State/Shaft\" inertia=\"1\" angular_velocity=\"1\"/><component id=\"q\" type=\"State/Shaft\" "
        "inertia=\"2\"/>"
        "<component id=\"gear\" type=\"Constraint/AngularVelocity/Graph\" driver=\"p\" driven=\"q\" velocity_factor=\"0.3\"/>"
        "<component id=\"ground\" type=\"State/Static\" shape=\"floor\"/>";
    if (with_floor)
        s += "<component id=\"contact\" type=\"CDetection/ODE\" between=\"ball ground\" resolution=\"Resolution/" + resolution +
             "\" response=\"Response/Impulse\" response.restitution=\"0.9\"/>";
    return s;
}

}  // namespace

TEST_CASE("with LocalBisection everything but the ball stays bit-identical")
{
    Scene with(bystanders("LocalBisection", true), "dt=\"1/60\""), without(bystanders("", false), "dt=\"1/60\"");
    REQUIRE_MESSAGE(with.loaded(), with.error());
    with.keep_events = true;
    for (int i = 0; i < 120; ++i)
    {
        with.step(), without.step();
        CHECK(with.vec("box", "position") == without.vec("box", "position"));
        CHECK(with.quat("box", "orientation") == without.quat("box", "orientation"));
        CHECK(with.vec("box", "angular_velocity") == without.vec("box", "angular_velocity"));
        CHECK(with.angle("q") == without.angle("q"));
    }
    CHECK(with.count("contact.impact") >= 3);
}

TEST_CASE("Bisection rewinds the whole world and agrees to rounding")
{
    Scene world(bystanders("Bisection", true), "dt=\"1/60\""), local(bystanders("LocalBisection", true), "dt=\"1/60\"");
    world.run(2), local.run(2);
    CHECK(test::distance(world.vec("ball", "position"), local.vec("ball", "position")) < 1e-10);
    CHECK(test::distance(world.vec("box", "position"), local.vec("box", "position")) < 1e-10);
}

TEST_CASE("a reader upstream keeps its bits when the one it pushes is rewound")
{
    const std::string scene =
        "<component id=\"fan\" type=\"State/Shaft\" inertia=\"1\" angular_velocity=\"3\"/>"
        "<component id=\"load\" type=\"Script/Lua\" driven=\"fan\"><param name=\"code\">function force(t, state) driven:add_torque(-0.3 * "
        "driven.speed) end</param></component>"
        "<component id=\"b\" type=\"Shape/Sphere\" radius=\"0.1\"/><component id=\"floor\" type=\"Shape/Plane\"/>"
        "<component id=\"ball\" type=\"State/RigidBody\" mass=\"1\" shape=\"b\" position=\"0 0 0.4\"/>"
        "<component id=\"push\" type=\"Script/Lua\" driver=\"fan\" driven=\"ball\"><param name=\"code\">"
        "function force(t, state) driven:add_force(vec(0, 0, -driver.speed)) end</param></component>"
        "<component id=\"ground\" type=\"State/Static\" shape=\"floor\"/>";
    const std::string contact =
        "<component id=\"contact\" type=\"CDetection/ODE\" between=\"ball ground\" resolution=\"Resolution/LocalBisection\" "
        "response=\"Response/Impulse\" "
        "response.restitution=\"1\"/>";
    Scene with(scene + contact, "dt=\"1/60\""), without(scene, "dt=\"1/60\""), fine(scene + contact, "dt=\"1/3000\"");
    REQUIRE_MESSAGE(with.loaded(), with.error());
    with.keep_events = true;
    with.run(2), without.run(2), fine.run(2);
    CHECK(with.count("contact.impact") >= 2);
    CHECK(with.spin("fan") == without.spin("fan"));
    CHECK(with.angle("fan") == without.angle("fan"));
    CHECK(test::distance(with.vec("ball", "position"), fine.vec("ball", "position")) < 1e-7);
}
