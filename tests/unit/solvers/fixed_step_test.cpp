/// Fixed-step solvers on systems with known solutions: observed orders, invariants, free rotation through the exponential map.
#include "objects/solvers/fixed_step.h"
#include "objects/solvers/rotation_splitting.h"
#include "plab/plugin.h"
#include "unit/solvers/problems.h"

using namespace plab;
using namespace plab::solvers;
using namespace plab::test;

extern "C" void plab_plugin_register(plab::Registrar& registrar);

namespace
{

template <class Rows>
Advance fixed(void (*command)(const StepContext&, Row, const Rows&, DynamicSystem&))
{
    return [command](double h, DynamicSystem& system)
    {
        StepContext context;
        context.dt = h;
        command(context, 0, {}, system);
    };
}
const Advance advance_euler = fixed(advance_semi_implicit_euler), advance_rk4 = fixed(advance_runge_kutta4),
              advance_verlet = fixed(advance_stoermer_verlet);
Advance splitting(int order)
{
    return [order](double h, DynamicSystem& system) { advance_by_splitting(h, order, system); };
}

/// Of q'' = -q + cos(2 t)/2 at t = 3; stage times matter.
double driven_error(const Advance& advance, int steps)
{
    Points p = driven_oscillator();
    p.run(3.0 / steps, steps, advance);
    CHECK(p.booked == doctest::Approx(steps).epsilon(1e-12));  // the ledger's weights in each step add up to 1
    return std::fabs(p.place[0] - driven_place(3));
}
double driven_order(const Advance& advance, int steps)
{
    return std::log2(driven_error(advance, steps) / driven_error(advance, 2 * steps));
}

}  // namespace

TEST_CASE("semi-implicit Euler is of order 1, classical Runge-Kutta of order 4")
{
    for (const int steps : {80, 160})
    {
        CHECK(std::fabs(driven_order(advance_euler, 8 * steps) - 1) < 0.05);
        CHECK(std::fabs(driven_order(advance_rk4, steps) - 4) < 0.05);
    }
}

TEST_CASE("semi-implicit Euler uses the new speed, Runge-Kutta gives the exact parabola")
{
    Points euler({0}, {2}, [](double, const auto&, const auto&, auto& a) { a[0] = -10; });
    Points rk4 = euler;
    advance_euler(0.5, euler);
    CHECK(euler.speeds()[0] == -3);
    CHECK(euler.coordinates()[0] == -1.5);
    advance_rk4(0.5, rk4);
    CHECK(rk4.speeds()[0] == doctest::Approx(-3).epsilon(1e-15));
    CHECK(rk4.coordinates()[0] == doctest::Approx(2 * 0.5 - 0.5 * 10 * 0.25).epsilon(1e-14));
}

TEST_CASE("a free box rotates according to Euler's equations")
{
    Body coarse(diagonal(kBoxInertia), kBoxSpin), fine(diagonal(kBoxInertia), kBoxSpin);
    const Vec3 L = coarse.momentum();
    coarse.run(0.01, 500, advance_rk4);
    fine.run(0.001, 5000, advance_rk4);
    const double coarse_error = attitude_error(coarse.orientation, kBoxAt5);
    const double fine_error = attitude_error(fine.orientation, kBoxAt5);
    MESSAGE("attitude error at t = 5: " << coarse_error << " rad at h = 0.01, " << fine_error << " rad at 0.001");
    CHECK(coarse_error < 1e-7);
    CHECK(fine_error < 1e-11);
    CHECK(coarse_error / fine_error == doctest::Approx(1e4).epsilon(0.1));
    CHECK(length(fine.spin_B() - kBoxSpinAt5) < 2e-11);
    CHECK(coarse.momentum() == L);
    CHECK(coarse.spin_energy() == doctest::Approx(0.49 / 3).epsilon(1e-8));
}

TEST_CASE("semi-implicit Euler rotates a free box with order 1")
{
    const auto error = [](double h, int steps)
    {
        Body box(diagonal(kBoxInertia), kBoxSpin);
        box.run(h, steps, advance_euler);
        return attitude_error(box.orientation, kBoxAt5);
    };
    CHECK(std::log2(error(1e-4, 50000) / error(5e-5, 100000)) == doctest::Approx(1).epsilon(0.05));
}

