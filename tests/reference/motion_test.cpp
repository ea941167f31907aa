// Free motion: integrators against closed forms, and their observed orders. Ids A1.. are those of the catalogue of
// reference problems; digits were computed in 113-bit arithmetic or from 30-digit closed forms.
#include "reference/motion.h"

using namespace plab;
using plab::test::attitude_error;
using plab::test::distance;
using plab::test::observed_order;
using plab::test::Scene;
using plab::test::solver;

namespace
{

std::string dt(int per_second) { return "dt=\"1/" + std::to_string(per_second) + "\""; }

/// A1: thrown at (5, 10, 0) from (0, 10, 0), two seconds.
double projectile_error(const std::string& type, int per_second)
{
    Scene s(
        solver({type}) +
            "<component id=\"ball\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 1 1\" position=\"0 10 0\" linear_velocity=\"5 10 0\"/>"
            "<component id=\"g\" type=\"Field/Gravity\" between=\"*\" acceleration=\"0 -9.81 0\"/>",
        dt(per_second));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(2);
    return distance(s.vec("ball", "position"), {10, 10 + 20 - 0.5 * 9.81 * 4, 0});
}

/// A2: a free box, attitude at t = 5.
struct BoxRun
{
    double attitude, energy, momentum;
};
BoxRun free_box(const std::string& type, int per_second)
{
    Scene s(solver({type}) +
                "<component id=\"shape\" type=\"Shape/Box\" half_extents=\"0.1 0.2 0.3\"/>"
                "<component id=\"box\" type=\"State/RigidBody\" mass=\"1\" shape=\"shape\" angular_velocity=\"1 2 3\"/>",
            dt(per_second));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const double e0 = s.simulation().totals().kinetic;
    const Vec3 l0 = s.simulation().totals().angular_momentum;
    s.run(5);
    const Quat expected{-0.36486374298686260041, 0.02356335734258868336, 0.02126200105200739735, -0.93051982491273477482};
    const auto t = s.simulation().totals();
    return {attitude_error(expected, s.quat("box", "orientation")), std::fabs(t.kinetic / e0 - 1),
            distance(t.angular_momentum, l0) / length(l0)};
}

}  // namespace

TEST_CASE("A1: a projectile is exact for Runge-Kutta and off by g dt T / 2 for semi-implicit Euler")
{
    CHECK(projectile_error("RungeKutta4", 60) < 1e-13 * 20);
    CHECK(projectile_error("SemiImplicitEuler", 60) == doctest::Approx(0.5 * 9.81 * 2 / 60).epsilon(1e-10));
    const double order = observed_order(projectile_error("SemiImplicitEuler", 60), projectile_error("SemiImplicitEuler", 120));
    CHECK(order == doctest::Approx(1).epsilon(1e-6));
}

TEST_CASE("A2: a free box rotates as given by Jacobi's closed form; orders 4 and 1; momentum to the last bit")
{
    const BoxRun coarse = free_box("RungeKutta4", 100), fine = free_box("RungeKutta4", 200), finest = free_box("RungeKutta4", 1000);
    CHECK(coarse.attitude < 1e-7);
    CHECK(finest.attitude < 1e-11);
    CHECK(coarse.energy < 1e-8);
    CHECK(coarse.momentum == 0);
    CHECK(observed_order(coarse.attitude, fine.attitude) == doctest::Approx(4).epsilon(0.03));
    const BoxRun euler = free_box("SemiImplicitEuler", 1000), euler_fine = free_box("SemiImplicitEuler", 2000);
    CHECK(observed_order(euler.attitude, euler_fine.attitude) == doctest::Approx(1).epsilon(0.05));
    CHECK(euler.momentum == 0);
}

