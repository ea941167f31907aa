/// Solver/Automatic: its rule, and the bits of the solver that it picks.
#include "objects/solvers/automatic.h"
#include "objects/solvers/stiffness.h"
#include "unit/solvers/problems.h"

using namespace plab;
using namespace plab::solvers;
using namespace plab::test;

namespace
{

struct Automatic : Solver<AutomaticRows>
{
    Automatic() : Solver(advance_automatic) {}
    std::string resolved() const { return rows.resolved[0]; }
};

void rk4(double h, DynamicSystem& system) { advance_by_runge_kutta4(h, system); }

Body::Law light_drag()
{
    return [](double, const Body& b) { return Body::Load{-0.1 * b.velocity(), -0.001 * rotate(b.attitude(), b.spin_B())}; };
}

Stiffness measured(FakeSystem& system, double h)
{
    StageSlopes slopes(system);
    find_slopes(h, system, slopes);
    return stiffness_of(system, h, slopes);
}

/// m = 1 on k = 1e6, and in the same group a large slow motion.
Points hidden_spring(double moved)
{
    return Points({moved, 5}, {0, 3}, [](double, const auto& q, const auto&, auto& a) { a[0] = -1e6 * q[0], a[1] = -9.81 - 4 * q[1]; });
}

}  // namespace

TEST_CASE("stiffness is estimated from slopes: of springs by frequency, of dampers by rate, whatever the units")
{
    for (const double k : {1e4, 1e6, 1e8, 1e12})
    {
        Points spring = damped_spring(k, 0.05);
        const double ratio = measured(spring, 0.01).value / (0.01 * std::sqrt(k));
        CHECK(ratio > 0.7);
        CHECK(ratio < 1.5);
    }
    Points drag({0}, {3}, [](double, const auto&, const auto& v, auto& a) { a[0] = -1e6 * v[0]; });
    CHECK(measured(drag, 0.01).value == doctest::Approx(1e4).epsilon(0.05));
    Points chain({0.1, 0, 0}, {0, 0, 0},
                 [](double, const auto& q, const auto&, auto& a)
                 { a[0] = -1e6 * (q[0] - q[1]), a[1] = -1e6 * (2 * q[1] - q[0] - q[2]), a[2] = -1e6 * (q[2] - q[1]); });
    CHECK(measured(chain, 0.01).too_much);
    Points soft_chain({0.1, 0, 0}, {0, 0, 0},
                      [](double, const auto& q, const auto&, auto& a)
                      { a[0] = -(q[0] - q[1]), a[1] = -(2 * q[1] - q[0] - q[2]), a[2] = -(q[2] - q[1]); });
    CHECK(!measured(soft_chain, 0.1).too_much);
    Points free({0}, {3}, [](double, const auto&, const auto&, auto& a) { a[0] = -9.81; });
    CHECK(measured(free, 0.01).value == 0);
    Amounts reaction({1, 0}, [](double, const auto& z, auto& r) { r[0] = -1e5 * z[0], r[1] = 1e5 * z[0]; });
    CHECK(measured(reaction, 1).value == doctest::Approx(1e5).epsilon(0.1));
}

TEST_CASE("a stiff member is detected beside larger motions, and rounding is not taken for stiffness")
{
    Points hidden = hidden_spring(1e-7);
    CHECK(measured(hidden, 0.01).too_much);
    // At rest far from the origin: the slopes show the rounding of positions.
    Points rest({1e6}, {0}, [](double, const auto& q, const auto&, auto& a) { a[0] = -100 * (q[0] - 1e6) - 1e-14 * q[0]; });
    CHECK(!measured(rest, 0.01).too_much);
}

