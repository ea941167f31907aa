// Many bodies meet kinematic ones within a step. A kinematic body moves on whatever happens, so an impact on it is no concern of others
// that meet it or rest on it; but it must be where it was whenever one of those is rewound.
#include <algorithm>

#include "impacts.h"
#include "plab/random.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// Balls above a floor that move with its velocity and fall through up to 1 m.
std::string rain(int n, const std::string& floor_state, const Vec3& velocity, const std::string& resolution)
{
    std::uint64_t seed = 7;
    std::string out = gravity("*") + "<component id='floor' type='State/" + floor_state +
                      "' shape='Shape/Box' shape.half_extents='9 9 0.1' position='0 0 -0.1' " +
                      (floor_state == "Kinematic" ? "linear_velocity='" + text(velocity) + "'" : "") + "/>";
    for (int i = 0; i < n; ++i)
        out += sphere("b" + std::to_string(i), 0.06, at({0.3 * (i % 8), 0.3 * (i / 8), 0.1 + next_uniform(seed)}, velocity));
    return out + "<component id='contact' type='CDetection/ODE' between='*' resolution='Resolution/" + resolution +
           "' response.restitution='0.5'/>";
}

/// A ball rests on a kinematic slab, and another one falls on it.
std::string struck(const std::string& motion, const std::string& resolution)
{
    std::string out = gravity("*") + "<component id='slab' type='State/Kinematic' position='0 0 -0.1' " + motion +
                      " shape='Shape/Box' shape.half_extents='2 2 0.1'/>";
    for (int i = 0; i < 3; ++i)
        out += sphere("low" + std::to_string(i), 0.1, at({0.5, 0.6 * i, 0.1}, {0, 0.5, 0})) +
               sphere("high" + std::to_string(i), 0.1, at({0.55, 0.6 * i, 0.5 + 0.03 * i}));
    return out + "<component id='contact' type='CDetection/ODE' between='*' resolution='Resolution/" + resolution +
           "' response.friction='0.5' response.restitution='0.3'/>";
}

/// J: change of the kinetic energy within t (s) that no work explains.
double unexplained_within(double t, Scene& s)
{
    const double start = s.simulation().totals().kinetic;
    s.run(t);
    const auto end = s.simulation().totals();
    return std::fabs(end.kinetic - start - end.work);
}

}  // namespace

TEST_CASE("on a kinematic floor at rest balls bounce to the same bits as on a static one")
{
    for (const char* resolution : {"LocalRoot", "ConservativeAdvancement", "LocalBisection", "Automatic"})
    {
        CAPTURE(std::string(resolution));
        constexpr int kBalls = 40;
        Scene on_static(rain(kBalls, "Static", {}, resolution)), on_kinematic(rain(kBalls, "Kinematic", {}, resolution));
        REQUIRE_MESSAGE(on_static.loaded(), on_static.error());
        REQUIRE_MESSAGE(on_kinematic.loaded(), on_kinematic.error());
        on_kinematic.keep_events = true;
        on_static.run(1), on_kinematic.run(1);
        for (int i = 0; i < kBalls; ++i)
            for (const char* field : {"position", "linear_velocity", "angular_velocity"})
                CHECK(on_static.vec("b" + std::to_string(i), field) == on_kinematic.vec("b" + std::to_string(i), field));
        CHECK(events_of(on_kinematic, "contact.impact").size() > 5 * kBalls);
    }
}

TEST_CASE("in a lift that moves evenly balls bounce as on the ground")
{
    const Vec3 velocity{0.25, -0.5, 1};
    for (const char* resolution : {"LocalRoot", "LocalBisection"})
    {
        CAPTURE(std::string(resolution));
        constexpr int kBalls = 40;
        Scene ground(rain(kBalls, "Static", {}, resolution)), lift(rain(kBalls, "Kinematic", velocity, resolution));
        REQUIRE_MESSAGE(ground.loaded(), ground.error());
        REQUIRE_MESSAGE(lift.loaded(), lift.error());
        ground.run(0.7);
        CHECK(unexplained_within(0.7, lift) < 1e-10);
        double most = 0;
        for (int i = 0; i < kBalls; ++i)
        {
            const std::string id = "b" + std::to_string(i);
            most = std::max(most, length(lift.vec(id, "position") - velocity * 0.7 - ground.vec(id, "position")));
        }
        MESSAGE(std::string(resolution), ": ", most, " m");
        CHECK(most < 1e-10);
    }
}

TEST_CASE("where a kinematic body carries what is hit, the work of all impacts explains the energy")
{
    for (const char* resolution : {"LocalRoot", "LocalBisection", "Bisection"})
        for (const char* motion : {"angular_velocity='0 0 1'", "linear_velocity='0 0 1'", "angular_velocity='0.1 0.2 0'"})
        {
            CAPTURE(std::string(resolution));
            CAPTURE(std::string(motion));
            Scene s(struck(motion, resolution));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.keep_events = true;
            CHECK(unexplained_within(1, s) < 1e-11);
            CHECK(events_of(s, "contact.impact").size() > 6);
        }
}
