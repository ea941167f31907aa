/// The implicit solvers: Radau5 on the field's standard stiff problems, and ImplicitMidpoint.
#include "linear/dense.h"
#include "objects/solvers/implicit_midpoint.h"
#include "objects/solvers/radau5.h"
#include "unit/solvers/problems.h"

using namespace plab;
using namespace plab::linear;
using namespace plab::solvers;
using namespace plab::test;

namespace
{

struct Radau : Solver<Radau5Rows>
{
    Radau(double relative, double absolute) : Solver(advance_radau5)
    {
        rows.relative_tolerance[0] = relative, rows.absolute_tolerance[0] = absolute;
    }
};
struct Midpoint : Solver<ImplicitMidpointRows>
{
    Midpoint() : Solver(advance_implicit_midpoint) {}
};

/// Correct digits of the worst component (Test set for IVP solvers).
double scd(const Amounts& z, std::initializer_list<double> reference)
{
    double worst = 1e-16;
    std::size_t i = 0;
    for (const double r : reference) worst = std::fmax(worst, std::fabs(z[i++] / r - 1));
    return -std::log10(worst);
}

}  // namespace

TEST_CASE("dense factors solve real and complex systems, and refuse singular ones")
{
    Factors<double> real;
    real.matrix().resize(3);
    const double a[3][3] = {{0, 2, 1}, {1e-9, 1, 3}, {4, 5, 6}};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) real.matrix()(i, j) = a[i][j];
    REQUIRE(real.factorise());
    std::vector<double> b{7, 11 + 1e-9, 32};  // x = (1, 2, 3)
    real.solve(b);
    for (std::size_t i = 0; i < 3; ++i) CHECK(b[i] == doctest::Approx(static_cast<double>(i + 1)).epsilon(1e-14));
    for (double& v : real.matrix().all()) v = 1;
    CHECK(!real.factorise());

    Factors<Complex> complex;
    complex.matrix().resize(2);
    complex.matrix()(0, 0) = {0, 1}, complex.matrix()(0, 1) = {2, 0}, complex.matrix()(1, 0) = {1, 1}, complex.matrix()(1, 1) = {0, -1};
    REQUIRE(complex.factorise());
    std::vector<Complex> c{{2, 3}, {1, 1}};  // x = (1, 1 + i)
    c[0] = {2, 3}, c[1] = {2, 0};
    complex.solve(c);
    CHECK(c[0].real() == doctest::Approx(1));
    CHECK(c[0].imag() == doctest::Approx(0));
    CHECK(c[1].real() == doctest::Approx(1));
    CHECK(c[1].imag() == doctest::Approx(1));
}

TEST_CASE("dense factors of more than one panel, with rows whose units are far apart; an interruption is checked")
{
    // Rows of positions and of speeds: the second half is 1e9 times as large. x = (1, 2, 3, ...).
    constexpr std::size_t n = 70;
    Factors<double> factors;
    const auto fill = [&]
    {
        factors.matrix().resize(n);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j)
                factors.matrix()(i, j) =
                    (i < n / 2 ? 1.0 : 1e9) * (std::sin(static_cast<double>(3 * i * j + i + 1)) + (i == j ? 3.0 : 0.0));
    };
    fill();
    std::vector<double> b(n, 0.0);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) b[i] += factors.matrix()(i, j) * static_cast<double>(j + 1);
    REQUIRE(factors.factorise());
    factors.solve(b);
    for (std::size_t i = 0; i < n; ++i) CHECK(b[i] == doctest::Approx(static_cast<double>(i + 1)).epsilon(1e-12));
    fill();
    int asked = 0;
    CHECK(!factors.factorise([&] { return ++asked == 50; }));
    CHECK(asked == 50);
}

// References: Test set for IVP solvers (Mazzia, Magherini), recomputed there in quadruple precision.
TEST_CASE("Robertson's reaction to 1e11 s: eight digits and more")
{
    const auto law = [](double, const auto& y, auto& f)
    {
        f[0] = -0.04 * y[0] + 1e4 * y[1] * y[2], f[2] = 3e7 * y[1] * y[1];
        f[1] = -f[0] - f[2];
    };
    for (const int steps : {1, 10})
    {
        Radau solver(1e-9, 1e-18);
        Amounts z({1, 0, 0}, law);
        z.run(1e11 / steps, steps, std::ref(solver));
        const double digits = scd(z, {0.2083340149701255e-7, 0.8333360770334713e-13, 0.9999999791665050});
        MESSAGE("Robertson: scd " << digits << ", " << z.evaluations << " evaluations");
        CHECK(digits > 9);
        CHECK(solver.events.all.empty());
    }
}