TEST_CASE("soft and slow groups get the bits of RungeKutta4 at its cost, without a message")
{
    Automatic automatic;
    Points a = driven_oscillator(), b = driven_oscillator();
    a.run(0.01, 200, std::ref(automatic)), b.run(0.01, 200, rk4);
    CHECK(a.place == b.place);
    CHECK(a.speed() == b.speed());
    CHECK(a.work == b.work);
    CHECK(automatic.resolved() == "RungeKutta4");
    CHECK(automatic.events.all.empty());
    CHECK(a.evaluations == b.evaluations + 4);  // the first step is examined before it is made
    Automatic slow;
    Body c(diagonal(kBoxInertia), {1, 2, 3}, light_drag()), d(diagonal(kBoxInertia), {1, 2, 3}, light_drag());
    c.run(0.01, 100, std::ref(slow)), d.run(0.01, 100, rk4);
    CHECK(c.orientation == d.orientation);
    CHECK(slow.resolved() == "RungeKutta4");
    CHECK(slow.rows.spin[0] == doctest::Approx(0.037).epsilon(0.1));
}

TEST_CASE("free flight uses Exact, fast spin RotationSplitting, stiff springs Exponential, stiff reactions Radau5")
{
    Automatic a, b, c, d;
    Body free(diagonal(kBoxInertia), kBoxSpin);
    free.run(0.5, 10, std::ref(a));
    CHECK(a.resolved() == "Exact");
    CHECK(attitude_error(free.orientation, kBoxAt5) < 1e-12);

    Body fast(diagonal(kBoxInertia), {10, 20, 30}, light_drag());
    fast.run(0.01, 10, std::ref(b));
    CHECK(b.resolved() == "RotationSplitting");
    CHECK(b.events.count("solver.chosen") == 1);
    CHECK(b.events.all[0].message == "RotationSplitting: h |w| = 0.37 is above 0.05");

    Points spring = damped_spring(1e6, 0.05);
    spring.run(0.01, 30, std::ref(c));
    CHECK(c.resolved() == "Exponential");
    CHECK(std::fabs(spring.place[0] - damped_place(1e6, 0.05, 0.3)) < 1e-12);
    CHECK(spring.work == doctest::Approx(0.5 * spring.speed() * spring.speed()).epsilon(1e-9).scale(0.5e6));
    CHECK(spring.booked == doctest::Approx(30).epsilon(1e-12));

    Amounts reaction({2, 0}, [](double, const auto& y, auto& f) { f[0] = y[1], f[1] = ((1 - y[0] * y[0]) * y[1] - y[0]) / 1e-6; });
    reaction.run(0.5, 4, std::ref(d));
    CHECK(d.resolved().find("Radau5") != std::string::npos);
    CHECK(reaction[0] == doctest::Approx(0.1706167732170483e1).epsilon(1e-8));
}

TEST_CASE("a script that pushes back from both sides of a line slides along it, at a bounded cost")
{
    // |a| = 20 towards the line q + v / 5 = 0, which is reached at kMeets and then followed: q' = -5 q.
    const double kMeets = (-4 + std::sqrt(4 * 4 + 4 * 10 * 0.3)) / 20;
    Automatic automatic;
    Points slider({0.3}, {0}, [](double, const auto& q, const auto& v, auto& a) { a[0] = q[0] + 0.2 * v[0] > 0 ? -20 : 20; });
    int most = 0;
    for (int step = 0; step < 240; ++step)
    {
        const int before = slider.evaluations;
        slider.run(1.0 / 240, 1, std::ref(automatic));
        most = std::max(most, slider.evaluations - before);
    }
    const double exact = (0.3 - 10 * kMeets * kMeets) * std::exp(-5 * (1 - kMeets));
    MESSAGE("error ", std::fabs(slider.place[0] - exact), " m, ", slider.evaluations / 240, " evaluations a step, at most ", most);
    CHECK(std::fabs(slider.place[0] - exact) < 1e-5);
    CHECK(std::fabs(slider.speed() + 5 * exact) < 2e-3);
    CHECK(most < 10000);
    CHECK(slider.evaluations < 240 * 1500);
    CHECK(slider.work == doctest::Approx(0.5 * slider.speed() * slider.speed()).epsilon(0.05).scale(1));
    CHECK(automatic.events.count("solver.chosen") == 2);
    CHECK(automatic.events.count("solver.gave_up") == 0);
    CHECK(automatic.resolved().find("over jumps") != std::string::npos);
}