TEST_CASE("an unstable spin flips at the right time")
{
    // Dzhanibekov: I = (3, 2, 1), spin 10 about the middle axis, 1e-3 off it; state at t = 10 in closed form.
    // The error grows by e^5.8 per second near the axis: the flips are where a wrong gyroscopic term shows first.
    const auto error = [](double h, int steps)
    {
        Body wing(Mat3::diagonal(3, 2, 1), {1e-3, 10, 1e-3});
        wing.run(h, steps, advance_rk4);
        const Vec3 expected{9.1429206965016778e-3, -9.9999876110424964, 1.5772729522424334e-2};
        return length(wing.spin_B() - expected);
    };
    CHECK(error(1e-3, 10000) < 2e-5);
    CHECK(error(2e-4, 50000) < 1e-7);
}

TEST_CASE("degenerate tops: a ball keeps its spin, a disc and a rod precess at the right rate")
{
    Body ball(Mat3::diagonal(0.4, 0.4, 0.4), {1, 2, 3});
    ball.run(0.01, 1000, advance_rk4);
    CHECK(length(ball.spin_B() - Vec3{1, 2, 3}) < 1e-13);

    // Symmetric top: w1 + i w2 turns at (I3 - I1)/I1 w3 in the body.
    const auto top_error = [](double i3, double w3)
    {
        Body top(Mat3::diagonal(1, 1, i3), {0.1, 0, w3});
        top.run(1e-4, 10000, advance_rk4);
        const double rate = (i3 - 1) * w3;
        const Vec3 w = top.spin_B();
        return std::fmax(std::fabs(w.x - 0.1 * std::cos(rate)), std::fabs(w.y - 0.1 * std::sin(rate)));
    };
    CHECK(top_error(2, 5) < 1e-13);
    CHECK(top_error(1e-4, 5) < 1e-12);
}

TEST_CASE("the exponential map and its differential agree across their series and closed forms")
{
    for (const double angle : {0.0, 1e-9, 1e-4, 0.3, 0.4999999, 0.5000001, 1.0, 3.0})
    {
        const Vec3 u = normalized(Vec3{1, -2, 3}) * angle;
        const Vec3 w{0.3, 0.7, -0.2};
        CAPTURE(angle);
        CHECK(norm(exp_rotation(u)) == doctest::Approx(1).epsilon(1e-15));
        CHECK(length(log_rotation(exp_rotation(u)) - u) < 1e-14);
        // q0 exp(u(t)) with u' = rate(u, w) turns at w: compare exp(u + d u') with exp(u) exp(d w).
        const double d = 1e-4;
        const Vec3 rate = rotation_vector_rate(u, w);
        const Vec3 ahead = log_rotation(exp_rotation(u) * exp_rotation(w * d));
        const Vec3 behind = log_rotation(exp_rotation(u) * exp_rotation(w * -d));
        if (angle < 2.5) CHECK(length((ahead - behind) / (2 * d) - rate) < 1e-8);
    }
}

TEST_CASE("Stoermer-Verlet and both splittings have their orders, with driving, drag and turning torques")
{
    for (const int steps : {40, 80})
    {
        CHECK(driven_order(advance_verlet, steps) == doctest::Approx(2).epsilon(0.02));
        CHECK(driven_order(splitting(2), steps) == doctest::Approx(2).epsilon(0.02));
        CHECK(driven_order(splitting(4), steps) == doctest::Approx(4).epsilon(0.02));
    }
    const auto drag_error = [](const Advance& advance, int steps)
    {
        Points p = falling_with_drag();
        p.run(5.0 / steps, steps, advance);
        return std::fmax(std::fabs(p.speed() - kDragSpeedAt5), std::fabs(p.place[0] - kDragPlaceAt5));
    };
    CHECK(order_of([&](int n) { return drag_error(advance_verlet, n); }, 80) == doctest::Approx(2).epsilon(0.03));
    CHECK(order_of([&](int n) { return drag_error(splitting(2), n); }, 80) == doctest::Approx(2).epsilon(0.03));
    CHECK(order_of([&](int n) { return drag_error(splitting(4), n); }, 20) == doctest::Approx(4).epsilon(0.05));
    CHECK(drag_error(splitting(4), 500) < 1e-11);
}

