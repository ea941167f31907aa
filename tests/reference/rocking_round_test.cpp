// Round bodies whose centres of mass are not their centres, and what is carried by a face that turns: where the contact point goes within
// a step decides the order. References: closed forms, or Runge-Kutta in small steps on the equations with one unknown.
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "order.h"
#include "rocking.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kWeight = 9.81;  // m/s^2
const std::string kPlane = "<component id='ground' type='State/Static' shape='Shape/Plane'/>",
                  kBlock =
                      "<component id='ground' type='State/Static' position='0.3 0.2 -0.5' shape='Shape/Box' shape.half_extents='3 3 0.5'/>";

struct Managed
{
    const char* manager;
    const char* resolution;
};
constexpr std::array kManaged{Managed{"Direct", "None"}, Managed{"Direct", "LocalRoot"}, Managed{"Automatic", "LocalRoot"}};

std::string contact(const Managed& how, double friction)
{
    return "<component id='contact' type='CDetection/ODE' between='*' resolution='Resolution/" + std::string(how.resolution) +
           "' response='Response/Rows' response.friction='" + text(friction) + "' response.manager='Manager/" + how.manager +
           "'/><component id='gravity' type='Field/Gravity' between='body'/>";
}

}  // namespace

TEST_CASE("a ball and a cylinder with a heavy side roll with order 2")
{
    // phi: of the centre of mass, from below; it rolls towards -x as phi grows. The rolling body has
    // (I + m (R^2 + a^2 - 2 a R cos phi)) phi'' = -m a sin(phi) (g + R phi'^2).
    constexpr double R = 0.1, a = 0.04, I = 0.004, kEnd = 1;
    const Path path = [](double time)
    {
        const double start = std::numbers::pi / 2,
                     phi = integrate(start, 0, time,
                                     [](double p, double w) {
                                         return -a * std::sin(p) * (kWeight + R * w * w) / (I + R * R + a * a - 2 * a * R * std::cos(p));
                                     })[0];
        return Vec3{-R * (phi - start), 0, R};
    };
    const std::string shapes[] = {
        "position='0 0 0.1' shape='Shape/Sphere' shape.radius='0.1'",
        "position='0 0 0.1' orientation='axis 1 0 0 90 deg' shape='Shape/Cylinder' shape.radius='0.1' shape.height='0.3'"};
    for (const std::string& shape : shapes)
        for (const std::string& ground : {kPlane, kBlock})
            for (const Managed& how : kManaged)
            {
                CAPTURE(shape);
                CAPTURE(ground);
                const std::string body = "<component id='body' type='State/RigidBody' mass='1' center_of_mass='" + text(a) +
                                         " 0 0' inertia='" + text(Vec3{I, I, I}) + "' " + shape + "/>";
                check_order(how.manager, ground + body + contact(how, 0.6), 1.0 / 960, kEnd, path, 2e-5);
            }
}

TEST_CASE("a ladder slides down a wall with order 2 until it leaves it")
{
    constexpr double kLength = 1, r = 0.01, kEnd = 0.3;
    const double start = std::numbers::pi / 6;  // from the wall
    const auto angle = [&](double time)
    { return integrate(start, 0, time, [](double q, double) { return 1.5 * kWeight * std::sin(q); })[0]; };
    REQUIRE(std::cos(angle(kEnd)) > 2.0 / 3 * std::cos(start));  // beyond this the wall would have to pull
    const auto middle = [&](double q) { return Vec3{r + 0.5 * kLength * std::sin(q), 0, r + 0.5 * kLength * std::cos(q)}; };
    for (const Managed& how : kManaged)
    {
        const std::string ladder =
            "<component id='wall' type='State/Static' shape='Shape/Plane' orientation='axis 0 1 0 90 deg'/>"
            "<component id='body' type='State/RigidBody' mass='1' inertia='" +
            text(Vec3{1.0 / 12, 1.0 / 12, 1e-4}) + "' position='" + text(middle(start)) +
            "' orientation='axis 0 1 0 -30 deg' shape='Shape/Capsule' shape.radius='" + text(r) + "' shape.length='1'/>";
        check_order(
            how.manager, kPlane + ladder + contact(how, 0), 1.0 / 480, kEnd, [&](double time) { return middle(angle(time)); }, 1e-4);
    }
}

