// Pendulums, chains and tops on joints (catalogue: A4, A9, E1, E5, E6). Digits: closed forms and 113-bit integration.
#include <numbers>
#include <vector>

#include "support/joints.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kG = 9.81;
/// E1 at t = 10: where a point on a rod of 1 m is that was let go horizontally, on the side of +x.
constexpr Vec3 kPendulumAt10{.275087462576116860, 0, -.961419205099125064};

double angle_error(const Vec3& along, const Vec3& expected) { return length(cross(along, expected)) / length(along); }

/// The same motion by a point on a rod, and by bodies of (I + m l^2)/(m l) = 1 m on a ball and on a hinge.
std::string pendulum(const std::string& joint)
{
    const std::string axis = joint == "Hinge" ? " axis='0 1 0'" : "";
    if (joint == "Distance") return body("bob", "1", "1 1 1", "1 0 0") + "<component id='j' type='Constraint/Distance' b='bob'/>";
    return body("bob", "3", "0.75 0.75 0.75", "0.5 0 0") + "<component id='j' type='Constraint/" + joint + "' b='bob' anchor='0 0 0'" +
           axis + "/>";
}

struct Run
{
    double error = 0, drift = 0;
};
Run swing(const std::string& joint, const std::string& solver, int per_second)
{
    Scene s(solver_is(solver) + gravity() + pendulum(joint), dt(per_second));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    Run run;
    for (int i = 0; i < 10 * per_second; ++i)
    {
        s.step();
        run.drift = std::fmax(run.drift, s.real("j", "position_error"));
    }
    run.error = angle_error(s.vec("bob", "position"), kPendulumAt10);
    return run;
}

}  // namespace

TEST_CASE("E1: a pendulum keeps its joint to rounding and the solver its order")
{
    for (const std::string joint : {"Distance", "Ball", "Hinge"})
    {
        CAPTURE(joint);
        const Run coarse = swing(joint, "RungeKutta4", 400), fine = swing(joint, "RungeKutta4", 800);
        CAPTURE(coarse.error);
        CAPTURE(fine.error);
        CHECK(coarse.drift < 1e-14);
        CHECK(fine.drift < 1e-14);
        const double order = std::log2(coarse.error / fine.error);
        CHECK(order > 3.8);
        CHECK(order < 4.6);
        CHECK(fine.error < 1e-8);
        const double first = std::log2(swing(joint, "SemiImplicitEuler", 2000).error / swing(joint, "SemiImplicitEuler", 4000).error);
        CHECK(first > 0.8);
        CHECK(first < 1.4);
    }
    CHECK(swing("Hinge", "RungeKutta4", 2000).error < 1e-11);
}

TEST_CASE("A9: a double pendulum of two points on rods")
{
    const auto ends = [](int per_second, double t)
    {
        Scene s(solver_is("RungeKutta4") + gravity() + body("p", "1", "1 1 1", "1 0 0") + body("q", "1", "1 1 1", "2 0 0") +
                    joint("j1", "Distance", "", "p", "") + joint("j2", "Distance", "p", "q", ""),
                dt(per_second));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(t);
        const Vec3 p = s.vec("p", "position"), q = s.vec("q", "position") - p;
        return std::array{std::atan2(p.x, -p.z), std::atan2(q.x, -q.z)};
    };
    const auto at1 = ends(1000, 1);
    CHECK(near(at1[0], -.62508769980630629954, 1e-9));
    CHECK(near(at1[1], -1.0345850856800123406, 1e-9));
    const auto at5 = ends(10000, 5);
    CHECK(near(at5[0], -.62718670506653073014, 1e-9));
    CHECK(near(at5[1], -1.3013155502098116779, 1e-9));
    MESSAGE("errors at 5 s: ", at5[0] + .62718670506653073014, " ", at5[1] + 1.3013155502098116779);
}