TEST_CASE("A3: a wing nut flips at the time given by the elliptic integral")
{
    // I = (3, 2, 1), spin 10 about the middle axis: flips every 3.55072530396584808 s.
    Scene s("<component id=\"nut\" type=\"State/RigidBody\" mass=\"1\" inertia=\"3 2 1\" angular_velocity=\"1e-3 10 1e-3\"/>", dt(5000));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const auto body_spin = [&] { return rotate_back(s.quat("nut", "orientation"), s.vec("nut", "angular_velocity")); };
    double before = body_spin().y, flip = 0;
    while (s.simulation().time() < 3 && flip == 0)
    {
        s.step();
        const double now = body_spin().y;
        if (before > 0 && now <= 0) flip = s.simulation().time() - s.simulation().dt() * now / (now - before);
        before = now;
    }
    // Starting near the middle axis, the first crossing takes half an interval, less the head start given by the disturbance;
    // further crossings are one interval apart.
    REQUIRE(flip > 0);
    double second = 0;
    while (s.simulation().time() < 8 && second == 0)
    {
        s.step();
        const double now = body_spin().y;
        if (before < 0 && now >= 0) second = s.simulation().time() - s.simulation().dt() * now / (now - before);
        before = now;
    }
    CHECK(second - flip == doctest::Approx(3.55072530396584808).epsilon(1e-6 / 3.55));
    s.run(10);
    CHECK(distance(body_spin(), {9.1429206965016778e-3, -9.9999876110424964, 1.5772729522424334e-2}) < 1e-6);
}

TEST_CASE("A5: degenerate inertias move as the symmetric top does, impossible ones are refused with the component's name")
{
    SUBCASE("a sphere keeps its spin")
    {
        Scene s("<component id=\"b\" type=\"State/RigidBody\" mass=\"1\" inertia=\"2 2 2\" angular_velocity=\"1 2 3\"/>", dt(100));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(10);
        CHECK(distance(s.vec("b", "angular_velocity"), {1, 2, 3}) < 1e-13);
    }
    SUBCASE("a disc, I3 = I1 + I2")
    {
        // w1 + i w2 rotates in the body with (I3 - I1) / I1 w3 = w3.
        Scene s("<component id=\"b\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 1 2\" angular_velocity=\"1 0 2\"/>", dt(1000));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(3);
        const Vec3 w = rotate_back(s.quat("b", "orientation"), s.vec("b", "angular_velocity"));
        CHECK(distance(w, {std::cos(6.0), std::sin(6.0), 2}) < 1e-9);
    }
    SUBCASE("a rod with I3 = 1e-12 spinning at 1000 rad/s about itself")
    {
        Scene s("<component id=\"b\" type=\"State/RigidBody\" mass=\"1\" inertia=\"1 1 1e-12\" angular_velocity=\"0.1 0 1000\"/>",
                dt(100000));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(0.1);
        const Vec3 w = rotate_back(s.quat("b", "orientation"), s.vec("b", "angular_velocity"));
        // Precession in the body at (I3 - I1) / I1 w3 = -1000 rad/s.
        CHECK(distance(w, {0.1 * std::cos(-100.0), 0.1 * std::sin(-100.0), 1000}) < 1e-6);
    }
    SUBCASE("impossible ones")
    {
        const auto refusal = [](const std::string& attributes)
        { return Scene("<component id=\"b\" type=\"State/RigidBody\" " + attributes + "/>").error(); };
        CHECK(refusal("mass=\"1\" inertia=\"1 1 3\"").find("triangle") != std::string::npos);
        CHECK(refusal("mass=\"-1\" inertia=\"1 1 1\"").find("mass must be positive") != std::string::npos);
        CHECK(refusal("mass=\"nan\" inertia=\"1 1 1\"").find("mass") != std::string::npos);
        CHECK(refusal("inertia=\"1 1 1\"").find("mass") != std::string::npos);
    }
}

TEST_CASE("A8: the clock is n dt to the last bit")
{
    Scene s("", "dt=\"0.001\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(1000000);
    CHECK(s.simulation().time() == 1000.0);
    Scene sixty("", "dt=\"1/60\"");
    sixty.step(600001);
    CHECK(sixty.simulation().time() == 600001.0 / 60.0);
}
