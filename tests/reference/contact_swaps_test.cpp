// Responses of different kinds exchanged under resting and flying bodies: H1 to H4 of the catalogue of reference problems.
#include "support/gravity.h"
#include "support/scene.h"

using namespace plab;
using namespace plab::simulation;
using plab::test::first_error;
using plab::test::kG;
using plab::test::near;
using plab::test::Scene;

namespace
{

/// A box of 1 kg over a floor, friction 0.5.
std::string box(const std::string& response, const std::string& more = "position=\"0 0 0.1\"")
{
    return "<component id=\"ground\" type=\"State/Static\" shape=\"floor\"/><component id=\"floor\" type=\"Shape/Plane\"/>"
           "<component id=\"g\" type=\"Field/Gravity\" between=\"a\"/>"
           "<component id=\"cube\" type=\"Shape/Box\" half_extents=\"0.1 0.1 0.1\"/>"
           "<component id=\"a\" type=\"State/RigidBody\" shape=\"cube\" mass=\"1\" " +
           more +
           "/>"
           "<component id=\"contact\" type=\"CDetection/ODE\" between=\"a ground\" resolution=\"Resolution/LocalBisection\" "
           "response=\"Response/" +
           response + " response.friction=\"0.5\"/>";
}

/// Four corners with 2500 N/m each have a total stiffness of 1e4 N/m.
const char* const kSpring =
    "Penalty\" response.stiffness=\"2500\" response.damping_ratio=\"0.7\" response.tangential_damping_ratio=\"1\" "
    "response.restitution=\"1\"";
const std::vector<NamedValue> kSpringValues{{"stiffness", std::string("2500")},
                                            {"damping_ratio", std::string("0.7")},
                                            {"restitution", std::string("1")},
                                            {"tangential_damping_ratio", std::string("1")}};

Reply exchange(Scene& s, const std::string& type, std::vector<NamedValue> values = {})
{
    Reply reply = s.ask(SwapOperation{"contact.response", type, std::move(values)});
    REQUIRE_MESSAGE(reply.done, first_error(reply.errors));
    return reply;
}

bool converted(const Reply& reply)
{
    for (const TransferredField& f : reply.swaps.at(0).fields)
        if (f.field.rfind("contacts", 0) == 0 && f.transfer == FieldTransfer::Converted) return true;
    return false;
}

/// The non-spring algorithms that this build contains.
std::vector<std::string> hard_types()
{
    std::vector<std::string> types{"Response/Impulse"};
    if (test::library().require("Response/Rows").ok()) types.push_back("Response/Rows");
    return types;
}

}  // namespace

TEST_CASE("H1: soft -> hard -> soft between two steps changes no bit, in flight and in contact")
{
    for (const std::string& hard : hard_types())
        for (const double at : {0.05, 1.0})
        {
            CAPTURE(hard);
            CAPTURE(at);
            Scene alone(box(kSpring, "position=\"0 0 0.2\" linear_velocity=\"1 0 0\""), "dt=\"1/60\"");
            Scene swapped(box(kSpring, "position=\"0 0 0.2\" linear_velocity=\"1 0 0\""), "dt=\"1/60\"");
            REQUIRE_MESSAGE(alone.loaded(), alone.error());
            alone.run(at), swapped.run(at);
            REQUIRE(alone.hash() == swapped.hash());
            exchange(swapped, hard);
            exchange(swapped, "Response/Penalty", kSpringValues);
            CHECK(alone.hash() == swapped.hash());
            alone.run(at + 0.5), swapped.run(at + 0.5);
            CHECK(alone.hash() == swapped.hash());
        }
}

TEST_CASE("H1: hard -> soft -> hard between two steps changes no bit")
{
    for (const std::string& hard : hard_types())
    {
        CAPTURE(hard);
        const std::string response = hard.substr(9) + "\" response.restitution=\"0.3\"";
        Scene alone(box(response, "position=\"0 0 0.2\""), "dt=\"1/60\""), swapped(box(response, "position=\"0 0 0.2\""), "dt=\"1/60\"");
        REQUIRE_MESSAGE(alone.loaded(), alone.error());
        alone.run(1), swapped.run(1);
        exchange(swapped, "Response/Penalty");
        exchange(swapped, hard);
        CHECK(alone.hash() == swapped.hash());
        alone.run(1.5), swapped.run(1.5);
        CHECK(alone.hash() == swapped.hash());
    }
}