TEST_CASE("a thruster that fires on one side of a line alone slides along it, too")
{
    // 20 m/s^2 where q + v / 5 < 1 / 2, and nothing beyond: there |h lambda| has no bound.
    const double kMeets = (std::sqrt(5.0) - 1) / 20;
    Automatic automatic;
    Points lander({1}, {-3}, [](double, const auto& q, const auto& v, auto& a) { a[0] = 0.5 - q[0] - 0.2 * v[0] > 0 ? 20 : 0; });
    lander.run(1.0 / 240, 240, std::ref(automatic));
    const double above = (0.5 - 3 * kMeets + 10 * kMeets * kMeets) * std::exp(-5 * (1 - kMeets));
    MESSAGE("error ", std::fabs(lander.place[0] - 0.5 - above), " m, ", lander.evaluations / 240, " evaluations a step");
    CHECK(std::fabs(lander.place[0] - 0.5 - above) < 1e-4);  // 3e-4 where time stands still in ten of the steps
    CHECK(std::fabs(lander.speed() + 5 * above) < 4e-3);
    CHECK(automatic.events.count("solver.gave_up") == 0);
}

TEST_CASE("a force that jumps once in a step is located, and a fast smooth motion takes as many internal steps as it needs")
{
    // Free until q = 0.1, and thrown back from there on.
    Automatic automatic;
    Points thrown({0}, {1}, [](double, const auto& q, const auto&, auto& a) { a[0] = q[0] > 0.1 ? -400 : 0; });
    thrown.run(0.01, 11, std::ref(automatic));
    MESSAGE("jump: ", thrown.place[0] - 0.095, " m, ", thrown.speed() + 1, " m/s");
    CHECK(std::fabs(thrown.place[0] - 0.095) < 1e-7);  // there and back take 0.005 s
    CHECK(std::fabs(thrown.speed() + 1) < 1e-5);
    // Duffing's oscillator, no forces: 160 rad in a step.
    Automatic other;
    const double k = 1e8;
    Points duffing({1}, {0}, [&](double, const auto& q, const auto&, auto& a) { a[0] = -k * q[0] * q[0] * q[0]; });
    duffing.run(0.02, 1, std::ref(other));
    CHECK(other.resolved() == "Radau5");
    CHECK(0.5 * duffing.speed() * duffing.speed() + 0.25 * k * std::pow(duffing.place[0], 4) == doctest::Approx(0.25 * k).epsilon(1e-6));
}

TEST_CASE("many numbers that are a little stiff get parts of RungeKutta4, and DormandPrince54 where something faster begins")
{
    constexpr std::size_t kMany = 40;  // 80 numbers
    for (const double jump : {0.0, 5e4})
    {
        CAPTURE(jump);
        Automatic automatic;
        Points many(std::vector<double>(kMany, 1), std::vector<double>(kMany, 0),
                    [&](double t, const auto& q, const auto&, auto& a)
                    {
                        for (std::size_t i = 0; i < kMany; ++i) a[i] = -1e4 * q[i] + (t < 0.5035 ? 0 : jump);
                    });
        many.run(0.01, 100, std::ref(automatic));
        double kinetic = 0;
        for (std::size_t i = 0; i < kMany; ++i) kinetic += 0.5 * many.speed(i) * many.speed(i);
        CHECK(many.booked == doctest::Approx(100).epsilon(1e-12));
        CHECK(many.work == doctest::Approx(kinetic).epsilon(5e-3).scale(jump == 0 ? 2e5 : 7e6));  // J, what oscillates
        if (jump == 0)
        {
            CHECK(automatic.resolved() == "RungeKutta4 in parts");
            CHECK(std::fabs(many.place[0] - std::cos(100.0)) < 0.02);
            CHECK(many.evaluations < 100 * 24);  // an implicit step takes more than 80
        }
        else
            CHECK(automatic.rows.methods[0] == (32 | 64));
    }
}

