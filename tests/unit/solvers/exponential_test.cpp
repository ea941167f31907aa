/// Solver/Exponential: exact for linear forces at any step and stiffness, of order 4 for others.
#include "objects/solvers/exponential.h"
#include "objects/solvers/flat_system.h"
#include "objects/solvers/matrix_exponential.h"
#include "unit/solvers/problems.h"

using namespace plab;
using namespace plab::solvers;
using namespace plab::test;

namespace
{

struct Exponentials : Solver<ExponentialRows>
{
    Exponentials() : Solver(advance_exponential) {}
};

}  // namespace

TEST_CASE("matrix exponentials: rotations, decays, chains, badly scaled")
{
    MatrixExponential e;
    std::vector<double> v(2), out(2);
    for (const double angle : {1e-8, 0.3, 7.0, 1e4})
    {
        // Positions in units that are 1e6 times too large.
        e.matrix().resize(2);
        e.matrix()(0, 0) = 0, e.matrix()(0, 1) = 1e6 * angle, e.matrix()(1, 0) = -1e-6 * angle, e.matrix()(1, 1) = 0;
        REQUIRE(e.compute());
        v = {1e6, 0};
        e.apply(0, v, out);
        CHECK(out[0] * 1e-6 == doctest::Approx(std::cos(angle)).epsilon(3e-15 * std::fmax(1, angle)));
        CHECK(out[1] == doctest::Approx(-std::sin(angle)).epsilon(3e-15 * std::fmax(1, angle)));
        e.apply(2, v, out);
        CHECK(out[0] * 1e-6 == doctest::Approx(std::cos(0.25 * angle)).epsilon(3e-15 * std::fmax(1, angle)));
    }
    e.matrix().resize(2);
    e.matrix()(0, 0) = -1e9, e.matrix()(0, 1) = 5, e.matrix()(1, 0) = 0, e.matrix()(1, 1) = 0;
    REQUIRE(e.compute());
    v = {1, 1};
    e.apply(0, v, out);
    CHECK(out[0] == doctest::Approx(5e-9).epsilon(1e-13));
    CHECK(out[1] == 1);
    e.matrix().resize(1);
    e.matrix()(0, 0) = 1e5;
    CHECK(!e.compute());
}

TEST_CASE("a spring with a damper and its weight: correct to 1e-10 from 1e2 to 1e12 N/m, in steps of 1 ms to 100 ms")
{
    for (const double k : {1e2, 1e4, 1e6, 1e8, 1e10, 1e12})
        for (const double h : {0.001, 1.0 / 30, 0.1})
        {
            CAPTURE(k);
            CAPTURE(h);
            const double c = k <= 1e6 ? 0.1 * std::sqrt(k) : 0.1, zeta = 0.5 * c / std::sqrt(k), start = 1 + 9.81 / k;
            Exponentials solver;
            Points p({1}, {0}, [=](double, const auto& q, const auto& v, auto& a) { a[0] = -k * q[0] - c * v[0] - 9.81; });
            const int steps = static_cast<int>(std::lround(0.3 / h));
            p.run(h, steps, std::ref(solver));
            const double expected = -9.81 / k + start * damped_place(k, zeta, 0.3);
            CHECK(std::fabs(p.place[0] - expected) < (k <= 1e8 ? 2e-12 : 2e-10));
            CHECK(solver.rows.linear[0]);
            CHECK(p.booked == doctest::Approx(steps).epsilon(1e-10));
        }
}

TEST_CASE("a light and a heavy body: 1e-3 kg against 1e3 kg on 1e6 N/m conserve their momentum")
{
    const double k = 1e6, m1 = 1e-3, m2 = 1e3, reduced = m1 * m2 / (m1 + m2), c = 2 * 0.01 * std::sqrt(k * reduced);
    Exponentials solver;
    Points p({0, 0.01}, {0, 0},
             [=](double, const auto& q, const auto& v, auto& a)
             {
                 const double f = k * (q[1] - q[0]) + c * (v[1] - v[0]);
                 a[0] = f / m1, a[1] = -f / m2;
             });
    p.run(0.1, 5, std::ref(solver));
    CHECK(std::fabs(p.speed(0) * m1 + p.speed(1) * m2) < 1e-12);
    const double stretch = p.place[1] - p.place[0], expected = 0.01 * damped_place(k / reduced, 0.01, 0.5);
    CHECK(std::fabs(stretch - expected) < 1e-13);
}

TEST_CASE("a jump of the wind on stiff drag is exact, and so is a force that is linear in time")
{
    for (const double h : {1e-3, 0.1, 1.0})
    {
        Exponentials solver;
        Points p({0}, {0}, [](double, const auto&, const auto& v, auto& a) { a[0] = -1e6 * (v[0] - 10); });
        p.run(h, 1, std::ref(solver));
        CHECK(p.speed() == doctest::Approx(10).epsilon(1e-14));
        CHECK(p.place[0] == doctest::Approx(10 * h - 1e-5).epsilon(1e-13));
    }
    Exponentials solver;
    Points p({0}, {0}, [](double t, const auto& q, const auto&, auto& a) { a[0] = -4 * q[0] + 3 * t; });
    p.run(2, 1, std::ref(solver));
    CHECK(p.place[0] == doctest::Approx(0.75 * 2 - 3.0 / 8 * std::sin(4.0)).epsilon(1e-13));
    CHECK(solver.rows.linear[0]);
}

