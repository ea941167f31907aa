// Spring contacts of many bodies, and of light and heavy ones, with the defaults.
#include <algorithm>

#include "support/gravity.h"
#include "support/ground.h"
#include "support/scene.h"
#include "support/text.h"

using namespace plab;
using plab::test::kGround;
using plab::test::Scene;
using plab::test::text;

namespace
{

std::string cube(const std::string& id, double mass, const Vec3& at, const std::string& more = "")
{
    return "<component id=\"" + id + "\" type=\"State/RigidBody\" mass=\"" + text(mass) + "\" shape=\"cube\" position=\"" + text(at.x) +
           " " + text(at.y) + " " + text(at.z) + "\" " + more + "/>";
}

const char* const kCube = "<component id=\"cube\" type=\"Shape/Box\" half_extents=\"0.1 0.1 0.1\"/>";

std::string springs(const std::string& law, const std::string& more = "")
{
    return "<component id=\"contact\" type=\"CDetection/ODE\" between=\"*\" response=\"Response/" + law + "\" " + more + "/>";
}

/// Two cubes, the upper of which falls askew onto the lower; the further to the right, the later.
std::string tower(int i)
{
    const double x = 10.0 * i;
    return cube("low" + std::to_string(i), 1, {x, 0, 0.1}) +
           cube("high" + std::to_string(i), 1, {x + 0.03, 0.02, 0.31 + 0.005 * i}, "orientation=\"axis 1 2 0 10 deg\"");
}

}  // namespace

TEST_CASE("islands of springs move as each would by itself, to the last bit, while contacts begin and end in them")
{
    const std::string more = springs("Penalty", "response.friction=\"0.5\" response.stiffness=\"2e4\"") + test::kGravity;
    std::string all = kGround + std::string(kCube);
    for (int i = 0; i < 12; ++i) all += tower(i);
    Scene together(all + more, "dt=\"1/240\"");
    REQUIRE_MESSAGE(together.loaded(), together.error());
    together.keep_events = true;
    together.run(0.25);
    std::size_t begun = 0, ended = 0;
    for (const Event& e : together.events) begun += e.kind == "contact.begin" ? 1 : 0, ended += e.kind == "contact.end" ? 1 : 0;
    CHECK(begun >= 24);
    CHECK(ended > 0);
    for (const int i : {0, 5, 11})
    {
        CAPTURE(i);
        Scene alone(kGround + std::string(kCube) + tower(i) + more, "dt=\"1/240\"");
        REQUIRE_MESSAGE(alone.loaded(), alone.error());
        alone.run(0.25);
        for (const std::string& id : {"low" + std::to_string(i), "high" + std::to_string(i)})
        {
            CHECK(alone.vec(id, "position") == together.vec(id, "position"));
            CHECK(alone.vec(id, "angular_velocity") == together.vec(id, "angular_velocity"));
        }
    }
}

TEST_CASE("detection for springs looks at what touches: ten times the islands, ten times the bodies")
{
    const auto visited = [](int islands)
    {
        std::string all = kGround + std::string(kCube);
        for (int i = 0; i < islands; ++i) all += cube("a" + std::to_string(i), 1, {2.0 * i, 0, 0.1});
        Scene s(all + springs("Penalty") + test::kGravity, "dt=\"1/240\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        double sum = 0;
        for (int i = 0; i < 5; ++i) s.step(), sum += static_cast<double>(s.simulation().stepper().report().visited);
        return sum;
    };
    const double few = visited(8), many = visited(80);
    CHECK(few > 100);
    CHECK(many < 12 * few);
}

TEST_CASE("whatever a body weighs, by default it sinks by as much and takes as many pieces")
{
    const double g = test::kG;
    for (const auto& [law, depth] : {std::pair("Penalty", 0.25e-6 * g), std::pair("HuntCrossley", std::pow(0.25e-7 * g, 2. / 3))})
    {
        double moved = 0;
        for (const double mass : {1e-3, 1.0, 1e4})
        {
            CAPTURE(law);
            CAPTURE(mass);
            Scene s(kGround + std::string(kCube) + cube("a", mass, {0, 0, 0.1}) + springs(law) + test::kGravity, "dt=\"1/240\"");
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.run(0.25);
            // At rest at the depth of the closed form, m g / 4 on each corner: what is put down is not damped so much that it creeps.
            CHECK(s.vec("a", "position").z - 0.1 == doctest::Approx(-depth).epsilon(1e-6));
            CHECK(length(s.vec("a", "linear_velocity")) < 1e-9);
            if (moved != 0) CHECK(s.vec("a", "position").z == doctest::Approx(moved).epsilon(1e-12));
            moved = s.vec("a", "position").z;
        }
    }
}