TEST_CASE("more than 200 numbers get up to 64 parts, since internal steps with control of their error cost far more there")
{
    constexpr std::size_t kMany = 120;  // 240 numbers
    constexpr double kSpeed = 2000;     // rad/s: |h lambda| = 20
    Automatic automatic;
    Points many(std::vector<double>(kMany, 1), std::vector<double>(kMany, 0),
                [](double, const auto& q, const auto&, auto& a)
                {
                    for (std::size_t i = 0; i < kMany; ++i) a[i] = -kSpeed * kSpeed * q[i];
                });
    many.run(0.01, 10, std::ref(automatic));
    CHECK(automatic.resolved() == "RungeKutta4 in parts");
    CHECK(many.evaluations < 10 * 4 * 64);
    // In a part of w t = z the phase is late by z^4 / 120 of itself, and the energy falls by z^6 / 72. Parts are meant to have z = 0.4; the
    // stiffness for that is measured to a few percent.
    constexpr double z = 0.42;
    const double energy = 0.5 * many.speed() * many.speed() + 0.5 * kSpeed * kSpeed * many.place[0] * many.place[0];
    CHECK(energy == doctest::Approx(0.5 * kSpeed * kSpeed).epsilon(200 / z * std::pow(z, 6) / 72));
    CHECK(std::fabs(many.place[0] - std::cos(200.0)) < 200 * std::pow(z, 4) / 120);
}

