// What the reply to a swap reports about contacts and fields is true.
#include "swaps.h"

using namespace plab;
using namespace plab::simulation;
using namespace plab::test;

namespace
{

struct Held
{
    std::size_t points = 0;
    std::vector<std::uint64_t> ids;
    Vec3 force;  ///< N on the upper bodies, sum over hard and soft contacts
};

Held held_by(const Scene& s)
{
    Held out;
    const Stepper& stepper = s.simulation().stepper();
    const auto add = [&](std::uint64_t id, const Vec3& force) { ++out.points, out.ids.push_back(id), out.force += force; };
    for (const PairState& p : stepper.contacts().pairs())
        for (std::uint32_t k = 0; p.resting && k < p.count; ++k) add(p.contacts[k].id, p.contacts[k].impulse / s.simulation().dt());
    for (const ForcePair& p : stepper.contacts().force_pairs())
        for (const ForceContact& c : p.all()) add(c.id, c.force);
    std::sort(out.ids.begin(), out.ids.end());
    return out;
}

std::string standing(const std::string& response)
{
    const bool soft = response == "Penalty" || response == "HuntCrossley";
    return gravity("1 0 -9.81") + solid("a", "Box' half_extents='0.1 0.1 0.1'", 1, {0, 0, 0.1}) +
           ground_and_contact(
               "LocalBisection", response,
               response == "None" ? ""
               : soft ? "response.friction='0.5' response.stiffness='1e5' response.restitution='0.3' response.steps_per_contact='20'"
                      : "response.friction='0.5'");
}

bool is_soft(const std::string& response) { return response == "Penalty" || response == "HuntCrossley"; }

}  // namespace

TEST_CASE("persistent contacts are kept, converted or lost as the reply reports, with their ids and forces")
{
    for (const std::string from : {"Impulse", "Rows", "Penalty", "HuntCrossley"})
        for (const std::string to : {"None", "Impulse", "Rows", "Penalty", "HuntCrossley"})
        {
            if (from == to) continue;
            CAPTURE(from);
            CAPTURE(to);
            Scene s(standing(from), dt(60));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.run(1);
            const Held before = held_by(s);
            REQUIRE(before.points == 4);
            std::vector<NamedValue> values;
            if (is_soft(to)) values = {{"steps_per_contact", std::string("20")}, {"stiffness", std::string("1e5")}};
            const Reply reply = swapped(s, "contact.response", "Response/" + to, values);
            const Held after = held_by(s);
            const std::string transfer = transfer_of(reply, "contacts (4 points)");
            if (to == "None")
            {
                CHECK(transfer == "lost");
                CHECK(after.points == 0);
                continue;
            }
            CHECK(transfer == (is_soft(from) || is_soft(to) ? "converted" : "kept"));
            CHECK(after.ids == before.ids);
            CHECK(distance(after.force, before.force) <= 1e-12 * length(before.force));
            // Nothing moves: the new law holds it as the old one did.
            const Vec3 at = s.vec("a", "position");
            s.step(30);
            // A hard response after a spring: the overlap that the spring left is removed.
            CHECK(distance(s.vec("a", "position"), at) <= (is_soft(from) && !is_soft(to) ? 1e-3 : 2e-5));
            CHECK(length(s.vec("a", "linear_velocity")) <= 1e-4);
        }
}

TEST_CASE("swaps of resolutions, managers and spaces keep the state of contacts")
{
    Scene s(standing("Rows"), dt(60));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1);
    const Held before = held_by(s);
    for (const std::string& manager : managers())
        CHECK(transfer_of(swapped(s, "contact.response.manager", "Manager/" + manager), "contacts (4 points)") == "kept");
    CHECK(transfer_of(swapped(s, "contact.resolution", "Resolution/None"), "contacts (4 points)") == "kept");
    CHECK(transfer_of(swapped(s, "contact", "CDetection/ODE", {{"space", std::string("quadtree")}}), "contacts (4 points)") == "kept");
    const Held after = held_by(s);
    CHECK(after.ids == before.ids);
    CHECK(after.force == before.force);
}

TEST_CASE("a spring that has released an overlap left by a swap does not push until the bodies have separated")
{
    // 1 mm deep on a soft spring, then hard, then on a spring ten thousand times as stiff, then gravity is reversed.
    const std::string scene =
        gravity() + solid("a", "Sphere' radius='0.1'", 1, {0, 0, 0.1}) +
        ground_and_contact("LocalBisection", "Penalty", "response.stiffness='1e4' response.damping_ratio='1' response.restitution='1'");
    for (const char* over : {"Response/Rows", "Response/Impulse"})
    {
        Scene s(scene, dt(240));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = s.keep_events = true;
        s.run(2);
        swapped(s, "contact.response", over);
        s.step();
        CHECK(s.vec("a", "position").z < 0.1 - 9e-4);
        swapped(s, "contact.response", "Response/Penalty",
                {{"stiffness", std::string("1e8")}, {"damping_ratio", std::string("0")}, {"restitution", std::string("1")}});
        REQUIRE(s.ask(SetOperation{"g", "acceleration", std::string("0 0 1")}).done);
        s.run(2.5);
        // At most the energy stored in the spring, f^2 / 2k, and the work of gravity.
        const double t = s.simulation().time() - 2 - s.simulation().dt();
        CHECK(near(s.vec("a", "linear_velocity").z, t, 2e-3));
        CHECK(s.count("contact.end") == 1);
        // Gravity points down again: now it touches the floor at the floor's true height.
        REQUIRE(s.ask(SetOperation{"g", "acceleration", std::string("0 0 -9.81")}).done);
        const double energy = [&] { return s.simulation().totals().kinetic + 9.81 * (s.vec("a", "position").z - 0.1); }();
        s.run(4);
        CHECK(near(s.simulation().totals().kinetic + 9.81 * (s.vec("a", "position").z - 0.1) + s.real("contact.response", "stored"), energy,
                   1e-5));
        CHECK(s.count("contact.begin") >= 1);
    }
}