TEST_CASE("a rod that turns about the vertical falls on a smooth floor with order 2, slender as it may be")
{
    // With q from the floor, J across the axis and the momentum J cos^2 q turn about the vertical, which is constant:
    // (m l^2/4 cos^2 q + J) q'' = cos q (m l^2/4 sin q q'^2 - J sin q turn^2 - m g l/2).
    constexpr double kLength = 1, r = 0.02, J = 1.0 / 12, kStart = 1, kSpin = 3, kEnd = 0.3, A = kLength * kLength / 4;
    const Path middle = [](double time)
    {
        const auto acceleration = [](double q, double w)
        {
            const double c = std::cos(q), turn = kSpin * std::pow(std::cos(kStart) / c, 2);
            return c * (A * std::sin(q) * w * w - J * std::sin(q) * turn * turn - kWeight * kLength / 2) / (A * c * c + J);
        };
        return Vec3{0, 0, r + kLength / 2 * std::sin(integrate(kStart, 0, time, acceleration)[0])};
    };
    // Without spin about the axis.
    const Vec3 axis{-std::cos(kStart), 0, std::sin(kStart)}, spin = Vec3{0, 0, kSpin} - axis * (kSpin * axis.z);
    for (const double along : {1e-3, 1e-4, 1e-5})
    {
        CAPTURE(along);
        const std::string rod = "<component id='body' type='State/RigidBody' mass='1' inertia='" + text(Vec3{J, J, along}) +
                                "' position='" + text(middle(0)) + "' orientation='axis 0 1 0 " + text(kStart - std::numbers::pi / 2) +
                                "' angular_velocity='" + text(spin) + "' shape='Shape/Capsule' shape.radius='" + text(r) +
                                "' shape.length='1'/>";
        for (const Managed& how : kManaged) check_order(how.manager, kPlane + rod + contact(how, 0), 1.0 / 960, kEnd, middle, 1e-5);
    }
}

TEST_CASE("on a turntable, a ball rolls in circles and a box that stands is carried round, with order 2")
{
    constexpr double kSpin = 1, kEnd = 5, x0 = 0.5, r = 0.05, kSmall = 0.02;
    const std::string table = "<component id='table' type='State/Kinematic' position='0 0 -0.1' angular_velocity='0 0 " + text(kSpin) +
                              "' shape='Shape/Cylinder' shape.radius='3' shape.height='0.2'/>";
    // The ball's velocity turns at 2/7 of the table's.
    constexpr double v = 0.2, rate = 2.0 / 7 * kSpin;
    const Path round = [](double t) { return Vec3{x0 - v * (1 - std::cos(rate * t)) / rate, v * std::sin(rate * t) / rate, r}; };
    const auto ball = [&](double radius)
    {
        return "<component id='body' type='State/RigidBody' mass='1' position='" + text(Vec3{x0, 0, radius}) + "' linear_velocity='" +
               text(Vec3{0, v, 0}) + "' angular_velocity='" + text(Vec3{(kSpin * x0 - v) / radius, 0, 0}) +
               "' shape='Shape/Sphere' shape.radius='" + text(radius) + "'/>";
    };
    const Path carried = [](double t) { return Vec3{x0 * std::cos(kSpin * t), x0 * std::sin(kSpin * t), 0.1}; };
    const std::string box = "<component id='body' type='State/RigidBody' mass='1' position='" + text(Vec3{x0, 0, 0.1}) +
                            "' linear_velocity='" + text(Vec3{0, kSpin * x0, 0}) + "' angular_velocity='" + text(Vec3{0, 0, kSpin}) +
                            "' shape='Shape/Box' shape.half_extents='0.1 0.1 0.1'/>";
    // Sweeps whose impulses were scaled up from a sliver of a step threw this box into the air.
    CHECK(error(table + box + contact({"SequentialImpulse", "LocalRoot"}, 0.5), 1.0 / 480, kEnd, carried) < 1e-3);
    for (const Managed& how : kManaged)
    {
        check_order(std::string("ball ") + how.manager, table + ball(r) + contact(how, 2), 1.0 / 240, kEnd, round, 1e-5);
        // A small one turns by 0.25 rad in a step.
        const Path small_round = [&](double t) { return round(t) + Vec3{0, 0, kSmall - r}; };
        check_order(std::string("small ball ") + how.manager, table + ball(kSmall) + contact(how, 2), 1.0 / 60, kEnd, small_round, 1e-4);
        check_order(std::string("box ") + how.manager, table + box + contact(how, 0.5), 1.0 / 240, kEnd, carried, 1e-4);
    }
}