TEST_CASE("A4: Lagrange's top on a ball joint")
{
    // Inertia about the pivot: .0045, .0045, .0008; the centre of mass is .05 m up the axis.
    const double half = 0.25;
    const auto axis_at = [&](const std::string& solver, int per_second, double t)
    {
        const std::string tilt = text(std::cos(half)) + " " + text(std::sin(half)) + " 0 0";
        const Vec3 up{0, -std::sin(2 * half), std::cos(2 * half)};
        Scene s(solver_is(solver) + gravity() +
                    body("top", 1, {.0045 - .0025, .0045 - .0025, .0008}, .05 * up,
                         "orientation='" + tilt + "' angular_velocity='" + text(200 * up) + "'") +
                    joint("j", "Ball", "", "top", "anchor='0 0 0'"),
                dt(per_second));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(t);
        return rotate(s.quat("top", "orientation"), Vec3{0, 0, 1});
    };
    const Vec3 at01{.17859775484183078, -.54105459446217256, .82180458004128409},
        at1{-.14403481426920192, .50007981101234838, .85391694847701110};
    const double coarse = distance(axis_at("RungeKutta4", 1000, .1), at01), fine = distance(axis_at("RungeKutta4", 2000, .1), at01);
    const double late = distance(axis_at("RungeKutta4", 1000, 1), at1);
    MESSAGE("errors ", coarse, " ", fine, " ", late);
    CHECK(coarse < 1e-6);
    CHECK(std::log2(coarse / fine) > 3.7);
    CHECK(late < 1e-4);
    CHECK(distance(axis_at("RungeKutta4", 4000, 1), at1) < 1e-6);
}

TEST_CASE("E5: a chain of 100 links bears a ball of a tonne")
{
    // Points on rods of 0.1 m: what each bears is the weight below it.
    std::string parts = solver_is("RungeKutta4") + gravity();
    const auto id = [](int i) { return "p" + std::to_string(1000 + i); };
    for (int i = 0; i <= 100; ++i)
    {
        parts += body(id(i), i == 100 ? 1000 : 1, {1, 1, 1}, {0, 0, -.1 * (i + 1)});
        parts += joint("j" + id(i), "Distance", i == 0 ? "" : id(i - 1), id(i), "");
    }
    Scene s(parts, dt(60));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(5);
    for (int i = 0; i <= 100; ++i)
    {
        CAPTURE(i);
        CHECK(near(length(s.vec("j" + id(i), "force")), (1100 - i) * kG, 1e-11));
        CHECK(std::fabs(s.real("j" + id(i), "distance") - .1) < 1e-14);
    }
    CHECK(std::fabs(s.vec(id(100), "position").z + 10.1) < 1e-12);
}

TEST_CASE("E6: the modes of a hanging chain are zeros of Laguerre's polynomial")
{
    // Ten points 0.1 m apart, put into one mode: it comes back after a period. Amplitude 1e-5 rad: frequencies shift by its square.
    constexpr int n = 10;
    constexpr double a = .1;
    for (const double w : {3.67662065761785, 8.45928432589076, 13.3191005199572})
    {
        // From the free end up: g/a ((k+1)(x_k - x_{k+1}) - k (x_{k-1} - x_k)) = w^2 x_k.
        double x[n + 1] = {1};
        for (int k = 0; k < n; ++k) x[k + 1] = x[k] - (w * w * a / kG * x[k] + (k == 0 ? 0 : k * (x[k - 1] - x[k]))) / (k + 1);
        std::string parts = solver_is("RungeKutta4") + gravity();
        double above = 0, z = 0;
        for (int k = n - 1; k >= 0; --k)
        {
            const double here = 1e-5 * x[k], across = here - above;
            z -= std::sqrt(a * a - across * across);
            const std::string id = "p" + std::to_string(20 - k), before = k == n - 1 ? "" : "p" + std::to_string(19 - k);
            parts += body(id, 1, {1, 1, 1}, {here, 0, z}) + joint("j" + id, "Distance", before, id, "");
            above = here;
        }
        const int steps = 400;
        Scene s(parts, "dt='" + text(2 * std::numbers::pi / w / steps) + "'");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.step(steps);
        CAPTURE(w);
        for (int k = 0; k < n; ++k) CHECK(std::fabs(s.vec("p" + std::to_string(20 - k), "position").x - 1e-5 * x[k]) < 1e-10);
        // At rest again, to the second order of the error in w.
        CHECK(length(s.vec("p20", "linear_velocity")) < 1e-5 * w * 1e-4);
    }
}
