// Requests and scripts that once broke a scene: each is refused, or has the intended effect.
#include "support/scene.h"

using namespace plab;
using namespace plab::simulation;
using plab::test::first_error;
using plab::test::Scene;

namespace
{

const char* const kResting = R"(<component id="floor" type="Shape/Plane"/><component id="ground" type="State/Static" shape="floor"/>
  <component id="s" type="Shape/Sphere" radius="0.5"/>
  <component id="a" type="State/RigidBody" mass="1" shape="s" position="0 0 0.5"/><component id="b" type="State/RigidBody" mass="1" shape="s" position="3 0 0.5"/>
  <component id="g" type="Field/Gravity" between="*"/>
  <component id="contact" type="CDetection/ODE" between="*" resolution="Resolution/LocalBisection" response="Response/Impulse"/>)";

std::string script(const std::string& set)
{
    return "<component id=\"x\" type=\"Script/Lua\"><param name=\"code\">function drive(step) if step.tick == 5 then " + set +
           " end end</param></component>";
}

}  // namespace

TEST_CASE("a sensor supports no body: a resting body falls")
{
    Scene s(kResting, "dt=\"1/240\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1);
    REQUIRE(s.ask(SwapOperation{"contact.response", "Response/None", {}}).done);
    s.run(2);
    CHECK(s.vec("a", "position").z == doctest::Approx(0.5 - 0.5 * 9.81).epsilon(1e-6));
}

TEST_CASE("a resting body can be removed, and its place taken by another")
{
    Scene s(kResting, "dt=\"1/240\"");
    s.run(0.5);
    REQUIRE(s.ask(RemoveOperation{"a"}).done);
    s.run(1);
    CHECK(s.simulation().stepper().contacts().pairs().size() == 1);
    CHECK(std::fabs(s.vec("b", "position").z - 0.5) < 1e-9);
}

TEST_CASE("scripts' changes obey the rules of requests")
{
    for (const char* set : {"set(\"s\", \"radius\", -1)", "set(\"grp\", \"mass\", 2)", "set(\"nobody\", \"mass\", 2)",
                            "set(\"a\", \"mas\", 2)", "set(\"contact.response\", \"restitution\", 5)"})
    {
        CAPTURE(set);
        Scene s(std::string(kResting) + "<component id=\"grp\"><component id=\"in\" type=\"State/Shaft\" inertia=\"1\"/></component>" +
                    script(set),
                "dt=\"1/240\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = s.keep_events = true;
        s.run(0.1);
        CHECK(s.count("script.refused") == 1);
        CHECK(std::fabs(s.vec("a", "position").z - 0.5) < 1e-9);
    }
    // Everything that depends on a shape follows, and the frame that the author defined stays.
    Scene s(
        "<component id=\"s\" type=\"Shape/Sphere\" radius=\"0.5\"/><component id=\"a\" type=\"State/RigidBody\" density=\"1000\" "
        "shape=\"s\"/>" +
            script("set(\"s\", \"radius\", 1)"),
        "dt=\"1/240\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(0.1);
    CHECK(s.simulation().world().host().bodies.mass[0] == doctest::Approx(1000 * 4.0 / 3 * 3.141592653589793).epsilon(1e-12));
}

TEST_CASE("requests to the clock are transactions too")
{
    Scene s(kResting, "dt=\"1/240\"");
    CHECK(!s.ask_all({PauseOperation{}, RateOperation{-1}}).done);
    CHECK(!s.simulation().paused());
    CHECK(!s.ask(StepLengthOperation{{-1, -1, 1}}).done);
    CHECK(!s.ask(StepLengthOperation{{0.001, -1, -1000}}).done);
    CHECK(!s.ask_all({}).done);
    s.step(240);
    CHECK(s.simulation().time() == 1.0);
}

TEST_CASE("work stays with the component that did it, and requests have an account of their own")
{
    Scene s(
        "<component id=\"a\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 1 1\"/><component id=\"g\" type=\"Field/Gravity\" "
        "between=\"a\"/>",
        "dt=\"1/240\"");
    const auto unexplained = [&]
    {
        const auto t = s.simulation().totals();
        return std::fabs(t.kinetic - s.simulation().kinetic_at_start() - t.work);
    };
    s.run(1);
    REQUIRE(s.ask(PushOperation{"a", {3, 0, 0}, {}}).done);
    CHECK(unexplained() < 1e-9);
    REQUIRE(s.ask(SetOperation{"a", "linear_velocity", std::string("0 1 0")}).done);
    CHECK(unexplained() < 1e-9);
    REQUIRE(s.ask(RemoveOperation{"g"}).done);
    CHECK(unexplained() < 1e-9);
    s.run(2);
    CHECK(unexplained() < 1e-9);
}

TEST_CASE("a body is made static and dynamic again by a swap")
{
    Scene s(kResting, "dt=\"1/240\"");
    REQUIRE(s.ask(SetOperation{"b", "position", std::string("3 0 20")}).done);
    s.run(0.5);
    const Vec3 at = s.vec("b", "position");
    const Reply frozen = s.ask(SwapOperation{"b", "State/Static", {}});
    REQUIRE_MESSAGE(frozen.done, first_error(frozen.errors));
    s.run(1);
    CHECK(s.vec("b", "position") == at);
    const Reply free =
        s.ask(SwapOperation{"b", "State/RigidBody", {{"mass", std::string("2")}, {"linear_velocity", std::string("1 0 0")}}});
    REQUIRE_MESSAGE(free.done, first_error(free.errors));
    s.run(1.5);
    CHECK(s.vec("b", "position").z == doctest::Approx(at.z - 0.5 * 9.81 * 0.25).epsilon(1e-9));
    CHECK(s.vec("b", "linear_velocity").x == 1);
}

TEST_CASE("fifty balls land at one time in bounded work, with any resolution")
{
    for (const char* resolution : {"Bisection", "LocalBisection"})
    {
        CAPTURE(resolution);
        Scene s(
            std::string("<component id=\"floor\" type=\"Shape/Plane\"/><component id=\"ground\" type=\"State/Static\" shape=\"floor\"/>"
                        "<component id=\"s\" type=\"Shape/Sphere\" radius=\"0.1\"/><repeat id=\"all\" count=\"10 5\" step=\"0.5 0.5 0\">"
                        "<component id=\"ball\" type=\"State/RigidBody\" mass=\"1\" shape=\"s\" position=\"0 0 0.6\"/></repeat>"
                        "<component id=\"g\" type=\"Field/Gravity\" between=\"*\"/><component id=\"contact\" type=\"CDetection/ODE\" "
                        "between=\"all ground\" "
                        "resolution=\"Resolution/") +
                resolution + "\" response=\"Response/Impulse\" response.restitution=\"1\"/>",
            "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        s.run(0.5);
        CHECK(s.count("contact.impact") == 50);
        const double t = 0.5, fall = std::sqrt(2 * 0.5 / 9.81), v = 9.81 * fall;
        const double z = 0.1 + v * (t - fall) - 0.5 * 9.81 * (t - fall) * (t - fall);
        for (const char* ball : {"ball.0.0", "ball.9.4"}) CHECK(std::fabs(s.vec(ball, "position").z - z) < 1e-9);
    }
}