TEST_CASE("H2: in flight a swap of the response moves nothing; in contact it keeps momentum and adds no energy")
{
    for (const std::string& hard : hard_types())
    {
        Scene flies(box(kSpring, "position=\"0 0 2\" linear_velocity=\"1 2 3\" angular_velocity=\"1 2 3\""), "dt=\"1/60\"");
        REQUIRE_MESSAGE(flies.loaded(), flies.error());
        flies.run(0.1);
        const Totals before = flies.simulation().totals();
        const Reply reply = exchange(flies, hard);
        const Totals after = flies.simulation().totals();
        CHECK(before.kinetic == after.kinetic);
        CHECK(before.momentum == after.momentum);
        CHECK(before.angular_momentum == after.angular_momentum);
        CHECK(!converted(reply));
        CHECK(reply.swaps[0].with_old.energy == reply.swaps[0].with_new.energy);
    }
    // In the middle of a bounce of two free balls.
    for (const std::string& hard : hard_types())
    {
        const auto ball = [](const char* id, const char* where)
        { return std::string("<component id=\"") + id + "\" type=\"State/RigidBody\" shape=\"sphere\" mass=\"1\" " + where + "/>"; };
        Scene s("<component id=\"sphere\" type=\"Shape/Sphere\" radius=\"0.1\"/>" +
                    ball("a", "position=\"-0.12 0 0\" linear_velocity=\"1 0.1 0\"") + ball("b", "position=\"0.12 0 0\"") +
                    "<component id=\"contact\" type=\"CDetection/ODE\" between=\"a b\" resolution=\"Resolution/LocalBisection\" "
                    "response=\"Response/Penalty\" response.stiffness=\"1e3\" response.restitution=\"1\"/>",
                "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.step(4);
        REQUIRE(s.simulation().totals().stored > 0);
        const Totals before = s.simulation().totals();
        CHECK(converted(exchange(s, hard)));
        CHECK(s.simulation().totals().momentum == before.momentum);
        double energy = before.kinetic + before.stored;
        for (int i = 0; i < 60; ++i)
        {
            s.step();
            const Totals t = s.simulation().totals();
            CHECK(t.kinetic + t.stored <= energy + 1e-14);
            CHECK(length(t.momentum - before.momentum) <= 1e-14);
            energy = t.kinetic + t.stored;
        }
    }
}

TEST_CASE("H3: when the springs under a box are exchanged for a hard response, the box is not thrown up")
{
    for (const std::string& hard : hard_types())
    {
        CAPTURE(hard);
        const double delta = kG / 1e4;
        Scene s(box(kSpring), "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(3);
        REQUIRE(std::fabs(s.vec("a", "position").z - 0.1 + delta) < 1e-12);
        CHECK(converted(exchange(s, hard)));
        double z = s.vec("a", "position").z;
        for (int i = 0; i < 300; ++i)
        {
            s.step();
            const double now = s.vec("a", "position").z;
            CHECK(now >= z - 1e-12);  // the overlap only shrinks
            CHECK(std::fabs(now - z) * 60 <= 0.1 * std::sqrt(kG * delta));
            CHECK(length(s.vec("a", "linear_velocity")) <= 0.1 * std::sqrt(kG * delta));
            CHECK(now - 0.1 <= 1e-2 * delta);
            z = now;
        }
        CHECK(std::fabs(z - 0.1) <= 2e-8);
        CHECK(length(s.vec("a", "linear_velocity")) <= 1e-9);
    }
}

TEST_CASE("H4: when a hard response is exchanged for springs, they begin at their equilibrium")
{
    for (const std::string& hard : hard_types())
    {
        CAPTURE(hard);
        // Inclined gravity, so that the stiction springs carry a load.
        std::string scene = box(hard.substr(9) + "\"");
        scene.replace(scene.find("between=\"a\"/>"), 13, "between=\"a\" acceleration=\"2 0 -9.81\"/>");
        Scene s(scene, "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(1);
        for (const char* stiffness : {"100", "2500", "1e6"})
        {
            std::vector<NamedValue> values = kSpringValues;
            values[0].value = std::string(stiffness);
            const Vec3 before = s.vec("a", "position");
            CHECK(converted(exchange(s, "Response/Penalty", values)));
            for (int i = 0; i < 60; ++i)
            {
                s.step();
                CHECK(std::fabs(s.vec("a", "position").z - before.z) <= 1e-9);
                CHECK(length(s.vec("a", "position") - before) <= 1e-9);
            }
            exchange(s, hard);
            s.step(10);
        }
    }
}

TEST_CASE("a contact keeps its identifier when its law is exchanged")
{
    Scene s(box(kSpring), "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(2);
    s.keep_events = true;
    exchange(s, "Response/HuntCrossley");
    s.run(3);
    exchange(s, "Response/Impulse");
    s.run(4);
    exchange(s, "Response/Penalty", kSpringValues);
    s.run(5);
    CHECK(s.count("contact.begin") == 0);
    CHECK(s.count("contact.end") == 0);
}
