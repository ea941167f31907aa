// Located impacts of bodies that joints hold: the impact law acts on the mechanism as a whole.
#include <cmath>

#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

std::string ground_with(double friction, double restitution)
{
    return "<component id='ground' type='State/Static' shape='Shape/Plane'/><component id='contact' type='CDetection/ODE' between='*' "
           "response.friction='" +
           text(friction) + "' response.restitution='" + text(restitution) + "'/>";
}

std::string moving(const Vec3& velocity, const Vec3& spin)
{
    return "linear_velocity='" + text(velocity) + "' angular_velocity='" + text(spin) + "' ";
}

constexpr double kWheel = 0.15;  // m, radius

/// A car of rigid wheels that two motors drive on the ground. Four wheels stand on lines of two points each: how they share a load is
/// undetermined, what the car does is not.
std::string car(const Vec3& velocity = {}, double yaw_rate = 0)
{
    constexpr double kAxle = 0.4, kTrack = 0.37;
    const auto state = [&](const Vec3& at) { return moving(velocity + cross({0, 0, yaw_rate}, at), {0, 0, yaw_rate}); };
    std::string parts =
        "<component id='gravity' type='Field/Gravity' between='*'/>" + body("car", 20, {0.7, 2.5, 3}, {0, 0, 0.25}, state({})) +
        "<component id='wheel' type='Shape/Cylinder' radius='0.15' height='0.1'/><component id='manager' type='Manager/Direct'/>";
    for (int i = 0; i < 4; ++i)
    {
        const std::string id = "w" + std::to_string(i);
        const Vec3 at{i < 2 ? kAxle : -kAxle, i % 2 == 0 ? kTrack : -kTrack, kWheel};
        const std::string axle = "anchor='" + text(at) + "' axis='0 1 0'";
        parts += body(id, 1, {0.006, 0.006, 0.011}, at, state(at) + "orientation='axis 1 0 0 90 deg' shape='wheel' ") +
                 joint("axle" + id, "Hinge", "car", id, axle);
        if (i > 1) parts += joint("motor" + id, "Motor", "car", id, axle + " speed='10' max_effort='20' manager='manager'");
    }
    return parts + ground_with(0.8, 0);
}

}  // namespace

TEST_CASE("two bodies that a joint fixes to one another bounce with friction as one body does")
{
    const Vec3 middle{0.4, 0, 0.3}, velocity{0.5, 0.3, -2}, spin{1, 2, -3};
    const Vec3 of_ball{0, 0, 0.3}, of_load{0.6, 0, 0.3};
    const auto state = [&](const Vec3& at) { return moving(velocity + cross(spin, at - middle), spin); };
    const std::string ball = "shape='Shape/Sphere' shape.radius='0.1' ";
    Scene two(body("ball", 1, {0.02, 0.03, 0.04}, of_ball, state(of_ball) + ball) +
                  body("load", 2, {0.05, 0.06, 0.07}, of_load, state(of_load)) + joint("weld", "Fixed", "ball", "load", "") +
                  ground_with(0.4, 0.7),
              dt(960));
    // Inertias add, and 1 kg at 0.4 m and 2 kg at 0.2 m from the common centre add 0.24 kg m^2.
    Scene one(body("both", 3, {0.07, 0.33, 0.35}, middle, state(middle) + ball + "shape.position='-0.4 0 0'") + ground_with(0.4, 0.7),
              dt(960));
    for (Scene* s : {&two, &one})
    {
        REQUIRE_MESSAGE(s->loaded(), s->error());
        s->run(0.25);
    }
    const Vec3 mean = (two.vec("ball", "linear_velocity") + two.vec("load", "linear_velocity") * 2) * (1.0 / 3);
    CHECK(one.vec("both", "linear_velocity").z > -1.1);  // it has bounced
    CHECK(length(mean - one.vec("both", "linear_velocity")) < 1e-8);
    CHECK(length(two.vec("ball", "angular_velocity") - one.vec("both", "angular_velocity")) < 1e-8);
}

