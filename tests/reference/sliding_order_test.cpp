// Balls that slide and roll along curved surfaces and leave them: order 2 in the state and in the time of release, no hops.
#include <array>
#include <numbers>
#include <vector>

#include "exact/motions.h"
#include "sliding.h"
#include "support/gravity.h"
#include "support/scene.h"
#include "support/text.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kRadius = 0.1;

/// The angle of a ball whose centre goes round a circle, and how fast it turns.
struct Swing
{
    double angle = 0, speed = 0;  // rad, rad/s
};

/// In a bowl, from rest; angles from the lowest point. `length`: of the pendulum that swings alike, m.
Swing in_bowl(double length, double start, double time)
{
    Swing out;
    exact::PendulumMotion(std::sqrt(kG / length), start, 0).at(time, out.angle, out.speed);
    return out;
}

/// On a dome, from its top; angles from there.
Swing on_dome(double length, double speed, double time)
{
    Swing out;
    exact::PendulumMotion(std::sqrt(kG / length), std::numbers::pi, speed).at(time, out.angle, out.speed);
    out.angle -= std::numbers::pi;
    return out;
}

std::string ball(const Vec3& at, const Vec3& v, const Vec3& spin)
{
    // A solid one: 2/5 m r^2.
    return "<component id='ball.shape' type='Shape/Sphere' radius='0.1'/><component id='ball' type='State/RigidBody' shape='ball.shape' "
           "mass='1' inertia='0.004 0.004 0.004' position='" +
           text(at) + "' linear_velocity='" + text(v) + "' angular_velocity='" + text(spin) +
           "'/><component id='weight' type='Field/Gravity' between='ball'/>";
}

std::string touching(const std::string& response, double friction)
{
    return "<component id='contact' type='CDetection/ODE' between='ball ground' resolution='Resolution/None' response='" + response +
           "' response.friction='" + text(friction) + "'/>";
}

const std::string kBowl = "<component id='bowl' type='Shape/Bowl' radius='1'/><component id='ground' type='State/Static' shape='bowl'/>";
const std::string kDome = "<component id='dome' type='Shape/Sphere' radius='1'/><component id='ground' type='State/Static' shape='dome'/>";
const std::array<std::string, 3> kResponses{"Response/Rows' response.manager='Manager/Direct",
                                            "Response/Rows' response.manager='Manager/SequentialImpulse", "Response/Impulse"};

/// m and m/s: errors of a ball that moves down in a bowl from 1 rad, rolling or sliding, after 1.5 s.
double error_in_bowl(const std::string& response, double friction, int steps_per_second)
{
    constexpr double kLength = 1 - kRadius, kStart = 1.0, kTime = 1.5;
    Scene s(kBowl + ball({kLength * std::sin(kStart), 0, -kLength * std::cos(kStart)}, {}, {}) + touching(response, friction),
            "dt='1/" + std::to_string(steps_per_second) + "'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    s.run(kTime);
    const Swing due = in_bowl(kLength * (friction > 0 ? 7.0 / 5 : 1.0), kStart, kTime);
    CHECK(s.count("contact.begin") == 1);
    CHECK(s.count("contact.end") == 0);
    CHECK(s.count("contact.release") == 0);
    const Vec3 at{kLength * std::sin(due.angle), 0, -kLength * std::cos(due.angle)};
    const Vec3 v = Vec3{std::cos(due.angle), 0, std::sin(due.angle)} * (kLength * due.speed);
    return distance(s.vec("ball", "position"), at) + distance(s.vec("ball", "linear_velocity"), v);
}

struct Leaving
{
    double state = 0, time = 0;  ///< m and m/s, s: errors
};

/// A ball that slides down a dome, with 1 m/s at the top: where it leaves, and its state 0.1 s later.
Leaving errors_on_dome(const std::string& response, int steps_per_second)
{
    constexpr double kLength = 1 + kRadius, kSpeed = 1, kAfter = 0.0625;
    // Pressed until cos = (2 + v^2 / (g l)) / 3; the time by bisection of the motion.
    const double angle = std::acos((2 + kSpeed * kSpeed / (kG * kLength)) / 3);
    double low = 0, high = 2;
    for (int i = 0; i < 60; ++i)
    {
        const double middle = 0.5 * (low + high);
        (on_dome(kLength, kSpeed / kLength, middle).angle < angle ? low : high) = middle;
    }
    const Swing leaves = on_dome(kLength, kSpeed / kLength, low);
    Scene s(kDome + ball({0, 0, kLength}, {kSpeed, 0, 0}, {}) + touching(response, 0), "dt='1/" + std::to_string(steps_per_second) + "'");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    const double until = std::ceil((low + kAfter) * 60) / 60, flight = until - low;
    s.run(until);
    CHECK(s.count("contact.begin") == 1);
    REQUIRE(s.count("contact.release") == 1);
    Leaving out;
    for (const Event& e : s.events)
        if (e.kind == "contact.release") out.time = std::fabs(e.time - low);
    const Vec3 v0 = Vec3{std::cos(angle), 0, -std::sin(angle)} * (kLength * leaves.speed);
    const Vec3 v = v0 - Vec3{0, 0, kG * flight};
    const Vec3 at = Vec3{std::sin(angle), 0, std::cos(angle)} * kLength + (v0 + v) * (0.5 * flight);
    out.state = distance(s.vec("ball", "position"), at) + distance(s.vec("ball", "linear_velocity"), v);
    return out;
}

}  // namespace