TEST_CASE("many numbers without a smooth motion: a step ends after bounded work, at its end")
{
    constexpr std::size_t kMany = 120;  // 240 numbers
    Automatic automatic;
    Points many(std::vector<double>(kMany, 0), std::vector<double>(kMany, 1),
                [](double t, const auto& q, const auto&, auto& a)
                {
                    for (std::size_t i = 0; i < kMany; ++i) a[i] = 1e5 * std::sin(1e9 * t + static_cast<double>(i)) - 1e8 * q[i];
                });
    many.run(0.01, 1, std::ref(automatic));
    CHECK(automatic.rows.last_methods[0] == 32);
    CHECK(many.evaluations < 15'000);
    CHECK(many.time == 0.01);
    CHECK(many.booked == doctest::Approx(1).epsilon(1e-9));
    CHECK(std::fabs(many.place[0]) < 6);  // 1e5 m/s^2 throughout would make 5 m
    CHECK(many.place[0] != 0);
}

TEST_CASE("if the host could not divide its step as finely as its contacts need, there are no further internal steps")
{
    Automatic automatic;
    Points a = damped_spring(1e6, 0.05), b = damped_spring(1e6, 0.05);
    a.undersampled = true;
    a.run(0.01, 3, std::ref(automatic)), b.run(0.01, 3, rk4);
    CHECK(a.place == b.place);
    CHECK(a.evaluations == b.evaluations);
    CHECK(automatic.resolved() == "RungeKutta4");
    CHECK(automatic.rows.reason[0] == "RungeKutta4: contacts need more substeps than are allowed, whatever the method");
    CHECK(automatic.events.all.empty());
    a.undersampled = false;
    a.run(0.01, 1, std::ref(automatic));
    CHECK(automatic.resolved() == "RungeKutta4, Exponential");
}

TEST_CASE("a spring that becomes stiff long after the start does not diverge for one step")
{
    Automatic automatic;
    // Slack until t = 0.3, h w = 100 afterwards.
    Points p({1}, {0}, [](double t, const auto& q, const auto&, auto& a) { a[0] = t < 0.305 ? 0.0 : -1e8 * q[0]; });
    double most = 0;
    for (int i = 0; i < 100; ++i) p.run(0.01, 1, std::ref(automatic)), most = std::fmax(most, std::fabs(p.place[0]));
    CHECK(most < 1.0001);
    CHECK(0.5 * p.speed() * p.speed() + 0.5e8 * p.place[0] * p.place[0] == doctest::Approx(0.5e8).epsilon(1e-5));
    CHECK(automatic.events.count("solver.chosen") == 2);
    CHECK(p.booked == doctest::Approx(100).epsilon(1e-12));  // the rewound step is not in the ledger
}

TEST_CASE("a stiff spring beside a large slow motion does not move")
{
    for (const double moved : {0.0, 1e-9, 1e-5})
    {
        CAPTURE(moved);
        Automatic automatic;
        Points p = hidden_spring(moved);
        double most = 0;
        for (int i = 0; i < 300; ++i) p.run(0.01, 1, std::ref(automatic)), most = std::fmax(most, std::fabs(p.place[0]));
        CHECK(most < 3 * moved + 5e-6);  // an undetected motion is a small fraction of the one that hides it
        const double t = 3, mean = -9.81 / 4;
        CHECK(p.place[1] == doctest::Approx(mean + (5 - mean) * std::cos(2 * t) + 1.5 * std::sin(2 * t)).epsilon(1e-7));
    }
}

TEST_CASE("the choice depends on the start of the advance alone: trials, pieces and other groups do not change it")
{
    Automatic automatic, alone;
    Points stiff = damped_spring(1e8, 0.05), same = damped_spring(1e8, 0.05), soft = damped_spring(1, 0.05), slow = damped_spring(1, 0.05);
    for (Tick tick = 0; tick < 40; ++tick)
    {
        automatic.tick = alone.tick = tick, soft.run(0.01, 1, std::ref(automatic));
        automatic.tick = tick, automatic.trial = true;
        Points tried = stiff;
        tried.run(0.003, 1, std::ref(automatic));
        automatic.tick = tick, automatic.trial = false;
        stiff.run(0.01, 1, std::ref(automatic)), same.run(0.01, 1, std::ref(alone)), slow.run(0.01, 1, rk4);
    }
    CHECK(stiff.place == same.place);
    CHECK(soft.place == slow.place);
    CHECK(automatic.resolved() == "RungeKutta4, Exponential");
    CHECK(automatic.events.count("solver.chosen") == 1);
    CHECK(automatic.rows.reason[0].find("Exponential: |h lambda| = ") == 0);
}

TEST_CASE("a trial leaves no trace")
{
    Automatic trial;
    trial.trial = true;
    Points p = damped_spring(1e8, 0.05);
    p.run(0.01, 3, std::ref(trial));
    CHECK(trial.resolved().empty());
    CHECK(trial.rows.methods[0] == 0);
    CHECK(std::fabs(p.place[0] - damped_place(1e8, 0.05, 0.03)) < 1e-10);
}

TEST_CASE("stiff, nonlinear and large groups: explicit internal steps, and a message about the size")
{
    Automatic automatic;
    const std::size_t n = 101;
    Points p(std::vector<double>(n, 0.5), std::vector<double>(n, 0.0),
             [](double, const auto& q, const auto&, auto& a)
             {
                 for (std::size_t i = 0; i < q.size(); ++i) a[i] = -1e8 * q[i] * q[i] * q[i];
             });
    p.run(0.01, 2, std::ref(automatic));
    CHECK(automatic.resolved() == "DormandPrince54");
    REQUIRE(automatic.events.count("solver.chosen") == 1);
    CHECK(automatic.events.all[0].message.find("202 numbers") != std::string::npos);
    CHECK(0.5 * p.speed() * p.speed() + 0.25e8 * std::pow(p.place[0], 4) == doctest::Approx(0.25e8 / 16).epsilon(1e-7));
}

TEST_CASE("joints: no closed forms and no splitting, but parts where a body turns far in a step")
{
    for (const auto& [spin, method] : {std::pair(Vec3{1, 2, 3}, "RungeKutta4"), std::pair(Vec3{10, 20, 30}, "RungeKutta4 in parts")})
    {
        Automatic automatic;
        Body b(diagonal(kBoxInertia), spin);
        b.constrained = true;
        b.run(0.01, 3, std::ref(automatic));
        CHECK(automatic.resolved() == method);
    }
}
