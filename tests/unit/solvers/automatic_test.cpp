/// Solver/Automatic: the rule, its memory, and the bits of what it picks.
#include "objects/solvers/automatic.h"
#include "objects/solvers/facts.h"
#include "objects/solvers/runge_kutta4.h"
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

void rk4(double h, DynamicSystem& system)
{
    StepContext context;
    context.dt = h;
    advance_runge_kutta4(context, 0, {}, system);
}

Body::Law light_drag()
{
    return [](double, const Body& b) { return Body::Load{-0.1 * b.velocity(), -0.001 * rotate(b.attitude(), b.spin_B())}; };
}

double measured(FakeSystem& system, double h)
{
    std::vector<double> v[7];
    return measure_stiffness(system, h, {v[0], v[1], v[2], v[3], v[4], v[5], v[6]});
}

}  // namespace

TEST_CASE("stiffness is measured: springs by frequency, dampers by rate, whatever the units")
{
    for (const double k : {1.0, 1e4, 1e8, 1e12})
    {
        Points spring = damped_spring(k, 0.05);
        CHECK(measured(spring, 0.01) == doctest::Approx(std::sqrt(k)).epsilon(0.02));
    }
    Points drag({0}, {3}, [](double, const auto&, const auto& v, auto& a) { a[0] = -1e6 * v[0]; });
    CHECK(measured(drag, 0.01) == doctest::Approx(1e6).epsilon(0.01));
    Points chain({0, 0, 0}, {0, 0, 0},
                 [](double, const auto& q, const auto&, auto& a)
                 { a[0] = -1e6 * (q[0] - q[1]), a[1] = -1e6 * (2 * q[1] - q[0] - q[2]), a[2] = -1e6 * (q[2] - q[1]); });
    CHECK(measured(chain, 0.01) == doctest::Approx(std::sqrt(3e6)).epsilon(0.2));
    Points free({0}, {3}, [](double, const auto&, const auto&, auto& a) { a[0] = -9.81; });
    CHECK(measured(free, 0.01) == 0);
    Amounts reaction({1, 0}, [](double, const auto& z, auto& r) { r[0] = -1e5 * z[0], r[1] = 1e5 * z[0]; });
    CHECK(measured(reaction, 1) == doctest::Approx(1e5).epsilon(0.02));
}

TEST_CASE("what is soft and slow gets the bits of RungeKutta4, and no word is lost about it")
{
    Automatic automatic;
    Points a = driven_oscillator(), b = driven_oscillator();
    a.run(0.01, 200, std::ref(automatic)), b.run(0.01, 200, rk4);
    CHECK(a.place == b.place);
    CHECK(a.speed() == b.speed());
    CHECK(a.work == b.work);
    CHECK(automatic.resolved() == "RungeKutta4");
    CHECK(automatic.events.all.empty());
    CHECK(a.evaluations < b.evaluations * 1.2);
    Automatic slow;
    Body c(diagonal(kBoxInertia), {1, 2, 3}, light_drag()), d(diagonal(kBoxInertia), {1, 2, 3}, light_drag());
    c.run(0.01, 100, std::ref(slow)), d.run(0.01, 100, rk4);
    CHECK(c.orientation == d.orientation);
    CHECK(slow.resolved() == "RungeKutta4");
    CHECK(slow.rows.spin[0] == doctest::Approx(0.037).epsilon(0.1));
}

TEST_CASE("free flight is exact, fast spin is split, stiff springs are exponentiated, stiff reactions go to Radau5")
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
    CHECK(c.rows.stiffness[0] == doctest::Approx(10).epsilon(0.05));

    Amounts reaction({2, 0}, [](double, const auto& y, auto& f) { f[0] = y[1], f[1] = ((1 - y[0] * y[0]) * y[1] - y[0]) / 1e-6; });
    reaction.run(0.5, 4, std::ref(d));
    CHECK(d.resolved() == "Radau5");
    CHECK(reaction[0] == doctest::Approx(0.1706167732170483e1).epsilon(1e-8));
}

TEST_CASE("the choice falls only when less was needed for a whole window, and does not flutter")
{
    // A spin that drag brakes from h |w| = 0.1 through the bounds 0.05 and 0.0125.
    Automatic automatic;
    Body b(Mat3::diagonal(1, 1, 1), {0, 0, 10}, [](double, const Body& body) { return Body::Load{{}, -1.0 * body.momentum()}; });
    b.run(0.01, 70, std::ref(automatic));
    CHECK(b.spin_B().z * 0.01 < 0.05);
    CHECK(automatic.resolved() == "RotationSplitting");
    b.run(0.01, 300, std::ref(automatic));
    CHECK(automatic.resolved() == "RungeKutta4");
    CHECK(automatic.events.count("solver.chosen") == 2);
}

TEST_CASE("trials and pieces of a step use the choice and do not change it")
{
    Automatic automatic;
    Points soft = damped_spring(1, 0.05), stiff = damped_spring(1e8, 0.05);
    soft.run(0.01, 1, std::ref(automatic));
    automatic.trial = true;
    stiff.run(0.01, 1, std::ref(automatic));
    automatic.trial = false;
    CHECK(automatic.rows.choice[0] == static_cast<std::int64_t>(Choice::RungeKutta4));
    CHECK(automatic.events.all.empty());
    // A piece of the same step: the host's tick stays.
    automatic.tick = 0;
    Points again = damped_spring(1e8, 0.05);
    again.run(0.004, 1, std::ref(automatic));
    CHECK(automatic.rows.choice[0] == static_cast<std::int64_t>(Choice::RungeKutta4));
}

TEST_CASE("groups that share a component share the most demanding choice")
{
    Automatic automatic;
    Points soft = damped_spring(1, 0.05), stiff = damped_spring(1e8, 0.05);
    for (Tick tick = 0; tick < 40; ++tick)
        for (Points* p : {&soft, &stiff})
        {
            automatic.tick = tick;
            p->run(0.01, 1, std::ref(automatic));
            if (tick > 0) CHECK(automatic.rows.choice[0] == static_cast<std::int64_t>(Choice::Exponential));
        }
    CHECK(automatic.events.count("solver.chosen") == 1);
    CHECK(soft.place[0] == doctest::Approx(damped_place(1, 0.05, 0.4)).epsilon(1e-9));
}

TEST_CASE("joints: no closed forms and no splitting")
{
    Automatic automatic;
    Body b(diagonal(kBoxInertia), {10, 20, 30});
    b.constrained = true;
    b.run(0.01, 3, std::ref(automatic));
    CHECK(automatic.resolved() == "RungeKutta4");
}

TEST_CASE("a spin that swings about the bound does not make the choice flutter")
{
    Automatic automatic;
    // h |w| between 0.03 and 0.07, 100 steps to a swing.
    Body b(Mat3::diagonal(1, 1, 1), {0, 0, 5},
           [](double t, const Body&) {
               return Body::Load{{}, {0, 0, 4 * M_PI * std::cos(2 * M_PI * t)}};
           });
    b.run(0.01, 1000, std::ref(automatic));
    CHECK(automatic.resolved() == "RotationSplitting");
    CHECK(automatic.events.count("solver.chosen") == 1);
}
