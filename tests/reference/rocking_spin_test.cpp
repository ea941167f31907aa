// What spins fast on a round end turns far within a coarse step: it advances in parts there (server/simulation/contacts/turn_parts.h).
#include <array>
#include <cmath>
#include <numbers>

#include "order.h"

using namespace plab;
using namespace plab::test;

namespace
{

std::string contact(const std::string& resolution)
{
    return "<component id='gravity' type='Field/Gravity' between='body'/><component id='contact' type='CDetection/ODE' between='*' "
           "resolution='Resolution/" +
           resolution + "' response='Response/Rows' response.friction='0' response.manager='Manager/Direct'/>";
}

/// A ball on a smooth floor whose centre of mass is beside its centre, on an axis of symmetry that stands at an angle q to the vertical.
/// With u = cos q, V = m g a u, and p = I turn sin^2 q + J spin u, which is constant as the spin about the axis is:
/// (I + m a^2 sin^2 q) q'' = sin q (u (I turn^2 - m a^2 q'^2) - J spin turn + m g a).
struct HeavyBall
{
    static constexpr double kWeight = 9.81, R = 0.1, a = 0.03, I = 0.006, J = 0.005, kStart = 1.1;  // m/s^2, m, kg m^2, rad; 1 kg
    double spin = 20;                                                                               // rad/s

    /// m: where its centre is after `time`. The centre of mass stays above the origin.
    Vec3 centre(double time) const
    {
        const double p = J * spin * std::cos(kStart);
        const auto rates = [&](const std::array<double, 3>& y)
        {
            const double s = std::sin(y[0]), u = std::cos(y[0]), turn = (p - J * spin * u) / (I * s * s);
            return std::array{y[1], s * (u * (I * turn * turn - a * a * y[1] * y[1]) - J * spin * turn + kWeight * a) / (I + a * a * s * s),
                              turn};
        };
        const auto [q, rate, azimuth] = integrate_all(std::array{kStart, 0.0, 0.0}, time, rates);
        return {-a * std::sin(q) * std::cos(azimuth), -a * std::sin(q) * std::sin(azimuth), R};
    }

    std::string scene(const std::string& resolution) const
    {
        const Vec3 axis{std::sin(kStart), 0, std::cos(kStart)};
        return "<component id='ground' type='State/Static' shape='Shape/Plane'/>"
               "<component id='body' type='State/RigidBody' mass='1' center_of_mass='0 0 " +
               text(a) + "' inertia='" + text(Vec3{I, I, J}) + "' position='" + text(centre(0)) + "' orientation='axis 0 1 0 " +
               text(kStart) + "' linear_velocity='" + text(cross(axis * spin, axis * -a)) + "' angular_velocity='" + text(axis * spin) +
               "' shape='Shape/Sphere' shape.radius='" + text(R) + "'/>" + contact(resolution);
    }
};

}  // namespace

TEST_CASE("a ball with a heavy side that spins fast nods and precesses as its equations say, at coarse steps as well")
{
    const HeavyBall ball;
    for (const std::string resolution : {"None", "LocalRoot"})
        for (const double h : {1.0 / 30, 1.0 / 60, 1.0 / 120, 1.0 / 240})
        {
            CAPTURE(resolution);
            CAPTURE(h);
            const double e = error(ball.scene(resolution), h, 1, [&](double t) { return ball.centre(t); });
            MESSAGE(e, " m");
            CHECK(e < 3e-5);
        }
}

// The torque that turns the spin acts through the difference of the loads on both ends. With the inertia of the start of a step the ends
// left the floor in turn, and were put back on it: 4 % more spin about the vertical in a second, at 1/240 s.
TEST_CASE("a capsule that lies on a smooth floor and turns, spinning about its axis, keeps both spins")
{
    constexpr double kTurn = 11.7, kSpin = 11.1;  // rad/s
    for (const double h : {1.0 / 30, 1.0 / 60, 1.0 / 240, 1.0 / 480})
    {
        CAPTURE(h);
        Scene s(
            "<component id='ground' type='State/Static' shape='Shape/Plane'/>"
            "<component id='body' type='State/RigidBody' density='800' shape='Shape/Capsule' shape.radius='0.06' shape.length='0.2' "
            "position='0 0 0.06' orientation='axis 0 1 0 90 deg' angular_velocity='" +
                text(Vec3{kSpin, 0, kTurn}) + "'/>" + contact("None"),
            "dt='" + text(h) + "'");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        for (int k = 0; k < 8; ++k)
        {
            s.run(0.25 * (k + 1));
            const Vec3 w = s.vec("body", "angular_velocity"), axis = rotate(s.quat("body", "orientation"), {0, 0, 1});
            CHECK(w.z == doctest::Approx(kTurn).epsilon(1e-4));
            CHECK(dot(w, axis) == doctest::Approx(kSpin).epsilon(1e-4));
            CHECK(std::fabs(axis.z) < 1e-4);
        }
    }
}