TEST_CASE("a lever bounces with friction as Stronge's law says, and jams where friction holds it")
{
    // Its end moves along one line only, so slip ends when the end stops, and turns round with it. The normal impulse returns the share e^2
    // of its work, friction holds back on both ways: w' / w = -e sqrt((x - mu h) / (x + mu h)), x and h from the hinge to the contact.
    constexpr double kX = 0.6, kH = 0.3, kSpin = 2, kRestitution = 0.8;
    for (const double friction : {0.0, 0.3, 0.8, 1.9, 2.5})
    {
        CAPTURE(friction);
        // It starts a bit above: where it meets the ground, the contact is at (x, -h).
        const double radius = 0.05, rise = 0.05, down = kH - radius;
        const double length = std::hypot(kX, down), angle = std::asin(down / length) - rise;
        const Vec3 hinge{0, 0, kH}, tip{length * std::cos(angle), 0, kH - length * std::sin(angle)};
        Scene s(body("lever", 1, {0.1, 0.1, 0.1}, tip,
                     moving(cross(Vec3{0, kSpin, 0}, tip - hinge), {0, kSpin, 0}) + "shape='Shape/Sphere' shape.radius='0.05' ") +
                    joint("hinge", "Hinge", "", "lever", "anchor='" + text(hinge) + "' axis='0 1 0'") + ground_with(friction, kRestitution),
                dt(480));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = friction > kX / kH;
        s.run(0.1);
        const double left = std::max(0.0, (kX - friction * kH) / (kX + friction * kH));
        CHECK(s.vec("lever", "angular_velocity").y == doctest::Approx(-kRestitution * kSpin * std::sqrt(left)).epsilon(1e-8));
    }
}

TEST_CASE("a step ladder that falls on both feet at once bounces without a loss, and stays symmetric")
{
    const std::string falls = moving({0, 0, -1}, {}), foot = "shape='Shape/Sphere' shape.radius='0.05' ";
    Scene s(body("left", 1, {0.1, 0.2, 0.3}, {-0.3, 0, 0.2}, falls + foot + "shape.position='-0.2 0 -0.1'") +
                body("right", 1, {0.1, 0.2, 0.3}, {0.3, 0, 0.2}, falls + foot + "shape.position='0.2 0 -0.1'") +
                joint("hinge", "Hinge", "left", "right", "anchor='0 0 0.4' axis='0 1 0'") + ground_with(0, 1),
            dt(480));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(0.1);
    const Vec3 left = s.vec("left", "linear_velocity"), right = s.vec("right", "linear_velocity");
    CHECK(left.z > 0);
    CHECK(std::fabs(left.x + right.x) + std::fabs(left.z - right.z) < 1e-11);
    const double turning = s.vec("left", "angular_velocity").y;
    CHECK(length_squared(left) + 0.2 * turning * turning == doctest::Approx(1).epsilon(1e-9));
}

TEST_CASE("a car that drives over a bump meets it with both front wheels at once, and stays on its line")
{
    Scene s(car() +
                "<component id='log' type='Shape/Cylinder' radius='0.5' height='3'/>"
                "<component id='bump' type='State/Static' shape='log' position='3 0 -0.44' orientation='axis 1 0 0 90 deg'/>",
            dt(240));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1.6);
    CHECK(s.vec("car", "linear_velocity").x == doctest::Approx(10 * kWheel).epsilon(1e-9));
    s.run(1.9);  // it meets the bump after 1.7 s
    CHECK(std::fabs(s.vec("car", "angular_velocity").y) > 1e-3);
    const Vec3 velocity = s.vec("car", "linear_velocity"), spin = s.vec("car", "angular_velocity");
    CHECK(std::fabs(velocity.y) + std::fabs(spin.x) + std::fabs(spin.z) < 1e-7);
    CHECK(std::fabs(s.vec("car", "position").y) < 1e-8);
}

TEST_CASE("a car that starts with some slip sideways drives on, and the loads of its wheels are found in few iterations")
{
    for (const double yaw_rate : {0.05, 0.3})
    {
        CAPTURE(yaw_rate);
        Scene s(car({1, 0.05, 0}, yaw_rate), dt(240));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        std::int64_t iterations = 0;
        int missed = 0;
        for (int i = 0; i < 720; ++i)
        {
            s.step(1);
            iterations += std::get<std::int64_t>(s.get("contact.response.manager", "iterations"));
            missed += s.real("contact.response.manager", "residual") > 1e-6 ? 1 : 0;
        }
        MESSAGE("iterations: " << iterations << ", steps with a residual above 1e-6 m/s: " << missed << " of 720");
        CHECK(s.vec("car", "linear_velocity").x == doctest::Approx(10 * kWheel).epsilon(1e-2));
        CHECK(iterations < 3000);
        CHECK(missed <= 3);
    }
}
