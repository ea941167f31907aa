// Rolling resistance: a couple of at most rho times the normal force resists rolling (Johnson, Contact Mechanics (1985), 8.3), another one
// spinning about the normal.
//
// A round body of inertia c m R^2 that rolls on level ground: friction f and the couple give m a = -f, c m R^2 a / R = f R - rho m g, so
//
//   a = -rho g / (R (1 + c))
//
// On a slope of angle b it stays where it is if tan b <= rho / R; otherwise it rolls with a = g (sin b - rho / R cos b) / (1 + c). Of a
// ball that spins on the spot, w' = -sigma m g / I. A ball that rolls across a slope, in the plane:
//
//   v' = (g sin b e - rho / R g cos b v / |v|) / (1 + c)
//
// | algorithm         | at h = 1/240: stopping distance of 1.43 m | speed after the first step | place after 1 s across a slope |
// |-------------------|-------------------------------------------|----------------------------|--------------------------------|
// | Direct            | 5e-8 m: it stops within a step            | 2e-16 m/s                  | 9e-8 m, of order 2             |
// | SequentialImpulse | 2e-8 m                                    | 2e-16 m/s                  |                                |
// | SoftStep          | 3e-3 m: its contact presses less at first | 2e-4 m/s                   |                                |
#include <algorithm>
#include <numbers>

#include "motion.h"
#include "order.h"
#include "slide.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kRadius = 0.1, kBall = 0.4, kCan = 0.5;

struct Ground
{
    std::string manager = "Direct";
    double rolling = 0.005, spinning = 0;
    Vec3 g{0, 0, -kG};
    double friction = 0.8;
};

std::string on(const Ground& ground, const std::string& bodies, const std::string& between)
{
    return kGround + bodies + gravity(between, ground.g) + "<component id='manager' type='Manager/" + ground.manager +
           "'/><component id='response' type='Response/Rows' manager='manager' friction='" + text(ground.friction) +
           "' rolling_friction='" + text(ground.rolling) + "' spinning_friction='" + text(ground.spinning) +
           "'/><component id='contact' type='CDetection/ODE' between='" + between +
           " ground' resolution='Resolution/None' response='response'/>";
}

std::string ball(const Vec3& v, const Vec3& w)
{
    return sphere("a", kRadius, at({0, 0, kRadius}, v) + " angular_velocity='" + text(w) + "'");
}
Vec3 rolling_with(const Vec3& v) { return {-v.y / kRadius, v.x / kRadius, 0}; }

/// A ball that rolls on the ground with v at first.
struct Rolls : Scene
{
    Rolls(const Ground& ground, const Vec3& v, double h) : Scene(on(ground, ball(v, rolling_with(v)), "a"), step_of(h))
    {
        REQUIRE_MESSAGE(loaded(), error());
    }
};

double deceleration(double rolling, double c) { return rolling * kG / (kRadius * (1 + c)); }

}  // namespace

TEST_CASE("rolling resistance: a ball rolls to a stop, and from its first step on it is as slow as it should be")
{
    struct Case
    {
        std::string manager;
        double distance, first;
    };
    const double a = deceleration(0.005, kBall), h = 1.0 / 240;
    for (const Case& c : {Case{"Direct", 1e-7, 1e-15}, Case{"SequentialImpulse", 1e-7, 1e-15}, Case{"SoftStep", 6e-3, 4e-4}})
    {
        CAPTURE(c.manager);
        Rolls s({c.manager}, {1, 0, 0}, h);
        s.step();
        const double first = std::fabs(s.vec("a", "linear_velocity").x - (1 - a * h));
        CHECK(first < c.first);
        s.run(1.2 / a);
        const double error = std::fabs(s.vec("a", "position").x - 0.5 / a);
        MESSAGE(c.manager << ": first step " << first << " m/s, distance " << error << " m");
        CHECK(error < c.distance);
        CHECK(length(s.vec("a", "linear_velocity")) < 1e-9);
        CHECK(length(s.vec("a", "angular_velocity")) < 1e-8);
    }
}