TEST_CASE("van der Pol's oscillator, epsilon 1e-6")
{
    Radau solver(1e-9, 1e-9);
    Amounts z({2, 0}, [](double, const auto& y, auto& f) { f[0] = y[1], f[1] = ((1 - y[0] * y[0]) * y[1] - y[0]) / 1e-6; });
    z.run(0.5, 4, std::ref(solver));
    const double digits = scd(z, {0.1706167732170483e1, -0.8928097010247975});
    MESSAGE("van der Pol: scd " << digits << ", " << z.evaluations << " evaluations");
    CHECK(digits > 8);
}

TEST_CASE("HIRES, eight reactions")
{
    const auto law = [](double, const auto& y, auto& f)
    {
        f[0] = -1.71 * y[0] + 0.43 * y[1] + 8.32 * y[2] + 0.0007, f[1] = 1.71 * y[0] - 8.75 * y[1];
        f[2] = -10.03 * y[2] + 0.43 * y[3] + 0.035 * y[4], f[3] = 8.32 * y[1] + 1.71 * y[2] - 1.12 * y[3];
        f[4] = -1.745 * y[4] + 0.43 * y[5] + 0.43 * y[6];
        f[5] = -280 * y[5] * y[7] + 0.69 * y[3] + 1.71 * y[4] - 0.43 * y[5] + 0.69 * y[6];
        f[6] = 280 * y[5] * y[7] - 1.81 * y[6], f[7] = -f[6];
    };
    Radau solver(1e-9, 1e-12);
    Amounts z({1, 0, 0, 0, 0, 0, 0, 0.0057}, law);
    z.run(321.8122, 1, std::ref(solver));
    const double digits = scd(z, {0.7371312573325668e-3, 0.1442485726316185e-3, 0.5888729740967575e-4, 0.1175651343283149e-2,
                                  0.2386356198831331e-2, 0.6238968252742796e-2, 0.2849998395185769e-2, 0.2850001604814231e-2});
    MESSAGE("HIRES: scd " << digits << ", " << z.evaluations << " evaluations");
    CHECK(digits > 8);
}

TEST_CASE("springs from soft to 1e12 N/m at steps of 10 ms; the ledger closes")
{
    for (const double k : {1e2, 1e6, 1e12})
    {
        CAPTURE(k);
        Radau solver(1e-9, 1e-12);
        Points p = damped_spring(k, 0.05);
        p.run(0.01, 30, std::ref(solver));
        CHECK(std::fabs(p.place[0] - damped_place(k, 0.05, 0.3)) < 1e-10);
        CHECK(std::fabs(p.work - 0.5 * p.speed() * p.speed()) < 1e-8 * k);
        CHECK(p.booked == doctest::Approx(30).epsilon(1e-9));
        CHECK(solver.events.all.empty());
    }
}

TEST_CASE("a jump of the wind on stiff drag, and quadratic drag")
{
    Radau solver(1e-9, 1e-12);
    Points p({0}, {0}, [](double, const auto&, const auto& v, auto& a) { a[0] = -1e6 * (v[0] - 10); });
    p.run(0.01, 10, std::ref(solver));
    CHECK(p.speed() == doctest::Approx(10).epsilon(1e-10));
    CHECK(p.place[0] == doctest::Approx(1 - 1e-5).epsilon(1e-9));
    Points q = falling_with_drag();
    q.run(1.0, 5, std::ref(solver));
    CHECK(q.speed() == doctest::Approx(kDragSpeedAt5).epsilon(1e-9));
    CHECK(q.place[0] == doctest::Approx(kDragPlaceAt5).epsilon(1e-9));
}

TEST_CASE("Radau5 rotates bodies, and its trials give the same bits")
{
    Radau solver(1e-10, 1e-13), trial(1e-10, 1e-13);
    trial.trial = true;
    Body box(diagonal(kBoxInertia), kBoxSpin), tried(diagonal(kBoxInertia), kBoxSpin);
    box.run(0.1, 50, std::ref(solver)), tried.run(0.1, 50, std::ref(trial));
    CHECK(attitude_error(box.orientation, kBoxAt5) < 2e-9);
    CHECK(tried.orientation == box.orientation);
}

