// Rolling without slipping on spheres and cylinders, outside and inside (rolling.h), against closed forms.
//
//   a ball of radius r on a fixed ball of radius R:      theta'' = 5/7 g sin theta / (R + r)
//   a ball, a cylinder across the bottom of a cylinder:  theta'' = -5/7, -2/3 g sin theta / (R - r)
//   a ball in an upright cylinder, round at W rad/s:     z'' = -2/7 W^2 z - 2/7 W r w_N - 5/7 g: it does not fall down (Neimark,
//                                                        Fufaev), but swings sqrt(2/7) times for each time round; w_N: spin about
//                                                        the radius where z = 0
#include <numbers>

#include "exact/motions.h"
#include "support/gravity.h"
#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

std::string rolling(const std::string& more) { return "<component id='rolls' type='Constraint/Rolling' b='ball' " + more + "/>"; }
std::string ball(const Vec3& p, double radius, const Vec3& v = {}, const Vec3& w = {}, double share = 0.4)
{
    const std::string i = text(share * 2 * radius * radius);
    return body("ball", "2", i + " " + i + " " + i, text(p), "linear_velocity='" + text(v) + "' angular_velocity='" + text(w) + "'");
}

/// theta'' = factor sin theta from rest: classical Runge-Kutta with a mantissa of 64 bits and steps of 1e-4 s.
double angle_after(double theta, double factor, double until)
{
    long double x = theta, u = 0;
    const int n = static_cast<int>(std::lround(until * 1e4));
    const long double h = static_cast<long double>(until) / n;
    const auto f = [&](long double y) { return factor * sinl(y); };
    for (int i = 0; i < n; ++i)
    {
        const long double k1 = f(x), k2 = f(x + h / 2 * u), k3 = f(x + h / 2 * u + h * h / 4 * k1), k4 = f(x + h * u + h * h / 2 * k2);
        x += h * u + h * h / 6 * (k1 + k2 + k3), u += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    return static_cast<double>(x);
}
double energy(const Scene& s)
{
    const Bodies& bodies = s.simulation().world().host().bodies;
    return bodies.kinetic_energy(0) + kG * bodies.mass[0] * bodies.position[0].z;
}
}  // namespace

TEST_CASE("a ball rolls down a ball with 5/7 g sin theta / (R + r)")
{
    const double R = 0.5, r = 0.1, start = 0.2;
    Scene s(solver_is("RungeKutta4") + gravity() + ball((R + r) * Vec3{std::sin(start), 0, std::cos(start)}, r) +
                rolling("semi_axes='0.1 0.1 0.1' on='sphere' radius='0.5' point='0 0 0'"),
            dt(1000));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    const double before = energy(s);
    for (const double t : {0.3, 0.8})
    {
        s.run(t);
        const double theta = angle_after(start, 5. / 7 * kG / (R + r), s.simulation().time());
        CHECK(distance(s.vec("ball", "position"), (R + r) * Vec3{std::sin(theta), 0, std::cos(theta)}) < 1e-11);
        // m (g cos theta - v^2 / (R + r))
        const double v2 = length_squared(s.vec("ball", "linear_velocity"));
        CHECK(std::fabs(s.real("rolls", "normal_force") - 2 * (kG * std::cos(theta) - v2 / (R + r))) < 1e-6);
        CHECK(std::fabs(energy(s) - before) < 2e-10);
        CHECK(s.real("rolls", "position_error") < 1e-15);
        CHECK(s.real("rolls", "speed_error") < 1e-14);
    }
}

