// The forces of contacts as they are published: weight, slope, stack, and Newton's second law step by step, for every algorithm.
#include "newton.h"
#include "contact_algorithms.h"

using namespace plab;
using namespace plab::test;

namespace
{

std::string body(const std::string& id, double mass, const Vec3& half, const Vec3& at, const std::string& more = "")
{
    return "<component id=\"" + id + ".shape\" type=\"Shape/Box\" half_extents=\"" + text(half) + "\"/><component id=\"" + id +
           "\" type=\"State/RigidBody\" shape=\"" + id + ".shape\" mass=\"" + text(mass) + "\" position=\"" + text(at) + "\" " + more +
           "/>";
}

/// `values`: further parameters of the response.
std::string contact(const Algorithm& by, const std::string& values = "response.friction=\"0.6\"")
{
    const std::string manager = by.rows() ? std::string(" response.manager=\"Manager/") + by.manager + "\"" : "";
    return "<component id=\"contact\" type=\"CDetection/ODE\" between=\"*\" resolution=\"Resolution/" + std::string(by.resolution) +
           "\" response=\"Response/" + by.response + "\"" + manager + " " + values + "/>";
}

/// With the defaults, too: Resolution/Automatic and Response/Automatic, whose manager is Manager/Automatic.
std::vector<Algorithm> all(std::vector<Algorithm> algorithms)
{
    algorithms.push_back({"Automatic", "Automatic", ""});
    algorithms.push_back({"None", "Rows", "Automatic"});
    return algorithms;
}

/// Springs: soft enough for a step of 1/240 s, and damped so that they are at rest after a second.
std::string values_of(const Algorithm& a)
{
    return a.springs() ? "response.stiffness=\"2e5\" response.friction=\"0.6\"" : "response.friction=\"0.6\"";
}

/// Relative error of the sum of forces on a body at rest.
double bound_of(const Algorithm& a) { return a.springs() ? 1e-3 : 1e-6; }

constexpr double kMass = 2;

}  // namespace

TEST_CASE("a box at rest: the contact forces on it are its weight, by every algorithm")
{
    for (const Algorithm& a : all(standing_algorithms()))
    {
        CAPTURE(a.name());
        RecordedScene s(std::string(kGravity) + kGround + body("box", kMass, {0.2, 0.3, 0.1}, {0, 0, 0.1}) + contact(a, values_of(a)));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = true;
        s.run(1);
        const wire::ContactForces& c = s.next();
        REQUIRE(c.entries.size() == 1);
        CHECK(c.entries[0].detector == "contact");
        CHECK(c.entries[0].a == "box");
        CHECK(c.entries[0].b == "ground");
        CHECK(c.entries[0].asleep == (a.name().find("Rows/Automatic") != std::string::npos));  // it sleeps when it rests
        CHECK(near(c.step_length, s.simulation().dt(), 1e-12));
        CHECK(c.step == s.simulation().tick());
        CHECK(c.left_out == 0);
        CHECK(c.entries[0].points.size() == 4);
        for (const wire::ContactPoint& p : c.entries[0].points)
        {
            CHECK(distance(p.normal, {0, 0, -1}) < 1e-6);
            CHECK(std::fabs(dot(p.friction_force, p.normal)) < 1e-9);
            CHECK_FALSE(p.is_impact);
            CHECK(std::fabs(std::fabs(p.position.x) - 0.2) < 1e-3);
            CHECK(std::fabs(p.position.z) < 1e-3);
            CHECK(p.normal_force > 0);
        }
        const Vec3 weight{0, 0, kMass * kG};
        CHECK_MESSAGE(distance(s.force_on("box"), weight) <= bound_of(a) * kMass * kG, length(s.force_on("box") - weight));
        CHECK(distance(s.force_on("ground"), -weight) <= bound_of(a) * kMass * kG);
    }
}

TEST_CASE("a box that sticks on a slope: friction m g sin(a), normal force m g cos(a)")
{
    constexpr double kAngle = 0.3;
    for (const Algorithm& a : all(standing_algorithms()))
    {
        CAPTURE(a.name());
        const Vec3 across{std::sin(kAngle), 0, std::cos(kAngle)};
        const std::string turned = "orientation=\"" + text(std::cos(kAngle / 2)) + " 0 " + text(std::sin(kAngle / 2)) + " 0\"";
        RecordedScene s(std::string(kGravity) +
                        "<component id=\"plane\" type=\"Shape/Plane\"/><component id=\"slope\" type=\"State/Static\" shape=\"plane\" " +
                        turned + "/>" + body("box", kMass, {0.2, 0.3, 0.1}, across * 0.1, turned) + contact(a, values_of(a)));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = true;
        s.run(1.5);
        const wire::ContactForces& c = s.next();
        REQUIRE(c.entries.size() == 1);
        double normal = 0;
        Vec3 friction;  // on b, the slope
        for (const wire::ContactPoint& p : c.entries[0].points) normal += p.normal_force, friction += p.friction_force;
        const double bound = (a.springs() ? 2e-3 : 1e-6) * kMass * kG;
        CHECK_MESSAGE(std::fabs(normal - kMass * kG * std::cos(kAngle)) <= bound, normal);
        CHECK_MESSAGE(std::fabs(length(friction) - kMass * kG * std::sin(kAngle)) <= bound, length(friction));
        // The box pulls the slope downhill.
        CHECK(dot(friction, {std::cos(kAngle), 0, -std::sin(kAngle)}) > 0);
    }
}

