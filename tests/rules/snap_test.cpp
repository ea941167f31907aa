// Constraint/Snap: two frames come together as the critically damped closed form says; momentum is kept, and the work is booked.
#include "plab/rotation.h"
#include "rules/workbench.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kTurn = 6.283185307179586476925286766559;

std::string body(const std::string& id, double mass, double inertia, const std::string& more)
{
    const std::string j = std::to_string(inertia);
    return "<component id='" + id + "' type='State/RigidBody' mass='" + std::to_string(mass) + "' inertia='" + j + " " + j + " " + j +
           "' " + more + "/>";
}

/// Momentum and angular momentum about the origin.
std::pair<Vec3, Vec3> momenta(const Scene& s, const std::vector<std::pair<std::string, double>>& bodies)
{
    Vec3 p, l;
    for (const auto& [id, mass] : bodies)
    {
        const Vec3 mv = mass * s.vec(id, "linear_velocity");
        p += mv;
        const std::uint32_t i = s.simulation().world().component(s.simulation().world().find(id)).host_index;
        l += cross(s.vec(id, "position"), mv) + s.simulation().world().host().bodies.angular_momentum[i];
    }
    return {p, l};
}

}  // namespace

TEST_CASE("two free bodies: the distance is d0 (1 + w t) exp(-w t), to the order of the solver")
{
    for (const std::string type : {"Acceleration", "Force"})
    {
        CAPTURE(type);
        double errors[2] = {};
        for (int k = 0; k < 2; ++k)
        {
            Scene s(body("one", 2, 0.3, "position='0 0 0'") + body("two", 1, 0.1, "position='0.2 0.1 -0.05' linear_velocity='0 0 0'") +
                        "<component id='snap' type='Constraint/Snap/" + type + "' a='one' b='two' frequency='2' turns='true'/>",
                    k == 0 ? "dt='1/60' solver='Solver/RungeKutta4'" : "dt='1/120' solver='Solver/RungeKutta4'");
            REQUIRE_MESSAGE(s.loaded(), s.error());
            const double w = kTurn * 2, d0 = length(Vec3{0.2, 0.1, -0.05});
            for (double t : {0.1, 0.2, 0.5})
            {
                s.run(t);
                const double exact = d0 * (1 + w * t) * std::exp(-w * t);
                errors[k] = std::max(errors[k], std::fabs(distance(s.vec("one", "position"), s.vec("two", "position")) - exact));
            }
            CHECK(near(s.real("snap", "distance"), distance(s.vec("one", "position"), s.vec("two", "position")), 1e-12));
        }
        CHECK(errors[0] < 2e-5);
        const double order = std::log2(errors[0] / errors[1]);
        CHECK(order > 3.8);
        CHECK(order < 4.4);
    }
}

TEST_CASE("frames away from the centres, bodies that turn: the origins and axes meet, momenta are kept, and the ledger explains the energy")
{
    for (const std::string type : {"Acceleration", "Force"})
    {
        CAPTURE(type);
        const std::vector<std::pair<std::string, double>> bodies{{"one", 2.0}, {"two", 0.5}};
        Scene s(body("one", 2, 0.3, "position='0 0 0' angular_velocity='0.3 0.1 0.2'") +
                    body("two", 0.5, 0.02, "position='0.5 0.1 0' orientation='axis 1 2 0.5 40 deg' linear_velocity='0.1 0 0.2'") +
                    "<component id='snap' type='Constraint/Snap/" + type +
                    "' a='one' b='two' point_a='0.2 0 0' point_b='-0.1 0.05 0' frequency='2' "
                    "frame_b='axis 0 1 0 10 deg'/>",
                "dt='1/480'");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        const auto [p, l] = momenta(s, bodies);
        const double start = s.simulation().kinetic_at_start();
        for (int n = 0; n < 10; ++n)
        {
            s.run(0.1 * (n + 1));
            const auto [p_now, l_now] = momenta(s, bodies);
            CHECK(distance(p_now, p) < 1e-12);
            CHECK(distance(l_now, l) < 1e-9);
            const auto totals = s.simulation().totals();
            CHECK(std::fabs(totals.kinetic - start - totals.work) < 1e-7);
        }
        s.run(3);
        CHECK(s.real("snap", "distance") < 1e-8);
        CHECK(s.real("snap", "angle") < 1e-6);
    }
}

namespace
{

/// A pin and a plate with a hole, 6 cm and 20 degrees apart, and the rule that puts the one into the other.
const std::string kPinAndHole = body("plate", 3, 0.5, "position='0 0 0'") +
                                body("pin", 0.2, 0.001, "position='0.05 0.03 0.02' orientation='axis 1 1 0 20 deg'") +
                                "<component id='hole' type='Connector/Frame' kind='bore' object='plate'/>"
                                "<component id='end' type='Connector/Frame' kind='axle' object='pin' position='0 0 0.01'/>";

std::string pin_rule(const std::string& more = "")
{
    return "<component id='fit' type='Rule/Pair' a_connector='bore' b_connector='axle' reach='0.1' draw='3' " + more +
           "><template><component id='${rule}.${a}.${b}' type='Constraint/Hinge' a='${a}' b='${b}' anchor='${point}' "
           "axis='${axis}'/></template>"
           "</component>";
}

}  // namespace

TEST_CASE("a rule with `draw`: drawn together, then latched by a hinge, without a jump")
{
    Scene s(kPinAndHole + pin_rule());
    serve(s);
    s.step();
    REQUIRE(exists(s, "fit.plate.pin.draw"));
    CHECK(made_by(s, "fit.plate.pin.draw") == "fit");
    CHECK(!exists(s, "fit.plate.pin"));
    const double start = s.simulation().kinetic_at_start();
    double fastest = 0, largest_change = 0, unexplained = 0;
    Vec3 before = s.vec("pin", "linear_velocity");
    double latched_at = 0;
    for (int n = 0; n < 480; ++n)
    {
        s.step();
        const Vec3 now = s.vec("pin", "linear_velocity");
        fastest = std::max(fastest, length(now));
        if (exists(s, "fit.plate.pin"))
        {
            if (latched_at == 0) latched_at = s.simulation().time();
            largest_change = std::max(largest_change, distance(now, before));
        }
        before = now;
        const auto t = s.simulation().totals();
        unexplained = std::max(unexplained, std::fabs(t.kinetic - start - t.work));
    }
    CHECK(latched_at > 0.2);
    CHECK(latched_at < 1);
    CHECK(!exists(s, "fit.plate.pin.draw"));
    CHECK(fastest > 0.1);
    CHECK(largest_change < 1e-3);  // latch_speed
    CHECK(unexplained < 1e-6);
    CHECK(s.real("fit.plate.pin", "position_error") < 1e-9);
    CHECK(s.count("component.made") == 2);
    const auto [p, l] = momenta(s, {{"plate", 3.0}, {"pin", 0.2}});
    CHECK(length(p) < 1e-9);
}

TEST_CASE("two that are torn apart while they are drawn are let go, and are drawn again when they come near")
{
    Scene s(kPinAndHole + pin_rule());
    serve(s);
    s.step(10);
    REQUIRE(exists(s, "fit.plate.pin.draw"));
    set(s, "pin", "position", "0.3 0 0");
    s.step(2);
    CHECK(!exists(s, "fit.plate.pin.draw"));
    set(s, "pin", "position", "0.05 0 0");
    s.step(2);
    CHECK(exists(s, "fit.plate.pin.draw"));
}