TEST_CASE("the ledger of linear forces closes for any number of oscillations in a step, at a bounded cost")
{
    for (const double k : {1e2, 1e6, 1e12})
        for (const double h : {0.01, 1.0})
        {
            CAPTURE(k);
            CAPTURE(h);
            const double c = 1e-3 * std::sqrt(k);
            Exponentials solver;
            Points p({1, 7, 3}, {0, 0, 0},
                     [=](double t, const auto& q, const auto& v, auto& a) { a[0] = -k * q[0] - c * v[0] - 9.81 + t, a[1] = 0, a[2] = 0; });
            p.run(h, 3, std::ref(solver));
            CHECK(std::fabs(p.work - 0.5 * p.speed() * p.speed()) < 1e-11 * k);
            CHECK(p.booked == doctest::Approx(3).epsilon(1e-12));
            CHECK(solver.rows.evaluations[0] <= 17);  // 2 of 6 numbers move
        }
}

TEST_CASE("a stop that the motion does not reach has no effect, not even on the ledger")
{
    Exponentials solver;
    const auto law = [](double, const auto& q, const auto&, auto& a)
    { a[0] = -1e4 * q[0] - (q[0] > 0.01001 ? 1e9 * q[0] : 0.0), a[1] = -1e4 * (q[1] - q[0]); };
    Points p({0.01, 0}, {0, 0}, law);
    p.run(0.05, 20, std::ref(solver));
    const double energy = 0.5 * p.speed() * p.speed();
    CHECK(std::fabs(p.place[0] - 0.01 * std::cos(100.0)) < 1e-10);
    CHECK(energy == doctest::Approx(0.5e4 * (1e-4 - p.place[0] * p.place[0])).epsilon(1e-8));
}

TEST_CASE("nonlinear forces: order 4, and a ledger of order 4")
{
    const auto run = [](int steps)
    {
        Exponentials solver;
        Points p({1}, {2},
                 [](double t, const auto& q, const auto& v, auto& a)
                 { a[0] = -4 * std::sin(q[0]) - 0.1 * v[0] * (1 + v[0] * v[0]) + 0.5 * std::cos(2 * t); });
        p.run(2.0 / steps, steps, std::ref(solver));
        CHECK(!solver.rows.linear[0]);
        return p;
    };
    const Points truth = run(2048);
    const auto error = [&](int steps) { return std::fabs(run(steps).place[0] - truth.place[0]); };
    CHECK(order_of(error, 32) == doctest::Approx(4).epsilon(0.1));
    const auto books = [&](int steps)
    {
        const Points p = run(steps);
        return std::fabs(p.work - 0.5 * (p.speed() * p.speed() - 4));
    };
    CHECK(books(64) < 1e-5);
    CHECK(books(128) < books(64) / 10);
}

TEST_CASE("a tumbling body on a spring: order 4 in its attitude")
{
    const auto run = [](int steps)
    {
        Exponentials solver;
        Body b(diagonal(kBoxInertia), kBoxSpin,
               [](double, const Body& body)
               {
                   const Vec3 arm = rotate(body.attitude(), {0.1, 0, 0}), force = -20.0 * (body.place() + arm);
                   return Body::Load{force, cross(arm, force)};
               });
        b.run(1.0 / steps, steps, std::ref(solver));
        return b.orientation;
    };
    const Quat truth = run(320);
    CHECK(order_of([&](int n) { return attitude_error(run(n), truth); }, 20) == doctest::Approx(4).epsilon(0.15));
}

TEST_CASE("large groups and overflow fall back to Radau5, reported once")
{
    Exponentials solver;
    solver.rows.max_size[0] = 3;
    Points p({1, 2}, {0, 0}, [](double, const auto& q, const auto&, auto& a) { a[0] = -q[0], a[1] = -q[1]; });
    p.run(0.5, 2, std::ref(solver));
    CHECK(p.place[0] == doctest::Approx(std::cos(1.0)).epsilon(1e-8));
    CHECK(solver.rows.resolved.resolved[0] == "Radau5");
    REQUIRE(solver.events.count("solver.fell_back") == 1);
    CHECK(solver.events.all[0].message.find("4 numbers") != std::string::npos);
    // Members that do not move are not counted.
    Exponentials still;
    still.rows.max_size[0] = 2;
    Points q({1, 0}, {0, 0}, [](double, const auto& x, const auto&, auto& a) { a[0] = -x[0], a[1] = -x[1]; });
    q.run(0.5, 2, std::ref(still));
    CHECK(still.rows.resolved.resolved[0] == "Exponential");
}

TEST_CASE("derivatives by extrapolated differences are correct to 1e-9")
{
    Points p({0.3, -0.2}, {2, 0.5},
             [](double, const auto& q, const auto& v, auto& a)
             { a[0] = -1e3 * std::sin(q[0] * q[1]) - 0.1 * v[0] * v[0], a[1] = std::exp(2 * q[1]) - 7 * v[1] * q[0]; });
    FlatSystem flat(p);
    std::vector<double> v[8];
    for (auto& each : v) each.resize(4);
    SquareMatrix<double> j;
    flat.read(v[0]), flat.units(v[2]), flat.evaluate(0, v[0], v[1]), flat.sizes(v[0], v[1], 0.1, v[3]);
    j.resize(4);
    for (std::size_t c = 0; c < 4; ++c) fine_column(flat, {0, 0.1, v[0], v[1], v[3], v[2], 0, v[4], v[5], v[6], v[7]}, c, j);
    const double slope = -1e3 * std::cos(-0.06);
    const double expected[4][4] = {{0, 0, 1, 0}, {0, 0, 0, 1}, {slope * -0.2, slope * 0.3, -0.4, 0}, {-3.5, 2 * std::exp(-0.4), 0, -2.1}};
    for (std::size_t r = 0; r < 4; ++r)
        for (std::size_t c = 0; c < 4; ++c) CHECK(j(r, c) == doctest::Approx(expected[r][c]).epsilon(1e-9));
}