TEST_CASE("a stack: each box carries what is above it")
{
    constexpr int kHigh = 5;
    for (const Algorithm& a :
         all({{"None", "Impulse"}, {"None", "Rows", "Direct"}, {"None", "Rows", "SequentialImpulse"}, {"None", "Rows", "SoftStep"}}))
    {
        CAPTURE(a.name());
        std::string bodies;
        for (int k = 0; k < kHigh; ++k) bodies += body("b" + std::to_string(k), kMass, {0.2, 0.2, 0.1}, {0, 0, 0.1 + 0.2 * k});
        RecordedScene s(std::string(kGravity) + kGround + bodies + contact(a));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = true;
        s.run(2);
        s.next();
        for (int k = 0; k < kHigh; ++k)
        {
            const std::string below = k == 0 ? "ground" : "b" + std::to_string(k - 1);
            const double load = (kHigh - k) * kMass * kG;
            const Vec3 carried = s.force_on("b" + std::to_string(k), below);
            CHECK_MESSAGE(distance(carried, {0, 0, load}) <= 1e-3 * load, k, " ", length(carried - Vec3{0, 0, load}) / load);
        }
    }
}

TEST_CASE("boxes that tumble into a heap: in every step the forces on each body are the change of its momentum, by every algorithm")
{
    // Without managers that sweep where events are located: their steps may take long (contact_algorithms.h).
    for (const Algorithm& a : all(standing_algorithms()))
    {
        // A spring that ends within a step is not listed.
        if (a.springs()) continue;
        CAPTURE(a.name());
        std::string bodies;
        std::vector<Weighed> weighed;
        for (int k = 0; k < 4; ++k)
        {
            weighed.push_back({"b" + std::to_string(k), 1 + 0.5 * k});
            bodies += body(weighed.back().id, weighed.back().mass, {0.15, 0.1 + 0.02 * k, 0.08}, {0.05 * k, 0.03 * (k % 2), 0.2 + 0.35 * k},
                           "angular_velocity=\"" + text(Vec3{3.0 - k, 1, 0.5 * k}) + "\"");
        }
        RecordedScene s(std::string(kGravity) + kGround + bodies + contact(a, "response.friction=\"0.4\" response.restitution=\"0.3\""));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = true;
        double most = 0;
        std::size_t points = 0, impacts = 0;
        for (int i = 0; i < 160; ++i)
        {
            most = std::max(most, most_unexplained(s, weighed));
            for (const wire::ContactInfo& c : s.contacts.entries)
                for (const wire::ContactPoint& p : c.points) ++points, impacts += p.is_impact ? 1 : 0;
        }
        // Velocities of 5 m/s and masses of 4 kg round to 1e-15 of 5 * 4 * 240 N.
        CHECK_MESSAGE(most < 1e-8, most);
        CHECK(points > 200);
        CHECK(impacts > 5);
    }
}

TEST_CASE("exchanging the manager or the response in the middle of a run leaves the forces right, step by step")
{
    std::string bodies;
    std::vector<Weighed> weighed;
    for (int k = 0; k < 4; ++k)
    {
        weighed.push_back({"b" + std::to_string(k), kMass});
        bodies += body(weighed.back().id, kMass, {0.2, 0.2, 0.1}, {0.02 * k, 0, 0.1 + 0.2 * k});
    }
    RecordedScene s(std::string(kGravity) + kGround + bodies + contact({"None", "Rows", "Direct"}));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.warnings_expected = true;
    const auto runs = [&](int steps)
    {
        double most = 0;
        for (int i = 0; i < steps; ++i) most = std::max(most, most_unexplained(s, weighed));
        return most;
    };
    CHECK(runs(30) < 1e-8);
    for (const char* type : {"Manager/SoftStep", "Manager/SequentialImpulse", "Manager/Automatic", "Manager/Direct"})
    {
        CAPTURE(type);
        CHECK(s.ask(simulation::SwapOperation{"contact.response.manager", type, {}}).done);
        CHECK(runs(30) < 1e-8);
        CHECK(distance(s.force_on("b0", "ground"), {0, 0, 4 * kMass * kG}) < 0.05 * kMass * kG);
    }
    CHECK(s.ask(simulation::SwapOperation{"contact.response", "Response/Impulse", {}}).done);
    CHECK(runs(30) < 1e-8);
    CHECK(distance(s.force_on("b0", "ground"), {0, 0, 4 * kMass * kG}) < 0.05 * kMass * kG);
}