TEST_CASE("a box under a torque that depends on time, attitude and spin: every algorithm keeps its order")
{
    const auto law = [](double t, const Body& b)
    {
        const Vec3 spin_W = rotate(b.attitude(), b.spin_B());
        return Body::Load{Vec3{0, 0, -9.81} - 0.1 * b.velocity(), Vec3{0.02 * std::cos(3 * t), 0, 0} - 0.01 * spin_W +
                                                                      0.05 * cross(rotate(b.attitude(), {0, 0, 1}), Vec3{0, 1, 0})};
    };
    const auto end = [&](const Advance& advance, int steps)
    {
        Body b(diagonal(kBoxInertia), kBoxSpin, law);
        b.run(1.0 / steps, steps, advance);
        return b.orientation;
    };
    const Quat truth = end(advance_rk4, 4000);
    const auto order = [&](const Advance& advance, int steps)
    { return order_of([&](int n) { return attitude_error(end(advance, n), truth); }, steps); };
    CHECK(order(advance_euler, 400) == doctest::Approx(1).epsilon(0.05));
    CHECK(order(advance_verlet, 80) == doctest::Approx(2).epsilon(0.05));
    CHECK(order(splitting(2), 80) == doctest::Approx(2).epsilon(0.05));
    CHECK(order(splitting(4), 20) == doctest::Approx(4).epsilon(0.08));
    CHECK(order(advance_rk4, 40) == doctest::Approx(4).epsilon(0.05));
}

TEST_CASE("splitting conserves the momentum of a free box to the last bit, and its energy over a long time")
{
    for (const double h : {0.01, 0.05, 0.1, 0.4})
    {
        CAPTURE(h);
        Body strang(diagonal(kBoxInertia), kBoxSpin), fourth(diagonal(kBoxInertia), kBoxSpin);
        const Vec3 L = strang.momentum();
        const double energy = strang.spin_energy();
        double worst2 = 0, worst4 = 0;
        for (int i = 0; i < 20000; ++i)
        {
            strang.run(h, 1, splitting(2)), fourth.run(h, 1, splitting(4));
            worst2 = std::fmax(worst2, std::fabs(strang.spin_energy() / energy - 1));
            worst4 = std::fmax(worst4, std::fabs(fourth.spin_energy() / energy - 1));
        }
        CHECK(strang.momentum() == L);
        CHECK(fourth.momentum() == L);
        CHECK(worst2 < 0.4 * h * h);
        CHECK(worst4 < 0.1 * h * h * h * h + 1e-12);
    }
}

TEST_CASE("splitting rotates the free box with orders 2 and 4")
{
    const auto error = [](int order, double h, int steps)
    {
        Body box(diagonal(kBoxInertia), kBoxSpin);
        box.run(h, steps, splitting(order));
        return attitude_error(box.orientation, kBoxAt5);
    };
    MESSAGE("attitude error at t = 5, h = 0.01: order 2 " << error(2, 0.01, 500) << " rad, order 4 " << error(4, 0.01, 500)
                                                          << " rad; h = 0.001: " << error(2, 1e-3, 5000) << ", " << error(4, 1e-3, 5000));
    CHECK(error(2, 0.01, 500) < 6e-5);
    CHECK(error(4, 0.01, 500) < 1e-7);
    CHECK(error(2, 0.02, 250) / error(2, 0.01, 500) == doctest::Approx(4).epsilon(0.02));
    CHECK(error(4, 0.05, 100) / error(4, 0.025, 200) == doctest::Approx(16).epsilon(0.05));
}

TEST_CASE("an oscillator's energy error stays bounded, without a slope")
{
    for (const Advance& advance : {advance_verlet, splitting(2), splitting(4)})
    {
        Points p({1}, {0}, [](double, const auto& q, const auto&, auto& a) { a[0] = -q[0]; });
        double first = 0, second = 0;
        for (int i = 0; i < 200000; ++i)
        {
            p.run(0.1, 1, advance);
            const double e = p.speed() * p.speed() + p.place[0] * p.place[0] - 1;
            (i < 100000 ? first : second) += e / 100000;
        }
        CHECK(std::fabs(second - first) < 1e-6);
        CHECK(std::fabs(second) < 2e-3);
    }
}