TEST_CASE("rolling resistance: balls that joints hold in a row roll as each of them does, and the joints hold")
{
    const double a = deceleration(0.005, kBall);
    for (const std::string manager : {"Direct", "SequentialImpulse", "SoftStep"})
    {
        CAPTURE(manager);
        std::string bodies, between;
        for (int i = 0; i < 8; ++i)
        {
            const std::string id = "b" + std::to_string(i), before = "b" + std::to_string(i - 1);
            bodies += sphere(id, kRadius, at({0.2 * i, 0, kRadius}, {0, 1, 0}) + " angular_velocity='-10 0 0'");
            between += id + " ";
            if (i > 0)
                bodies += "<component id='j" + id + "' type='Constraint/Ball' a='" + before + "' b='" + id + "' anchor='" +
                          text(Vec3{0.2 * i - 0.1, 0, kRadius}) + "'/><component id='x" + id + "' type='Collision/Exclude' a='" + before +
                          "' b='" + id + "'/>";
        }
        // Without spinning resistance Direct shares the loads of the row unevenly, more so in each step, and the row bends (README).
        Scene s(on({manager, 0.005, 0.002}, bodies, between), step_of(1.0 / 240));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(1);
        const double bound = manager == "SoftStep" ? 2e-3 : 1e-12;
        for (int i = 0; i < 8; ++i) CHECK(near(s.vec("b" + std::to_string(i), "position").y, 1 - 0.5 * a, bound));
        CHECK(s.real("jb4", "position_error") < bound);
    }
}

TEST_CASE("rolling resistance: a can rolls on two points as a ball does on one")
{
    const double a = deceleration(0.005, kCan);
    Scene s(on({},
               "<component id='can' type='Shape/Cylinder' radius='0.1' height='0.3'/><component id='a' type='State/RigidBody' mass='1' "
               "shape='can' inertia='0.01 0.01 0.005' orientation='axis 1 0 0 90 deg' position='0 0 0.1' linear_velocity='1 0 0' "
               "angular_velocity='0 10 0'/>",
               "a"),
            step_of(1.0 / 240));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1);
    MESSAGE("speed: " << s.vec("a", "linear_velocity").x - (1 - a));
    CHECK(near(s.vec("a", "linear_velocity").x, 1 - a, 1e-9));
}

TEST_CASE("rolling resistance: a ball stays on a slope up to tan b = rho / R, in all directions, and rolls as it should beyond")
{
    for (const std::string manager : {"Direct", "SequentialImpulse", "SoftStep"})
        for (const double azimuth : {0.0, 0.4, 1.0, 2.5})
        {
            CAPTURE(manager);
            CAPTURE(azimuth);
            const double ratio = 0.05;
            const auto slope = [&](double factor)
            {
                const double angle = std::atan(factor * ratio);
                return Vec3{kG * std::sin(angle) * std::cos(azimuth), kG * std::sin(angle) * std::sin(azimuth), -kG * std::cos(angle)};
            };
            Rolls stays({manager, ratio * kRadius, 0, slope(0.99)}, {}, 1.0 / 240);
            stays.run(1);
            const bool is_soft = manager == "SoftStep";  // its contact presses less at first
            CHECK(distance(stays.vec("a", "position"), {0, 0, kRadius}) < (is_soft ? 1e-3 : 1e-9));
            const Vec3 g = slope(1.2);
            Rolls leaves({manager, ratio * kRadius, 0, g}, {}, 1.0 / 240);
            leaves.run(1);
            const Vec3 down{std::cos(azimuth), std::sin(azimuth), 0};
            const double due = (dot(g, down) + ratio * g.z) / (1 + kBall);
            const Vec3 v = leaves.vec("a", "linear_velocity");
            CHECK(std::fabs(dot(v, down) / due - 1) < (is_soft ? 4e-2 : 1e-9));
            CHECK(length(v - down * dot(v, down)) < 1e-9 * due);
        }
}

