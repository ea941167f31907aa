// Impacts and resting contact against closed forms. C1.. as in the catalogue of reference problems.
#include "support/ground.h"
#include "support/scene.h"

using namespace plab;
using plab::test::distance;
using plab::test::kGround;
using plab::test::near;
using plab::test::Scene;

namespace
{

std::string contact(const std::string& between, const std::string& resolution, const std::string& restitution,
                    const std::string& friction = "0")
{
    return "<component id=\"contact\" type=\"CDetection/ODE\" between=\"" + between + "\" resolution=\"Resolution/" + resolution +
           "\" response=\"Response/Impulse\" response.restitution=\"" + restitution + "\" response.friction=\"" + friction + "\"/>";
}

std::string ball(const std::string& id, const std::string& attributes, double radius = 0.1)
{
    return "<component id=\"" + id + ".shape\" type=\"Shape/Sphere\" radius=\"" + std::to_string(radius) + "\"/><component id=\"" + id +
           "\" type=\"State/RigidBody\" shape=\"" + id + ".shape\" " + attributes + "/>";
}

/// Height of a ball that fell from rest at h above its contact height, elastic, at time t.
double bouncing_height(double h, double t)
{
    const double g = 9.81, fall = std::sqrt(2 * h / g);
    double phase = std::fmod(t + fall, 2 * fall) - fall;
    return h - 0.5 * g * phase * phase;
}

}  // namespace

TEST_CASE("C1: head-on spheres, mass ratios to 1e9, to 1e-14")
{
    for (const char* mass : {"1", "1e3", "1e6", "1e9"})
        for (const char* e : {"0", "0.5", "1"})
        {
            CAPTURE(mass);
            CAPTURE(e);
            Scene s(ball("a", "mass=\"1\" position=\"-0.3 0 0\" linear_velocity=\"1 0 0\"") +
                        ball("b", std::string("mass=\"") + mass + "\" position=\"0.3 0 0\"") + contact("a b", "LocalBisection", e),
                    "dt=\"1/60\"");
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.run(1);
            const double m2 = std::stod(mass), rest = std::stod(e);
            const double v1 = (1 - m2 * rest) / (1 + m2), v2 = (1 + rest) / (1 + m2);
            CHECK(near(s.vec("a", "linear_velocity").x, v1, 1e-14));
            CHECK(std::fabs(s.vec("b", "linear_velocity").x / v2 - 1) < 1e-13);
        }
}

TEST_CASE("C2: a sphere meets a wall at an angle: stick and slip, the same in all directions")
{
    for (const double vt : {3.0, 12.0})
        for (int k = 0; k < 8; ++k)
        {
            const double angle = 0.7853981633974483 * k + 0.1;
            const Vec3 t{std::cos(angle), std::sin(angle), 0};
            char velocity[128];
            std::snprintf(velocity, sizeof velocity, "linear_velocity=\"%.17g %.17g -4\"", vt * t.x, vt * t.y);
            Scene s(kGround + ball("a", std::string("mass=\"1\" position=\"0 0 0.5\" ") + velocity) +
                        contact("a ground", "LocalBisection", "0.8", "0.3"),
                    "dt=\"1/60\"");
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.run(0.5);
            const double vt_after = vt == 3.0 ? 15.0 / 7 : 9.84, w_after = vt == 3.0 ? 150.0 / 7 : 54.0;
            CHECK(near(s.vec("a", "linear_velocity").z, 3.2, 1e-13));
            CHECK(distance(s.vec("a", "linear_velocity") - Vec3{0, 0, 3.2}, t * vt_after) < 2e-13);
            CHECK(distance(s.vec("a", "angular_velocity"), cross(Vec3{0, 0, 1}, t) * w_after) < 1.1e-13 * w_after);
        }
}