TEST_CASE("a ball slides down a face that tilts, and a plank rocks on a cylinder, with order 2")
{
    // Along the face, s'' = w^2 s + g sin(w t): s = s0 cosh(w t) + (g / 2 w^2) (sinh(w t) - sin(w t)).
    constexpr double kSpin = 0.3, kEnd = 1, s0 = 0.5, r = 0.05;
    const Path slid = [](double t)
    {
        const double tilt = kSpin * t;
        const double s = s0 * std::cosh(tilt) + kWeight / (2 * kSpin * kSpin) * (std::sinh(tilt) - std::sin(tilt));
        return Vec3{s * std::cos(tilt) + r * std::sin(tilt), 0, -s * std::sin(tilt) + r * std::cos(tilt)};
    };
    const std::string face =
        "<component id='table' type='State/Kinematic' angular_velocity='0 0.3 0' shape='Shape/Box' "
        "shape.position='0 0 -0.1' shape.half_extents='10 1 0.1'/>"
        "<component id='body' type='State/RigidBody' mass='1' position='0.5 0 0.05' linear_velocity='" +
        text(Vec3{kSpin * r, 0, -kSpin * s0}) + "' shape='Shape/Sphere' shape.radius='0.05'/>";
    // A plank of half thickness b on a cylinder of radius R, which it touches at the angle q from the top, R q from its own middle.
    constexpr double R = 1, b = 0.1, half = 1, q0 = 0.3, kRocked = 3, I = (4 * half * half + 4 * b * b) / 12;
    const auto middle = [](double q) {
        return Vec3{(R + b) * std::sin(q) - R * q * std::cos(q), 0, (R + b) * std::cos(q) + R * q * std::sin(q)};
    };
    const Path rocked = [&](double t)
    {
        return middle(integrate(
            q0, 0, t,
            [](double a, double w)
            { return -(kWeight * (R * a * std::cos(a) - b * std::sin(a)) + R * R * a * w * w) / (I + b * b + R * R * a * a); })[0]);
    };
    const std::string plank =
        "<component id='drum' type='State/Static' orientation='axis 1 0 0 90 deg' shape='Shape/Cylinder' shape.radius='1' "
        "shape.height='2'/><component id='body' type='State/RigidBody' mass='1' shape='Shape/Box' "
        "shape.half_extents='1 0.3 0.1' orientation='axis 0 1 0 0.3' position='" +
        text(middle(q0)) + "'/>";
    for (const Managed& how : kManaged)
    {
        check_order(std::string("ball ") + how.manager, face + contact(how, 0), 1.0 / 240, kEnd, slid, 1e-5);
        check_order(std::string("plank ") + how.manager, plank + contact(how, 2), 1.0 / 240, kRocked, rocked, 4e-5);
    }
}

TEST_CASE("a coin that rolls on its rim precesses at the rate at which its centre rests")
{
    // Tilted by q from the ground, radius r, half thickness k: the rim touches at r e - k n from the centre, which rests, so the spin w
    // lies along that line: w = W sin(q) (k / r n - e). With dL/dt = W z x L against the torque of the weight, W^2 = m g (r cos q - k sin
    // q) / (sin q (I1 cos q - I3 sin(q) k / r)).
    constexpr double r = 0.05, k = 0.002, mass = 0.1, kEnd = 1;
    constexpr double I1 = mass * (3 * r * r + 4 * k * k) / 12, I3 = mass * r * r / 2;
    const double q = 65 * std::numbers::pi / 180, sine = std::sin(q), cosine = std::cos(q);
    const double rate = std::sqrt(mass * kWeight * (r * cosine - k * sine) / (sine * (I1 * cosine - I3 * sine * k / r)));
    const double along_e = -rate * sine, along_n = rate * sine * k / r;
    const Vec3 spin{along_e * cosine + along_n * sine, 0, -along_e * sine + along_n * cosine}, centre{0, 0, r * sine + k * cosine};
    for (const std::string& ground : {kPlane, kBlock})
        for (const Managed& how : kManaged)
        {
            std::array<double, 2> turned{};
            for (std::size_t i = 0; i < 2; ++i)
            {
                const double h = i == 0 ? 1.0 / 1000 : 1.0 / 2000;
                Scene s(ground + "<component id='body' type='State/RigidBody' mass='" + text(mass) + "' position='" + text(centre) +
                            "' orientation='axis 0 1 0 " + text(q) + "' angular_velocity='" + text(spin) +
                            "' shape='Shape/Cylinder' shape.radius='" + text(r) + "' shape.height='" + text(2 * k) + "'/>" +
                            contact(how, 2),
                        "dt='" + text(h) + "'");
                REQUIRE_MESSAGE(s.loaded(), s.error());
                double angle = 0, before = 0;
                while (s.simulation().time() < kEnd)
                {
                    s.step();
                    const Vec3 n = rotate(s.quat("body", "orientation"), {0, 0, 1});
                    const double now = std::atan2(n.y, n.x);
                    angle += std::remainder(now - before, 2 * std::numbers::pi), before = now;
                    CHECK(length(s.vec("body", "position") - centre) < 1e-4);
                }
                turned[i] = std::fabs(angle - rate * kEnd);
            }
            MESSAGE(how.manager << " " << how.resolution << ": " << turned[0] << " rad, " << turned[1] << " rad of " << rate * kEnd);
            CHECK(turned[1] < 2e-4);
            CHECK(turned[0] > 3 * turned[1]);
        }
}
