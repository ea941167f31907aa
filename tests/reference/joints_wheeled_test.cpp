// A robot with two driven wheels and a caster, as most have them.
#include <algorithm>
#include <cmath>

#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kWheelRadius = 0.05, kHalfTrack = 0.15;  // m: of the wheels, and between the middle and each of them
const Vec3 kBase{0.05, 0, 0.06}, kCaster{0.15, 0, 0.02};

/// Wheels that turn at `left` and `right` rad/s from the start; the caster rolls. Its axle's middle is at the origin, above.
std::string robot(const std::string& wheel, double left, double right)
{
    const double speed = 0.5 * kWheelRadius * (left + right), turning = 0.5 * kWheelRadius * (right - left) / kHalfTrack;
    const auto state = [&](const Vec3& at, const Vec3& spin)
    {
        return "linear_velocity='" + text(Vec3{speed, 0, 0} + cross({0, 0, turning}, at)) + "' angular_velocity='" +
               text(spin + Vec3{0, 0, turning}) + "' ";
    };
    std::string parts = gravity() + "<component id='wheel' type='Shape/" + wheel + "'/>" +
                        "<component id='ground' type='State/Static' shape='Shape/Plane'/>" +
                        body("base", 5, {0.02, 0.04, 0.05}, kBase, state(kBase, {}));
    for (const bool is_left : {true, false})
    {
        const std::string id = is_left ? "left" : "right";
        const double own = is_left ? left : right;
        const Vec3 at{0, is_left ? kHalfTrack : -kHalfTrack, kWheelRadius};
        const std::string axle = "anchor='" + text(at) + "' axis='0 1 0'";
        parts += body(id, 0.3, {2e-4, 2e-4, 3.75e-4}, at, state(at, {0, own, 0}) + "orientation='axis 1 0 0 90 deg' shape='wheel' ") +
                 joint(id + "_axle", "Hinge", "base", id, axle) +
                 joint(id + "_motor", "Motor", "base", id, axle + " speed='" + text(own) + "'");
    }
    const Vec3 rolling{-turning * kCaster.x / kCaster.z, speed / kCaster.z, 0};
    return parts +
           body("caster", 0.05, {8e-6, 8e-6, 8e-6}, kCaster,
                state(kCaster, rolling) + "shape='Shape/Sphere' shape.radius='" + text(kCaster.z) + "' ") +
           joint("caster_joint", "Ball", "base", "caster", "anchor='" + text(kCaster) + "'") +
           "<component id='contact' type='CDetection/ODE' between='left right caster' against='ground' response.friction='0.8'/>";
}

/// m: how far the base is from its circle's point after `time` s.
double off_circle(const Scene& s, double left, double right, double time)
{
    const double turning = 0.5 * kWheelRadius * (right - left) / kHalfTrack, angle = turning * time,
                 radius = kHalfTrack * (right + left) / (right - left);
    const Vec3 at{radius * std::sin(angle) + kBase.x * std::cos(angle), radius * (1 - std::cos(angle)) + kBase.x * std::sin(angle),
                  kBase.z};
    return length(s.vec("base", "position") - at);
}

}  // namespace

TEST_CASE("a robot whose wheels touch in points drives round the circle of its wheels' speeds with order 2")
{
    double errors[2];
    for (const int per_second : {240, 480})
    {
        Scene s(robot("Sphere' radius='0.05", 8, 12), dt(per_second));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(2);
        errors[per_second == 240 ? 0 : 1] = off_circle(s, 8, 12, 2);
    }
    MESSAGE("off the circle after 2 s: " << errors[0] << " m, " << errors[1] << " m");
    CHECK(errors[0] < 1.2e-5);
    CHECK(std::log2(errors[0] / errors[1]) == doctest::Approx(2).epsilon(0.05));
}

TEST_CASE("where cylinders as wheels scrub in a bend, their impulses are found in most steps, and at once where they roll straight on")
{
    struct Drive
    {
        double left, right;
        int most_missed;
        std::int64_t most_iterations;
    };
    // At 1/480 s. Two points of each wheel cannot both roll in a bend; which of them slip depends on how they share the load.
    for (const Drive& d : {Drive{8, 12, 20, 90'000}, Drive{10, 10, 0, 1000}})
    {
        CAPTURE(d.right);
        Scene s(robot("Cylinder' radius='0.05' height='0.02", d.left, d.right), dt(480));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        std::int64_t iterations = 0;
        int missed = 0;
        for (int i = 0; i < 960; ++i)
        {
            s.step(1);
            iterations += std::get<std::int64_t>(s.get("contact.response.manager", "iterations"));
            missed += s.real("contact.response.manager", "residual") > 1e-6 ? 1 : 0;
        }
        MESSAGE("iterations: " << iterations << ", steps with a residual above 1e-6 m/s: " << missed << " of 960");
        CHECK(missed <= d.most_missed);
        CHECK(iterations <= d.most_iterations);
        CHECK(std::fabs(s.vec("base", "position").z - kBase.z) < 1e-4);
    }
}
