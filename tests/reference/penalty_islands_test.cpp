// Spring contacts combined with other things: joints, kinematic bodies, hard contacts, rewinding, several threads.
#include <algorithm>
#include <numbers>

#include "support/gravity.h"
#include "support/ground.h"
#include "support/scene.h"
#include "support/text.h"

using namespace plab;
using plab::test::kGround;
using plab::test::near;
using plab::test::Scene;

namespace
{

std::string unit_ball(const std::string& id, const std::string& attributes)
{
    return "<component id=\"" + id + ".shape\" type=\"Shape/Sphere\" radius=\"0.1\"/><component id=\"" + id +
           "\" type=\"State/RigidBody\" shape=\"" + id + ".shape\" mass=\"1\" " + attributes + "/>";
}

std::string box(const std::string& id, const std::string& attributes)
{
    return "<component id=\"" + id + ".shape\" type=\"Shape/Box\" half_extents=\"0.2 0.2 0.1\"/><component id=\"" + id +
           "\" type=\"State/RigidBody\" shape=\"" + id + ".shape\" " + attributes + "/>";
}

std::string contact_of(const std::string& id, const std::string& between, const std::string& rest)
{
    return "<component id=\"" + id + "\" type=\"CDetection/ODE\" between=\"" + between + "\" " + rest + "/>";
}

std::string spring(const std::string& k, const std::string& more = "")
{
    const std::string elastic = more.find("restitution") == std::string::npos ? "response.restitution=\"1\" " : "";
    return "response=\"Response/Penalty\" response.stiffness=\"" + k + "\" " + elastic + more;
}

const char* const kHard = "resolution=\"Resolution/LocalBisection\" response=\"Response/Impulse\" response.friction=\"0.5\"";

}  // namespace