TEST_CASE("kicks by constant forces give the parabola, and their work is the change of energy")
{
    for (const Advance& advance : {advance_verlet, splitting(2), splitting(4)})
    {
        Body b(diagonal(kBoxInertia), {0, 0, 0});
        b.gravity = {0, 0, -9.81};
        b.position = {0, 10, 0}, b.set_velocity({5, 0, 10});
        b.run(1.0 / 60, 120, advance);
        CHECK(length(b.position - Vec3{10, 10, 20 - 0.5 * 9.81 * 4}) < 1e-12);
        CHECK(b.work == doctest::Approx(-9.81 * b.position.z).epsilon(1e-12));
    }
}

TEST_CASE("a needle keeps its fast spin with every splitting")
{
    // A rod, 1e-12 kg m^2 about its axis at 1000 rad/s: the momentum could not represent that spin.
    Body rod(Mat3::diagonal(1, 1, 1e-12), {0.1, 0, 1e3}, {}, true);
    rod.run(1e-4, 10000, splitting(4));
    const double rate = (1e-12 - 1) * 1e3;  // of the transverse spin in the body
    const Vec3 w = rod.spin_B();
    CHECK(w.z == doctest::Approx(1e3).epsilon(1e-11));
    CHECK(std::hypot(w.x - 0.1 * std::cos(rate), w.y - 0.1 * std::sin(rate)) < 2e-9);
}

TEST_CASE("a needle that spins across its length rotates like a symmetric top, with every splitting")
{
    // I = (1e-12, 1, 1), 10 rad/s about z: the momentum is fixed, so the needle sweeps a cone about it.
    const Mat3 inertia = Mat3::diagonal(1e-12, 1, 1);
    const Vec3 w{0.1, 0.1, 10};
    for (const int order : {2, 4})
    {
        Body needle(inertia, w, {}, true);
        needle.run(1.0 / 60, 600, splitting(order));
        CHECK(length(needle.momentum() - inertia * w) < 1e-11);
        CHECK(length(needle.spin_B()) == doctest::Approx(length(w)).epsilon(1e-10));
        // The same motion with a torque that is 0, so that it is kicked.
        Body kicked(
            inertia, w,
            [](double, const Body& b) {
                return Body::Load{-1.0 * b.place(), {}};
            },
            true);
        kicked.run(1.0 / 60, 600, splitting(order));
        CHECK(attitude_error(kicked.orientation, needle.orientation) < 1e-9);
    }
}

TEST_CASE("the plugin declares the ladder")
{
    Registrar registrar;
    plab_plugin_register(registrar);
    const auto find = [&](const std::string& name)
    {
        for (const TypeInfo& type : registrar.types())
            if (type.name == "Solver/" + name) return &type;
        FAIL("no type Solver/" << name);
        return static_cast<const TypeInfo*>(nullptr);
    };
    CHECK(registrar.types().size() == 11);
    for (const auto& [name, order] : {std::pair{"SemiImplicitEuler", 1},
                                      {"StoermerVerlet", 2},
                                      {"RungeKutta4", 4},
                                      {"RotationSplitting", 4},
                                      {"Exact", 4},
                                      {"DormandPrince54", 5},
                                      {"ImplicitMidpoint", 2},
                                      {"Radau5", 5},
                                      {"Exponential", 4},
                                      {"Automatic", 4}})
        CHECK(find(name)->order == order);
    for (const TypeInfo& type : registrar.types())
    {
        CAPTURE(type.name);
        const bool fixed_step =
            type.name == "Solver/SemiImplicitEuler" || type.name == "Solver/StoermerVerlet" || type.name == "Solver/RungeKutta4";
        CHECK(type.elementwise == fixed_step);
        CHECK(type.family == "Solver");
        CHECK(type.commands.back().name == "Solver/Advance");
        CHECK(type.commands.back().phase == Phase::Advance);
        CHECK(!type.cost.empty());
        CHECK(!type.limits.empty());
        CHECK(!type.source.empty());
    }
}