TEST_CASE("a ball slides in a bowl: order 2")
{
    for (const std::string& response : kResponses)
    {
        CAPTURE(response);
        std::vector<double> errors;
        for (const int n : {60, 120, 240, 480}) errors.push_back(error_in_bowl(response, 0, n));
        check_order(errors, 3e-4);
    }
}

TEST_CASE("a ball rolls in a bowl: order 2")
{
    for (const std::string& response : kResponses)
    {
        CAPTURE(response);
        std::vector<double> errors;
        for (const int n : {60, 120, 240, 480}) errors.push_back(error_in_bowl(response, 2, n));
        check_order(errors, 3e-4);
    }
}

TEST_CASE("a ball slides off a dome: it is also released with short steps")
{
    for (const std::string& response : kResponses)
        for (const int n : {1920, 7680})
        {
            if (response.find("Sequential") != std::string::npos) continue;
            CAPTURE(response);
            CAPTURE(n);
            CHECK(errors_on_dome(response, n).time < 2.0 / n);
        }
}

TEST_CASE("a body that rocks on its edges is not released while it touches")
{
    for (const std::string& response : kResponses)
    {
        CAPTURE(response);
        Scene s(
            "<component id='plane' type='Shape/Plane'/><component id='ground' type='State/Static' shape='plane'/>"
            "<component id='box' type='Shape/Box' half_extents='0.1 0.1 0.2'/><component id='ball' type='State/RigidBody' shape='box' "
            "mass='1' position='0 0 0.2' angular_velocity='0 1 0' linear_velocity='0.2 0 0.1'/>"
            "<component id='weight' type='Field/Gravity' between='ball'/>" +
                touching(response, 1),
            "dt='1/240'");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.keep_events = true, s.warnings_expected = true;
        double highest = 0;
        for (int i = 0; i < 60; ++i)
        {
            s.step();
            highest = std::max(highest, s.vec("ball", "position").z);
        }
        CHECK(highest > 0.202);  // it rose onto an edge
        CHECK(s.count("contact.end") == 0);
        CHECK(s.count("contact.release") == 0);
    }
}

TEST_CASE("a body between walls that is lifted off is released once, from the body on which it pressed")
{
    for (const std::string& response : kResponses)
        for (const char* shapes : {"wall floor", "floor wall"})
        {
            CAPTURE(response);
            CAPTURE(std::string(shapes));
            // It touches the wall but presses only on the floor; both belong to one body, so this is one pair.
            Scene s(
                "<component id='floor' type='Shape/Plane'/><component id='wall' type='Shape/Plane' orientation='axis 0 1 0 "
                "-1.5707963267948966'"
                " position='0.1 0 0'/><component id='ground' type='State/Static' shape='" +
                    std::string(shapes) +
                    "'/><component id='form' type='Shape/Sphere' radius='0.1'/>"
                    "<component id='ball' type='State/RigidBody' shape='form' mass='1' position='0 0 0.1'/>"
                    "<component id='weight' type='Field/Gravity' between='ball'/>" +
                    touching(response, 0),
                "dt='1/240'");
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.keep_events = true, s.warnings_expected = true;
            s.step(20);
            CHECK(s.count("contact.release") == 0);
            REQUIRE(s.ask(simulation::PushOperation{"ball", {0, 0, 2}, {}}).done);
            s.step(3);
            CHECK(s.vec("ball", "position").z > 0.1);
            CHECK(s.count("contact.release") == 1);
        }
}

TEST_CASE("a body slides in a bowl with a prescribed velocity as in one at rest")
{
    const auto place = [](const std::string& response, double speed)
    {
        const auto of = [&](const char* id, const Vec3& at, double along)
        {
            return "<component id='" + std::string(id) + "' type='State/RigidBody' shape='form' mass='1' position='" + text(at) +
                   "' linear_velocity='" + text(Vec3{speed, along, 0}) + "'/>";
        };
        Scene s(
            "<component id='bowl' type='Shape/Bowl' radius='1'/><component id='form' type='Shape/Sphere' radius='0.1'/>"
            "<component id='ground' type='State/Kinematic' shape='bowl' linear_velocity='" +
                text(Vec3{speed, 0, 0}) + "'/>" + of("ball", {0, 0, -0.9}, 0) + of("rider", {0, 0, -0.7}, 0.05) +
                "<component id='weight' type='Field/Gravity' between='ball rider'/>"
                "<component id='contact' type='CDetection/ODE' between='ball rider ground' resolution='Resolution/None' response='" +
                response + "' response.friction='0'/>",
            "dt='1/240'");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = true;
        s.run(0.25);
        return s.vec("rider", "position") - s.vec("ground", "position");
    };
    for (const std::string& response : kResponses)
    {
        CAPTURE(response);
        CHECK(distance(place(response, 10), place(response, 0)) < 1e-6);
    }
}

TEST_CASE("a ball slides off a dome: where it leaves, order 2, and one release without a hop")
{
    for (const std::string& response : kResponses)
    {
        CAPTURE(response);
        std::vector<double> states, times;
        for (const int n : {60, 120, 240, 480, 960})
        {
            const Leaving e = errors_on_dome(response, n);
            states.push_back(e.state), times.push_back(e.time);
        }
        if (response.find("Sequential") != std::string::npos)
        {
            // A contact held within the slop is 5e-5 m away from the surface when the ball leaves.
            CHECK(states.back() < 5e-4);
            CHECK(times.back() < 2e-3);
            continue;
        }
        check_order(states, 2e-5);
        // The instant may be anywhere in its step: the bound falls with the square of the step, not each error.
        for (std::size_t i = 0; i < times.size(); ++i) CHECK(times[i] < 0.02 / std::pow(4.0, static_cast<double>(i)));
    }
}