TEST_CASE("C3: the end of a rod hits an edge: the effective mass is a quarter of its mass")
{
    // A slender rod along x, m = 1, L = 1, falls with v = 1; its end meets a small fixed sphere.
    Scene s(
        "<component id=\"rod.shape\" type=\"Shape/Box\" half_extents=\"0.5 0.001 0.001\"/>"
        "<component id=\"rod\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1e-3 0.083333333333333333 0.083333333333333333\" "
        "shape=\"rod.shape\" "
        "position=\"0 0 0.5\" linear_velocity=\"0 0 -1\"/>"
        "<component id=\"edge.shape\" type=\"Shape/Sphere\" radius=\"0.1\"/>"
        "<component id=\"edge\" type=\"State/Static\" shape=\"edge.shape\" position=\"0.499999999 0 0\"/>" +
            contact("rod edge", "LocalBisection", "0.5"),
        "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    while (s.count("contact.impact") == 0 && s.simulation().time() < 1) s.step();
    CHECK(near(s.vec("rod", "linear_velocity").z, -0.625, 1e-7));
    CHECK(near(std::fabs(s.vec("rod", "angular_velocity").y), 2.25, 1e-7));
}

TEST_CASE("C4: an elastic ball keeps its heights and its times for ten seconds at dt = 1/60")
{
    for (const char* resolution : {"Bisection", "LocalBisection"})
    {
        CAPTURE(resolution);
        Scene s(kGround + ball("a", "mass=\"10\" position=\"0 0 5.1\"") + "<component id=\"g\" type=\"Field/Gravity\" between=\"a\"/>" +
                    contact("a ground", resolution, "1"),
                "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        double worst = 0;
        for (int i = 0; i < 600; ++i)
        {
            s.step();
            worst = std::max(worst, std::fabs(s.vec("a", "position").z - 0.1 - bouncing_height(5, s.simulation().time())));
        }
        CHECK(worst < 1e-9);
        const double fall = std::sqrt(10 / 9.81);
        std::size_t n = 0;
        for (const Event& e : s.events)
            if (e.kind == "contact.impact") CHECK(std::fabs(e.time - fall * (1 + 2.0 * static_cast<double>(n++))) < 1e-9);
        CHECK(n == 5);
    }
}

TEST_CASE("C5: a ball that loses speed in each bounce comes to rest at the time given by the sum of the series")
{
    for (const auto& [e, rest] : {std::pair("0.5", 1.35457092295719271), std::pair("0.9", 8.57894917872888718)})
    {
        CAPTURE(e);
        Scene s(kGround + ball("a", "mass=\"1\" position=\"0 0 1.1\"") + "<component id=\"g\" type=\"Field/Gravity\" between=\"a\"/>" +
                    contact("a ground", "LocalBisection", e),
                "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        s.run(rest + 1);
        REQUIRE(s.count("contact.rest") == 1);
        double time = 0;
        for (const Event& event : s.events)
            if (event.kind == "contact.rest") time = event.time;
        CHECK(std::fabs(time - rest) < 1e-6);
        CHECK(std::fabs(s.vec("a", "position").z - 0.1) < 1e-11);
        CHECK(length(s.vec("a", "linear_velocity")) < 1e-12);
        const double z = s.vec("a", "position").z;
        s.run(rest + 3);
        CHECK(std::fabs(s.vec("a", "position").z - z) < 1e-12);
        CHECK(s.count("contact.end") <= s.count("contact.begin"));
    }
}

TEST_CASE("a ball that rolls when its bouncing ends comes to rest on the ground and rolls on")
{
    // The rotation of its lowest point does not contribute to the acceleration of the gap.
    Scene s(std::string(kGround) + ball("a", "mass=\"0.5\" position=\"0 0 0.6\" linear_velocity=\"1.5 0 0\"") +
                "<component id=\"g\" type=\"Field/Gravity\" between=\"a\"/>" + contact("a ground", "LocalBisection", "0.6", "0.35"),
            "dt=\"1/240\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    s.run(3);
    CHECK(s.count("contact.rest") == 1);
    CHECK(s.count("contact.impact") < 100);
    // Rolling shares the momentum: v = 5/7 v0.
    CHECK(near(s.vec("a", "linear_velocity").x, 1.5 * 5 / 7, 1e-9));
    CHECK(near(s.vec("a", "angular_velocity").y, 15.0 * 5 / 7, 1e-9));
    CHECK(std::fabs(s.vec("a", "position").z - 0.1) < 1e-12);
}

// Along z, where the wall's normal is exact: deviations of the spheres from a straight line would grow exponentially, as physics
// requires.
TEST_CASE("C6: Galperin's balls count the digits of pi")
{
    int k = 0;
    for (const std::size_t digits : {3u, 31u, 314u, 3141u})
    {
        CAPTURE(k);
        const double mass = std::pow(100.0, k);
        char heavy[160];
        std::snprintf(heavy, sizeof heavy, "mass=\"%.17g\" position=\"0 0 3\" linear_velocity=\"0 0 -0.1\"", mass);
        Scene s("<component id=\"wall.shape\" type=\"Shape/Plane\"/><component id=\"wall\" type=\"State/Static\" shape=\"wall.shape\"/>" +
                    ball("light", "mass=\"1\" position=\"0 0 1.5\"", 0.5) + ball("heavy", heavy, 0.5) +
                    contact("light heavy wall", "LocalBisection", "1"),
                k < 3 ? "dt=\"1/60\"" : "dt=\"1/240\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        s.run(600);  // the velocities of the last ones are nearly equal
        CHECK(s.count("contact.impact") == digits);
        ++k;
    }
}

TEST_CASE("a box rests on the ground without drift or spin")
{
    Scene s(std::string(kGround) +
                "<component id=\"box.shape\" type=\"Shape/Box\" half_extents=\"0.5 0.5 0.5\"/>"
                "<component id=\"box\" type=\"State/RigidBody\" mass=\"1\" shape=\"box.shape\" position=\"0 0 0.6\"/>"
                "<component id=\"g\" type=\"Field/Gravity\" between=\"box\"/>" +
                contact("box ground", "LocalBisection", "0", "0.5"),
            "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(5);
    CHECK(distance(s.vec("box", "position"), {0, 0, 0.5}) < 1e-9);
    CHECK(length(s.vec("box", "linear_velocity")) < 1e-9);
    CHECK(length(s.vec("box", "angular_velocity")) < 1e-9);
}

TEST_CASE("a material pair overrides the response's own law")
{
    Scene s(kGround + ball("a", "mass=\"1\" material=\"rubber\" position=\"0 0 0.6\" linear_velocity=\"0 0 -1\"") +
                "<component id=\"law\" type=\"Material/Pair\" a=\"rubber\" b=\"stone\" friction=\"0\" restitution=\"1\"/>" +
                contact("a ground", "LocalBisection", "0"),
            "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.ask(simulation::SetOperation{"ground", "material", std::string("stone")});
    s.run(1);
    CHECK(near(s.vec("a", "linear_velocity").z, 1, 1e-13));
}

TEST_CASE("a sensor reports the time of the contact and exerts no force")
{
    Scene s(kGround + ball("a", "mass=\"1\" position=\"0 0 0.6\" linear_velocity=\"0 0 -1\"") +
                "<component id=\"contact\" type=\"CDetection/ODE\" between=\"a ground\" resolution=\"Resolution/LocalBisection\" "
                "response=\"Response/None\"/>",
            "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    s.run(1);
    CHECK(near(s.vec("a", "linear_velocity").z, -1, 1e-15));
    REQUIRE(s.count("contact.begin") == 1);
    CHECK(s.count("contact.impact") == 0);
    for (const Event& e : s.events)
        if (e.kind == "contact.begin") CHECK(std::fabs(e.time - 0.5) < 1e-13);
}