TEST_CASE("a cylinder swings in a cylinder with 2/3 g sin theta / (R - r), a ball with 5/7: whole periods")
{
    const double R = 0.6, r = 0.1, start = 1;
    struct Kind
    {
        double inertia, factor;
        const char* more;
    };
    for (const Kind& k : {Kind{0.5, 2. / 3, "parallel='true'"}, {0.4, 5. / 7, ""}})
    {
        CAPTURE(k.factor);
        const double period = 2 * exact::PendulumMotion(std::sqrt(k.factor * kG / (R - r)), start, 0).time_of_turn();
        Scene s(solver_is("RungeKutta4") + gravity() + ball((R - r) * Vec3{std::sin(start), 0, -std::cos(start)}, r, {}, {}, k.inertia) +
                    rolling("semi_axes='0.1 0.1 0.1' on='cylinder' radius='0.6' inside='true' axis='0 1 0' point='0 3 0' " +
                            std::string(k.more)),
                "dt=\"" + text(period / 1000) + "\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        const double before = energy(s);
        for (int i = 0; i < 3000; ++i) s.step();
        CHECK(distance(s.vec("ball", "position"), (R - r) * Vec3{std::sin(start), 0, -std::cos(start)}) < 1e-10);
        CHECK(length(s.vec("ball", "linear_velocity")) < 2e-9);
        CHECK(std::fabs(energy(s) - before) < 1e-10);
    }
}

TEST_CASE("solvers keep their order on the inside of a sphere")
{
    const auto at = [](const std::string& solver, int per_second)
    {
        const double r = 0.1, R = 0.6;
        // Also sideways, with spin: not in one plane.
        const Vec3 n{std::sin(1.0), 0, -std::cos(1.0)}, v{0, 1.2, 0};
        const Vec3 w = cross(r * n, v) / (-r * r) + 3 * n;  // v + w x (r n) = 0
        Scene s(solver_is(solver) + gravity() + ball((R - r) * n, r, v, w) +
                    rolling("semi_axes='0.1 0.1 0.1' on='sphere' radius='0.6' inside='true' point='0 0 0'"),
                dt(per_second));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(1);
        return s.vec("ball", "position");
    };
    const Vec3 exact = at("RungeKutta4", 8000);
    for (const auto& [solver, order] :
         {std::pair{std::string("SemiImplicitEuler"), 1}, {"StoermerVerlet", 2}, {"ImplicitMidpoint", 2}, {"RungeKutta4", 4}})
    {
        const int n = order == 4 ? 200 : 1000;
        const double p = std::log2(distance(at(solver, n), exact) / distance(at(solver, 2 * n), exact));
        MESSAGE(solver, " has order ", p);
        CHECK(std::fabs(p - order) < .2);
    }
}

TEST_CASE("a ball that circles in an upright cylinder oscillates up and down")
{
    const double R = 0.6, r = 0.1, rho = R - r, W = 10, w_N = 4;
    // v = rho W along phi; v + w x (r N) = 0: w_z = -rho W / r.
    Scene s(solver_is("RungeKutta4") + gravity() + ball({rho, 0, 0}, r, {0, rho * W, 0}, {w_N, 0, -rho * W / r}) +
                rolling("semi_axes='0.1 0.1 0.1' on='cylinder' radius='0.6' inside='true' axis='0 0 1' normal='-1 0 0'"),
            dt(2000));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(2);
    const double nu = std::sqrt(2. / 7) * W, middle = -(2. / 7 * W * r * w_N + 5. / 7 * kG) / (nu * nu);
    const Vec3 due{rho * std::cos(2 * W), rho * std::sin(2 * W), middle * (1 - std::cos(2 * nu))};
    CHECK(distance(s.vec("ball", "position"), due) < 1e-9);
}

TEST_CASE("a ball rolls on a ball with a prescribed rotation and is carried along")
{
    // On top of a ball that turns about z, with n along z: n'' = 0, so it stays there and spins along.
    Scene s(solver_is("RungeKutta4") + gravity() + "<component id='globe' type='State/Kinematic' angular_velocity='0 0 2'/>" +
                ball({0, 0, 0.6}, 0.1) + rolling("a='globe' semi_axes='0.1 0.1 0.1' on='sphere' radius='0.5' point='0 0 0'"),
            dt(500));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(1);
    CHECK(distance(s.vec("ball", "position"), {0, 0, 0.6}) < 1e-14);
    CHECK(near(s.real("rolls", "normal_force"), 2 * kG, 1e-13));
}

TEST_CASE("shapes that cannot roll in this way are refused")
{
    const auto error = [](const std::string& more) { return Scene(gravity() + ball({0, 0, 0.6}, 0.1) + rolling(more), dt(100)).error(); };
    CHECK(error("semi_axes='0.1 0.2 0.1' on='sphere' radius='1'").find("only a ball can roll") != std::string::npos);
    CHECK(error("semi_axes='0.1 0.1 0.1' on='cylinder'").find("the parameter radius must be above 0") != std::string::npos);
    CHECK(error("semi_axes='0.1 0.1 0.1' on='sphere' radius='0.05' inside='true'").find("must be smaller") != std::string::npos);
    CHECK(error("semi_axes='0.1 0.1 0.1' parallel='true'").find("parallel requires") != std::string::npos);
    CHECK(error("semi_axes='0.1 0.1 0.1' on='cone' radius='1'").find("cylinder") != std::string::npos);
}