TEST_CASE("Radau5 gives up in bounded time on an impossible problem")
{
    Radau solver(1e-9, 1e-12);
    Points nan({1}, {0}, [](double t, const auto&, const auto&, auto& a) { a[0] = t > 0.5 ? std::nan("") : 0.0; });
    nan.run(1, 1, std::ref(solver));
    CHECK(solver.events.count("solver.gave_up") == 1);
    CHECK(std::isfinite(nan.place[0]));
    CHECK(nan.evaluations < 100000);
    solver.rows.max_substeps[0] = 5;
    Points p = damped_spring(1e6, 0.05);
    p.run(1, 1, std::ref(solver));
    CHECK(solver.events.count("solver.gave_up") == 2);
    CHECK(std::isfinite(p.place[0]));
}

TEST_CASE("the implicit midpoint rule is of order 2, with drag and with rotating bodies")
{
    const auto oscillator = [](int steps)
    {
        Midpoint solver;
        Points p = driven_oscillator();
        p.run(3.0 / steps, steps, std::ref(solver));
        CHECK(p.booked == doctest::Approx(steps).epsilon(1e-12));
        return std::fabs(p.place[0] - driven_place(3));
    };
    CHECK(order_of(oscillator, 40) == doctest::Approx(2).epsilon(0.01));
    const auto drag = [](int steps)
    {
        Midpoint solver;
        Points p = falling_with_drag();
        p.run(5.0 / steps, steps, std::ref(solver));
        return std::fabs(p.speed() - kDragSpeedAt5);
    };
    CHECK(order_of(drag, 40) == doctest::Approx(2).epsilon(0.02));
    const auto box = [](int steps)
    {
        Midpoint solver;
        Body b(diagonal(kBoxInertia), kBoxSpin);
        b.run(5.0 / steps, steps, std::ref(solver));
        return attitude_error(b.orientation, kBoxAt5);
    };
    CHECK(order_of(box, 250) == doctest::Approx(2).epsilon(0.02));
}

TEST_CASE("the implicit midpoint rule conserves a spring's energy at any stiffness, and dissipates no more than dampers do")
{
    for (const double k : {1e2, 1e6, 1e12})
    {
        CAPTURE(k);
        Midpoint solver;
        Points p = damped_spring(k, 0);
        p.run(0.01, 1000, std::ref(solver));
        CHECK(0.5 * (p.speed() * p.speed() + k * p.place[0] * p.place[0]) == doctest::Approx(0.5 * k).epsilon(1e-7));
        CHECK(p.work == doctest::Approx(0.5 * p.speed() * p.speed()).epsilon(1e-6).scale(0.5 * k));
        CHECK(solver.events.all.empty());
        CHECK(solver.rows.substeps[0] == 1);
    }
    Midpoint solver;
    Points wind({0}, {0}, [](double, const auto&, const auto& v, auto& a) { a[0] = -1e6 * (v[0] - 10); });
    wind.run(0.01, 3, std::ref(solver));
    CHECK(std::fabs(wind.speed() - 10) < 10.001);  // A-stable, not L-stable: it oscillates about the solution
}

TEST_CASE("the implicit midpoint rule halves its step if necessary, and reports where it failed")
{
    Midpoint solver;
    Points wall({1}, {-1}, [](double, const auto& q, const auto&, auto& a) { a[0] = 1e4 * std::exp(-2e3 * q[0]); });
    wall.run(0.05, 40, std::ref(solver));
    CHECK(std::isfinite(wall.place[0]));
    Points nan({1}, {0}, [](double, const auto&, const auto&, auto& a) { a[0] = std::nan(""); });
    Midpoint lost;
    nan.run(1, 1, std::ref(lost));
    CHECK(lost.events.count("solver.failed") == 1);
    CHECK(nan.place[0] == 1);
}

TEST_CASE("a group that is large for dense matrices is named once, with its size")
{
    Radau solver(1e-6, 1e-9);
    Amounts many(std::vector<double>(301, 1.0),
                 [](double, const auto& y, auto& f)
                 {
                     for (std::size_t i = 0; i < y.size(); ++i) f[i] = -y[i];
                 });
    many.run(0.01, 2, std::ref(solver));
    REQUIRE(solver.events.count("solver.large") == 1);
    CHECK(solver.events.all[0].message.find("301 numbers") != std::string::npos);
    CHECK(many[300] == doctest::Approx(std::exp(-0.02)).epsilon(1e-9));
}