TEST_CASE("a floor with a prescribed upward velocity gives a ball at rest twice its speed")
{
    Scene s(
        "<component id=\"floor\" type=\"Shape/Box\" half_extents=\"1 1 0.1\"/>"
        "<component id=\"lift\" type=\"State/Kinematic\" shape=\"floor\" position=\"0 0 -0.3\" linear_velocity=\"0 0 0.5\"/>" +
            unit_ball("a", "position=\"0 0 0.1\"") + contact_of("c", "a lift", spring("1e6")),
        "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    s.run(1);
    REQUIRE(!s.events.empty());
    CHECK(std::fabs(s.events[0].time - 0.4) <= 1e-12);
    CHECK(std::fabs(s.vec("a", "linear_velocity").z - 1) <= 1e-9);
}

TEST_CASE("a pendulum on a joint hits a stiff wall and returns to its initial height")
{
    // Bob of 1 kg at 1 m under a ball joint, released at 0.5 rad from a wall that it meets when it hangs straight down.
    const double a0 = 0.5, h = std::cos(a0);
    char where[200];
    std::snprintf(where, sizeof where, "position=\"%.17g 0 %.17g\" orientation=\"%.17g 0 %.17g 0\"", -std::sin(a0), -h, std::cos(a0 / 2),
                  std::sin(a0 / 2));
    Scene s(unit_ball("a", where) + "<component id=\"joint\" type=\"Constraint/Ball\" b=\"a\" anchor=\"0 0 0\"/>" +
                "<component id=\"wall.shape\" type=\"Shape/Plane\"/><component id=\"wall\" type=\"State/Static\" shape=\"wall.shape\" "
                "position=\"0.1 0 0\" orientation=\"0.7071067811865476 0 -0.7071067811865476 0\"/>" +
                contact_of("c", "a wall", spring("1e7")) + kGravity,
            "dt=\"1/240\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    const double top = s.simulation().totals().kinetic + kG * (1 - h);
    double least = 0;
    for (int i = 0; i < 480; ++i)
    {
        s.step();
        const Vec3 p = s.vec("a", "position");
        least = std::min(least, s.count("contact.end") > 0 ? p.x : 0.0);
        CHECK(std::fabs(length(p) - 1) <= 1e-9);
        const double energy = s.simulation().totals().kinetic + s.real("c.response", "stored") + kG * (p.z + 1);
        CHECK(std::fabs(energy - top) <= 1e-6);
    }
    CHECK(s.count("contact.begin") == 2);
    CHECK(least < -0.999 * std::sin(a0));
}

TEST_CASE("a ball on springs lies m g / k deep on a box with a hard contact: nothing creeps, the ledger closes")
{
    Scene s(kGround + box("b", "mass=\"4\" position=\"0 0 0.1\"") + unit_ball("a", "position=\"0.05 0 0.3\"") +
                contact_of("hard", "b ground", kHard) + contact_of("soft", "a b", spring("1e4", "response.damping_ratio=\"0.3\"")) +
                kGravity,
            "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    for (int i = 0; i < 180; ++i)
    {
        s.step();
        const auto t = s.simulation().totals();
        CHECK(std::fabs(t.kinetic - s.simulation().kinetic_at_start() - t.work) <= 1e-4);
    }
    CHECK(std::fabs(s.vec("b", "position").z - 0.1) <= 1e-9);
    CHECK(std::fabs(s.vec("a", "position").z - 0.3 + kG / 1e4) <= 1e-8);
    const Vec3 before = s.vec("a", "position");
    s.run(4);
    CHECK(length(s.vec("a", "position") - before) <= 1e-9);
}

TEST_CASE("an undamped spring in a mixed island neither gains nor loses energy over a long time")
{
    Scene s(kGround + box("b", "mass=\"4\" position=\"0 0 0.1\"") +
                unit_ball("a", "position=\"0 0 0.2999\" linear_velocity=\"0 0 -0.02\"") + contact_of("hard", "b ground", kHard) +
                contact_of("soft", "a b", spring("1e4", "response.steps_per_contact=\"40\"")) + kGravity,
            "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    double highest = -1, lowest = 1;
    const auto swing = [&](double until)
    {
        highest = -1, lowest = 1;
        while (s.simulation().time() < until)
        {
            s.step();
            highest = std::max(highest, s.vec("a", "position").z), lowest = std::min(lowest, s.vec("a", "position").z);
        }
        return highest - lowest;
    };
    const double early = swing(2);
    (void)swing(20);
    CHECK(std::fabs(swing(22) / early - 1) < 0.05);
}

TEST_CASE("an undamped spring in a mixed island swings as far after 20 s as at first, whatever finds its hard contact, and when")
{
    for (const char* resolution : {"LocalRoot", "LocalBisection"})
        for (const double gap : {0.0, 1e-7})
        {
            CAPTURE(std::string(resolution));
            CAPTURE(gap);
            Scene s(kGround + box("b", "mass=\"4\" position=\"0 0 " + plab::test::text(0.1 + gap) + "\"") +
                        unit_ball("a", "position=\"0 0 0.2999\" linear_velocity=\"0 0 -0.02\"") +
                        contact_of("hard", "b ground",
                                   std::string("response=\"Response/Impulse\" resolution=\"Resolution/") + resolution + "\"") +
                        contact_of("soft", "a b", spring("1e4", "response.steps_per_contact=\"40\"")) + kGravity,
                    "dt=\"1/60\"");
            REQUIRE_MESSAGE(s.loaded(), s.error());
            const auto swing = [&](double until)
            {
                double highest = -1, lowest = 1;
                for (double z = 0; s.simulation().time() < until; highest = std::max(highest, z), lowest = std::min(lowest, z))
                    s.step(), z = s.vec("a", "position").z;
                return highest - lowest;
            };
            const double early = swing(2);
            s.run(20);
            CHECK(std::fabs(swing(22) / early - 1) < 5e-3);
        }
}

TEST_CASE("rewinding the whole world divides a spring's contact into pieces and changes nothing")
{
    // A second ball bounces with a hard response and the paper's rewinding of the whole world, many times in each contact of the
    // first.
    const auto fall = [](bool second)
    {
        Scene s(kGround + unit_ball("a", "position=\"0 0 0.3\"") +
                    contact_of("soft", "a ground", spring("1e3", "response.friction=\"0.3\" response.restitution=\"0.8\"")) + kGravity +
                    (second ? unit_ball("b", "position=\"3 0 0.101\"") +
                                  contact_of("hard", "b ground",
                                             "resolution=\"Resolution/Bisection\" response=\"Response/Impulse\" "
                                             "response.restitution=\"1\"")
                            : ""),
                "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true;
        s.run(1);
        CHECK(s.count("contact.begin") >= 2);
        std::size_t begins = 0;
        for (const Event& e : s.events) begins += e.kind == "contact.begin" && s.simulation().world().id_of(e.component) == "soft" ? 1 : 0;
        const auto t = s.simulation().totals();
        CHECK(std::fabs(t.kinetic - s.simulation().kinetic_at_start() - t.work) <= 1e-7);
        return std::pair(s.vec("a", "position").z, begins);
    };
    const auto [alone, begins_alone] = fall(false);
    const auto [rewound, begins_rewound] = fall(true);
    CHECK(std::fabs(alone - rewound) <= 1e-9);
    CHECK(begins_alone == begins_rewound);
}

TEST_CASE("a ball with a hard contact hits one that rests on a spring")
{
    Scene s(kGround + unit_ball("a", "position=\"0 0 0.099019\"") + unit_ball("b", "position=\"0 0 0.5\"") +
                contact_of("soft", "a ground", spring("1e4", "response.damping_ratio=\"0.2\"")) +
                contact_of("hard", "a b",
                           "resolution=\"Resolution/LocalBisection\" response=\"Response/Impulse\" response.restitution=\"0.5\"") +
                kGravity,
            "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(4);
    // In the end both are at rest, one on the other.
    CHECK(std::fabs(s.vec("a", "position").z - 0.1 + 2 * kG / 1e4) <= 1e-6);
    CHECK(std::fabs(s.vec("b", "position").z - s.vec("a", "position").z - 0.2) <= 1e-8);
    const auto t = s.simulation().totals();
    CHECK(std::fabs(t.kinetic - s.simulation().kinetic_at_start() - t.work) <= 1e-4);
}

TEST_CASE("a spring does not affect distant bodies: bit for bit, and with any number of threads")
{
    const std::string far = unit_ball("z", "position=\"0 0 50\" linear_velocity=\"1 2 3\" angular_velocity=\"3 2 1\"") + kGravity;
    const std::string near_by = kGround + unit_ball("a", "position=\"0 0 0.3\"") + unit_ball("b", "position=\"0.05 0 0.7\"") +
                                contact_of("c", "a b ground", spring("1e5", "response.friction=\"0.3\""));
    Scene one(near_by + far, "dt=\"1/60\""), four(near_by + far, "dt=\"1/60\"", 4), alone(far, "dt=\"1/60\"");
    REQUIRE_MESSAGE(one.loaded(), one.error());
    one.run(1), four.run(1), alone.run(1);
    CHECK(one.hash() == four.hash());
    CHECK(one.vec("z", "position") == alone.vec("z", "position"));
    CHECK(one.quat("z", "orientation") == alone.quat("z", "orientation"));
}

TEST_CASE("a ball bounces with solvers of all kinds")
{
    for (const std::string solver : {"SemiImplicitEuler", "RungeKutta4", "StoermerVerlet", "RotationSplitting", "Exact", "Exponential",
                                     "Automatic", "DormandPrince54", "ImplicitMidpoint", "Radau5"})
    {
        const auto type = test::library().require("Solver/" + solver);
        if (!type) continue;
        CAPTURE(solver);
        Scene s("<component id=\"solver\" type=\"Solver/" + solver + "\"/>" + kGround +
                    unit_ball("a", "position=\"0 0 0.15\" linear_velocity=\"0 0 -1\" solver=\"solver\"") +
                    contact_of("c", "a ground", spring("1e6")),
                "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = true;
        s.run(0.2);
        CHECK(std::fabs(s.vec("a", "linear_velocity").z - 1) <= ((*type)->info.order == 1 ? 5e-3 : 1e-4));
    }
}