TEST_CASE("rolling resistance: a ball that rolls across a slope is slowed against its motion, whichever way that turns")
{
    const double ratio = 0.05, angle = std::atan(0.03), until = 1;  // not steep enough to set it in motion
    const Vec3 g{0, kG * std::sin(angle), -kG * std::cos(angle)};
    const auto end = integrate_all(std::array{0.0, 0.0, 1.0, 0.0}, until,
                                   [&](const std::array<double, 4>& y)
                                   {
                                       const double slows = ratio * g.z / std::hypot(y[2], y[3]) / (1 + kBall);
                                       return std::array{y[2], y[3], slows * y[2], slows * y[3] + g.y / (1 + kBall)};
                                   });
    const auto error = [&](double h)
    {
        Rolls s({"Direct", ratio * kRadius, 0, g}, {1, 0, 0}, h);
        s.run(until);
        return distance(s.vec("a", "position"), {end[0], end[1], kRadius});
    };
    const double coarse = error(1.0 / 120), fine = error(1.0 / 240);
    MESSAGE("1/120: " << coarse << " m, 1/240: " << fine);
    CHECK(end[1] > 0.05);
    CHECK(fine < 2e-7);
    CHECK(observed_order(coarse, fine) > 1.9);
}

// C26: a thin disc of radius a rolls round on its rim with its centre at rest, leaning by b from level: its angular velocity is along its
// lower radius, w = sqrt(4 g sin b / a), and rolling takes rho m g w cos b.
TEST_CASE("C26: Euler's disc loses what rolling resistance takes, and nothing but that")
{
    constexpr double kThin = 0.004, kLean = 0.3, rho = 1e-4, until = 0.5;
    const double w = std::sqrt(4 * kG * std::sin(kLean) / kRadius);
    const Vec3 spin{-w * std::cos(kLean), 0, w * std::sin(kLean)};
    const auto loss = [&](double rolling)
    {
        Scene s(on({.rolling = rolling},
                   "<component id='disc' type='Shape/Cylinder' radius='0.1' height='" + text(kThin) +
                       "'/><component id='a' type='State/RigidBody' mass='1' inertia='0.0025 0.0025 0.005' shape='disc' position='" +
                       text(Vec3{0, 0, kRadius * std::sin(kLean) + 0.5 * kThin * std::cos(kLean)}) + "' orientation='axis 0 1 0 " +
                       text(kLean) + "' angular_velocity='" + text(spin) + "'/>",
                   "a"),
                step_of(1.0 / 2000));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        const double before = energy(s);
        double most = before, last = before;
        for (int i = 0; i < 1000; ++i) s.step(), last = energy(s), most = std::max(most, last);
        CHECK(most < before + 1e-12);
        return before - last;
    };
    const double none = loss(0), some = loss(rho), due = rho * kG * w * std::cos(kLean) * until;
    MESSAGE("without " << none << " J, with " << some << ", due " << due);
    CHECK(none < 0.05 * due);  // it does not begin quite steadily, as it is not quite thin
    CHECK(std::fabs((some - none) / due - 1) < 0.05);
}

TEST_CASE("spinning resistance: a ball that spins on the spot stops in time, and one on a turntable is taken along")
{
    const double inertia = kBall * kRadius * kRadius, sigma = 2e-3, slows = sigma * kG / inertia;
    for (const std::string manager : {"Direct", "SequentialImpulse", "SoftStep"})
    {
        CAPTURE(manager);
        Scene s(on({manager, 0, sigma}, ball({}, {0, 0, 10}), "a"), step_of(1.0 / 240));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(1);
        MESSAGE(manager << ": " << s.vec("a", "angular_velocity").z - (10 - slows) << " rad/s");
        CHECK(near(s.vec("a", "angular_velocity").z, 10 - slows, manager == "SoftStep" ? 2e-2 : 1e-9));
        s.run(3);
        CHECK(length(s.vec("a", "angular_velocity")) < 1e-9);
    }
    const std::string table =
        "<component id='disc' type='Shape/Cylinder' radius='1' height='0.2'/><component id='table' type='State/Kinematic' shape='disc' "
        "position='0 0 0.1' angular_velocity='0 0 3'/>" +
        sphere("a", kRadius, at({0, 0, 0.3}));
    Scene s(on({"Direct", 0, sigma}, table, "a table"), step_of(1.0 / 240));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(0.4);
    CHECK(near(s.vec("a", "angular_velocity").z, 0.4 * slows, 1e-6));
    s.run(1);
    CHECK(near(s.vec("a", "angular_velocity").z, 3, 1e-6));
}

TEST_CASE("rolling resistance: a plate that begins to turn under a ball takes it along about its own axis alone")
{
    const double rho = 1e-4, until = 0.05;
    const Vec3 turn{0.2, 0.1, 0};
    Ground ground{"Direct", rho};
    ground.friction = 0;
    const std::string plate =
        "<component id='board' type='Shape/Box' half_extents='1 1 0.1'/><component id='plate' type='State/Kinematic' shape='board' "
        "position='0 0 0.5' angular_velocity='" +
        text(turn) + "'/>" + sphere("a", kRadius, at({0, 0, 0.7}));
    Scene s(on(ground, plate, "a plate"), step_of(1.0 / 240));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(until);
    const Vec3 due = normalized(turn) * (rho * kG * until / (kBall * kRadius * kRadius));
    CHECK(distance(s.vec("a", "angular_velocity"), due) < 0.02 * length(due));
}

TEST_CASE("rolling resistance between two bodies that move keeps their momentum and angular momentum, and takes energy")
{
    for (const std::string manager : {"Direct", "SequentialImpulse", "SoftStep"})
    {
        CAPTURE(manager);
        // A ball rolls along a slab that lies on ice.
        Ground ground{manager, 0.004, 0.002};
        const std::string bodies = box("slab", {1, 1, 0.1}, at({0, 0, 0.1}, {}, 5) + " material='ice'") +
                                   "<component id='ice' type='Material/Pair' a='ice' b='' friction='0' restitution='0'/>" +
                                   sphere("a", kRadius, at({-0.5, 0, 0.3}, {1, 0.2, 0}) + " material='rubber' angular_velocity='-2 10 7'") +
                                   "<component id='grip' type='Material/Pair' a='ice' b='rubber' friction='0.8' restitution='0' "
                                   "rolling_friction='0.004' spinning_friction='0.002'/>";
        Scene s(on(ground, bodies, "a slab"), step_of(1.0 / 240));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        const simulation::Totals before = s.simulation().totals();
        double last = before.kinetic;
        for (int i = 0; i < 120; ++i)
        {
            s.step();
            const double now = s.simulation().totals().kinetic;
            CHECK(now < last + 1e-9);
            last = now;
        }
        const simulation::Totals after = s.simulation().totals();
        CHECK(std::fabs(after.momentum.x - before.momentum.x) < 1e-10);
        CHECK(std::fabs(after.momentum.y - before.momentum.y) < 1e-10);
        CHECK(std::fabs(after.angular_momentum.z - before.angular_momentum.z) < 1e-3);
        CHECK(after.kinetic < before.kinetic - 0.05);
    }
}

TEST_CASE("with rolling resistance balls that are thrown on the ground come to rest and sleep; without it they roll on")
{
    for (const double rolling : {0.0, 2e-3})
    {
        CAPTURE(rolling);
        std::string bodies, between;
        for (int i = 0; i < 40; ++i)
        {
            const std::string id = "b" + std::to_string(100 + i);
            bodies += sphere(id, 0.1, at({0.3 * (i % 7), 0.3 * (i / 7), 0.2 + 0.01 * i}, {std::cos(i), std::sin(2.0 * i), 0}));
            between += id + " ";
        }
        Scene s(kGround + bodies + gravity(between) +
                    "<component id='contact' type='CDetection/ODE' between='*' response.friction='0.5' response.rolling_friction='" +
                    text(rolling) + "' response.spinning_friction='1e-3'/>",
                step_of(1.0 / 120));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(10);
        if (rolling > 0)
            CHECK(s.simulation().totals().kinetic < 1e-9);
        else
            CHECK(s.simulation().totals().kinetic > 1);
    }
}

TEST_CASE("a material that resists rolling is told of where the response does not")
{
    const std::string law = "<component id='law' type='Material/Pair' a='' b='' friction='0.5' restitution='0' rolling_friction='1e-3'/>";
    for (const auto& [response, count] : {std::pair("Impulse", 1), {"Penalty", 1}, {"None", 0}, {"Rows", 0}, {"Automatic", 0}})
    {
        CAPTURE(response);
        Scene s(kGround + ball({1, 0, 0}, {0, 10, 0}) + law + gravity("a") +
                    "<component id='contact' type='CDetection/ODE' between='a ground' response='Response/" + response + "'/>",
                step_of(1.0 / 240));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = s.keep_events = true;
        s.step(2);
        CHECK(s.count("contact.unresisted") == count);
    }
}
