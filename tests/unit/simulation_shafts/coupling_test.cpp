// Pairwise couplings and one-way drives over reduced coordinates, at both levels, with the plugin's own functions.
#include <chrono>
#include <cmath>

#include "plab/random.h"
#include "train.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// A train with couplings of the plugin.
struct Coupled : Train
{
    CouplingTable assign{"Assign"}, impulse{"Impulse"}, gears{"Graph"};

    void prepare()
    {
        REQUIRE(assign.prepare().ok());
        REQUIRE(impulse.prepare().ok());
        REQUIRE(gears.prepare().ok());
        gears.connect(graph);
        build();
    }
    simulation::CouplingReport sweep(int most = simulation::kMaxCouplingSweeps)
    {
        return coupling.solve(
            [this]
            {
                assign.couple(coupling);
                impulse.couple(coupling);
            },
            most);
    }
    std::vector<double> solve(const std::vector<double>& torque)
    {
        begin_accelerations(torque);
        CHECK(sweep().converged);
        return rates();
    }
    void solve_speeds()
    {
        begin_speeds();
        CHECK(sweep().converged);
        coupling.store_speeds(shafts);
    }
};

}  // namespace

TEST_CASE("F1 with Impulse: the pair has the reflected inertia")
{
    Coupled t;
    t.add_shaft(10), t.add_shaft(100);
    t.impulse.add(0, 0, 1, -0.1);
    t.prepare();
    const auto a = t.solve({6, 0});
    CHECK(relative_error(a[0], 6.0 / 11) < 1e-15);
    CHECK(relative_error(a[1], -0.6 / 11) < 1e-15);
    t.react();
    CHECK(relative_error(t.torque(0), -60.0 / 11) < 1e-15);
}

TEST_CASE("Impulse: J_eff = J1 + r^2 J2 to 1e-12 for |r| <= 100 and mass ratios to 1e4, at both levels")
{
    double worst = 0, once = 0;
    for (double r = 0.01; r <= 101; r *= std::pow(10.0, 0.25))
        for (double j = 1e-4; j <= 1.01e4; j *= 10)
            for (const double f : {r, -r})
            {
                Coupled t;
                t.add_shaft(1), t.add_shaft(j);
                t.impulse.add(0, 0, 1, f);
                t.prepare();
                const double reference = 1 / (1 + f * f * j);
                const auto a = t.solve({1, 0});
                worst = std::max({worst, relative_error(a[0], reference), relative_error(a[1], f * reference)});
                t.begin_accelerations({1, 0});
                t.sweep(1);
                once = std::max(once, relative_error(t.rates()[0], reference));
                t.shafts.speed[0] = 1;
                t.solve_speeds();
                worst = std::max({worst, relative_error(t.shafts.speed[0], reference), relative_error(t.shafts.speed[1], f * reference)});
            }
    MESSAGE("worst relative error of J_eff: swept ", worst, ", one sweep ", once);
    CHECK(worst < 1e-12);
}

TEST_CASE("Impulse at large ratios: one sweep loses digits by cancellation, the second restores them")
{
    for (const double f : {1e2, 1e4, 1e6})
    {
        Coupled t;
        t.add_shaft(1), t.add_shaft(3);
        t.impulse.add(0, 0, 1, f);
        t.prepare();
        const double reference = 1 / (1 + f * f * 3);
        t.begin_accelerations({1, 0});
        t.sweep(1);
        const double once = relative_error(t.rates()[0], reference);
        const double swept = relative_error(t.solve({1, 0})[0], reference);
        MESSAGE("ratio ", f, ": one sweep ", once, ", swept ", swept);
        CHECK(once < 1e-16 * f * f * 10);
        CHECK(swept < 1e-14);
    }
}

TEST_CASE("Impulse at the level of speeds is a plastic impact: momentum of the pair is conserved and the work is booked")
{
    Coupled t;
    t.add_shaft(1, 100), t.add_shaft(2, 0);
    t.impulse.add(0, 0, 1, -0.5);
    t.prepare();
    t.solve_speeds();
    CHECK(relative_error(t.shafts.speed[0], 200.0 / 3) < 1e-15);
    CHECK(relative_error(t.shafts.speed[1], -100.0 / 3) < 1e-15);
    std::vector<double> work(1, 0.0);
    t.coupling.account(work, 1);
    CHECK(relative_error(work[0], -5000.0 / 3) < 1e-14);
}

TEST_CASE("a train of Impulses agrees with the graph; sweeps grow with its length")
{
    for (const std::uint32_t n : {2u, 5u, 10u})
    {
        Coupled pairs, train;
        std::uint64_t seed = 3;
        std::vector<double> torque;
        for (std::uint32_t i = 0; i < n; ++i)
        {
            const double j = 0.5 + next_uniform(seed);
            pairs.add_shaft(j), train.add_shaft(j), torque.push_back(next_uniform(seed) - 0.5);
        }
        for (std::uint32_t i = 0; i + 1 < n; ++i)
        {
            const double f = 0.5 + next_uniform(seed);
            pairs.impulse.add(i, i, i + 1, f), train.gears.add(i, i, i + 1, f);
        }
        pairs.prepare(), train.prepare();
        pairs.begin_accelerations(torque);
        const auto report = pairs.sweep();
        CHECK(report.converged);
        MESSAGE(n, " shafts: ", report.sweeps, " sweeps");
        const auto a = pairs.rates(), b = train.solve(torque);
        pairs.react(), train.react();
        double size = 0;
        for (const double x : b) size = std::max(size, std::fabs(x));
        for (std::uint32_t i = 0; i < n; ++i) CHECK(std::fabs(a[i] - b[i]) < 1e-12 * size);
        for (std::uint32_t i = 0; i + 1 < n; ++i) CHECK(std::fabs(pairs.torque(i) - train.torque(i)) < 1e-11 * (1 + size));
    }
}

TEST_CASE("Assign is one-way: the driver is not affected, the driven shaft copies it; chains converge in any order")
{
    const std::vector<std::vector<std::uint32_t>> orders = {{0, 1, 2, 3}, {3, 2, 1, 0}, {2, 0, 3, 1}};
    for (const auto& order : orders)
    {
        Coupled t;
        for (int i = 0; i < 5; ++i) t.add_shaft(1 + i, i);
        for (const std::uint32_t k : order) t.assign.add(k, k, k + 1, -0.5);
        t.prepare();
        CHECK(t.solve({3, 100, 0, 0, 7}) == std::vector<double>{3, -1.5, 0.75, -0.375, 0.1875});
        t.react();
        CHECK(t.torque(0) == 2 * -1.5 - 100);  // the torque that holds s1 to that
        t.shafts.speed[0] = 8;
        t.solve_speeds();
        CHECK(t.shafts.speed == std::vector<double>{8, -4, 2, -1, 0.5});
    }
}

TEST_CASE("Assign books the energy that it adds without a source")
{
    Coupled t;
    t.add_shaft(1, 10), t.add_shaft(2, 3), t.add_shaft(5, 6);
    t.assign.add(0, 0, 1, 1);
    t.gears.add(1, 1, 2, 2);
    t.prepare();
    std::vector<double> work(2, 0.0);
    t.solve_speeds();
    t.coupling.account(work, 1);
    CHECK(t.shafts.speed == std::vector<double>{10, 10, 20});
    CHECK(relative_error(work[0], (100 + 1000) - (9 + 90)) < 1e-15);
    const auto a = t.solve({3, 4, 0});
    CHECK(a == std::vector<double>{3, 3, 6});
    std::vector<double> power(2, 0.0);
    t.coupling.account(power, 1);
    CHECK(relative_error(power[0], (22.0 * 3 - 4) * 10) < 1e-15);  // J_root alpha - tau, at 10 rad/s
    t.react();
    CHECK(relative_error(t.torque(0), 22.0 * 3 - 4) < 1e-15);
    CHECK(relative_error(t.torque(1), 5.0 * 6) < 1e-15);
}

TEST_CASE("Assign, Impulse and Graph in one train: reflected inertias add up behind the drive")
{
    // s0 => s1 (copy), s1 ~ s2 (graph, 2), s2 - s3 (impulse, -3), s3 ~ s4 (graph, 1/2), s4 - s5 (impulse, 4)
    Coupled t;
    for (const double j : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) t.add_shaft(j);
    t.assign.add(0, 0, 1, 1.5);
    t.gears.add(1, 1, 2, 2), t.gears.add(3, 3, 4, 0.5);
    t.impulse.add(2, 2, 3, -3), t.impulse.add(4, 4, 5, 4);
    t.prepare();
    const auto a = t.solve({2, 0, 0, 0, 0, 1});
    const std::vector<double> reference = {2, 3, 6, -18, -9, -36};
    for (std::size_t i = 0; i < 6; ++i) CHECK(relative_error(a[i], reference[i]) < 1e-13);
    t.react();
    CHECK(relative_error(t.torque(4), 6 * -36.0 - 1) < 1e-12);
    const double on_s4 = -4 * (6 * -36.0 - 1);
    const double mesh3 = 5 * -9.0 - on_s4;  // graph coupling on s4
    CHECK(relative_error(t.torque(3), mesh3) < 1e-12);
    CHECK(relative_error(t.torque(2), 4 * -18.0 + 0.5 * mesh3) < 1e-12);

    // Without the drive, a torque on s1 accelerates all of them.
    Coupled free;
    for (const double j : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) free.add_shaft(j);
    free.gears.add(1, 1, 2, 2), free.gears.add(3, 3, 4, 0.5);
    free.impulse.add(2, 2, 3, -3), free.impulse.add(4, 4, 5, 4);
    free.prepare();
    const auto b = free.solve({0, 1, 0, 0, 0, 0});
    CHECK(relative_error(b[1], 1 / (2 + 3 * 4.0 + 4 * 36.0 + 5 * 9.0 + 6 * 144.0)) < 1e-12);
}

TEST_CASE("a joined shaft's mobility is reflected; a driven train has none and keeps its rate")
{
    Train t;
    t.add_shaft(2, 3), t.add_shaft(5, -6);
    t.gear(0, 1, -2.0);
    t.build();
    t.begin_speeds();
    t.coupling.start_sweep();
    t.coupling.begin(1, shaft(1));
    CHECK(relative_error(t.coupling.mobility(shaft(0)), 1.0 / 22) < 1e-15);
    CHECK(relative_error(t.coupling.mobility(shaft(1)), 4.0 / 22) < 1e-15);
    t.coupling.apply(shaft(1), 11);
    CHECK(relative_error(t.coupling.rate(shaft(1)), -4) < 1e-15);
    CHECK(relative_error(t.coupling.rate(shaft(0)), 2) < 1e-15);
    t.coupling.begin(2, shaft(1));
    t.coupling.assign(shaft(1), 10);
    CHECK(t.coupling.rate(shaft(0)) == -5);
    CHECK(t.coupling.mobility(shaft(0)) == 0);
    t.coupling.begin(1, shaft(1));
    t.coupling.apply(shaft(1), 11);
    CHECK(t.coupling.rate(shaft(1)) == 10);
}

TEST_CASE("at the level of speeds the work of all couplings adds up to the change of energy, drives included")
{
    Coupled t;
    for (const double w : {2.0, 1.0, 0.0, -3.0, 4.0, 7.0}) t.add_shaft(1 + w * w, w);
    t.assign.add(0, 0, 1, 1.5);
    t.gears.add(1, 1, 2, -2);
    t.impulse.add(2, 2, 3, 0.7), t.impulse.add(3, 3, 4, 2), t.impulse.add(4, 0, 5, 0.3);
    t.prepare();
    const auto energy = [&t]
    {
        double e = 0;
        for (std::uint32_t i = 0; i < 6; ++i) e += t.shafts.kinetic_energy(i);
        return e;
    };
    const double before = energy();
    std::vector<double> work(5, 0.0);
    t.graph.engage(t.shafts, &work);
    t.solve_speeds();
    t.coupling.account(work, 1);
    CHECK(relative_error(work[0] + work[1] + work[2] + work[3] + work[4], energy() - before) < 1e-13);
    CHECK(t.shafts.speed[2] == doctest::Approx(-3 * t.shafts.speed[0]).epsilon(1e-13));
    CHECK(t.shafts.speed[4] == doctest::Approx(2 * t.shafts.speed[3]).epsilon(1e-13));
}

TEST_CASE("a solve includes its own members only: another branch of a prescribed shaft is not affected")
{
    Train t;
    t.add_shaft(1, 2, Motion::Kinematic), t.add_shaft(1), t.add_shaft(1);
    const auto g0 = t.gear(0, 1, 1.0), g1 = t.gear(0, 2, 1.0);
    t.build();
    t.begin_accelerations({0, 5, 7});
    const std::vector<std::uint32_t> branch = {2};
    const std::vector<double> torque = {0, 5, 3};
    t.coupling.begin_accelerations(t.graph, t.shafts, torque, branch, {});
    t.react();
    CHECK_FALSE(t.torques.torque(g0).has_value());
    CHECK(t.torque(g1) == -3);
    std::vector<double> power(2, 0.0);
    t.coupling.account(power, 1);
    CHECK(power == std::vector<double>{0, -6});
}

TEST_CASE("cycles of drives do not converge, and two drives of one train are reported; the first one acts")
{
    Coupled circle;
    circle.add_shaft(1, 1), circle.add_shaft(1, 1);
    circle.assign.add(0, 0, 1, 2), circle.assign.add(1, 1, 0, 2);
    circle.prepare();
    circle.begin_speeds();
    const auto report = circle.sweep(50);
    CHECK_FALSE(report.converged);
    CHECK(report.sweeps == 50);
    CHECK(report.residual > 0.1);

    Coupled two;
    for (const double w : {1.0, 2.0, 0.0, 0.0}) two.add_shaft(1, w);
    two.gears.add(0, 2, 3, 1);
    two.assign.add(1, 0, 2, 1), two.assign.add(2, 1, 3, 1);
    two.prepare();
    two.begin_speeds();
    const auto conflict = two.sweep().conflict;
    REQUIRE(conflict.has_value());
    CHECK(conflict->first == 1);
    CHECK(conflict->second == 2);
    CHECK(conflict->shaft == 3);
    CHECK(conflict->first_rate == 1);
    CHECK(conflict->second_rate == 2);
    two.coupling.store_speeds(two.shafts);
    CHECK(two.shafts.speed == std::vector<double>{1, 2, 1, 1});
    two.shafts.speed[1] = 1;
    two.begin_speeds();
    CHECK_FALSE(two.sweep().conflict.has_value());
}

TEST_CASE("sweeps end if a contradiction alternates for ever, and not if a change has to pass many couplings")
{
    Coupled loop;
    for (const double w : {1.0, 2.0, 6.0}) loop.add_shaft(1, w);
    loop.impulse.add(0, 0, 1, 2), loop.impulse.add(1, 1, 2, 3), loop.impulse.add(2, 2, 0, 1 / 6.0001);
    loop.prepare(), loop.begin_speeds();
    const auto report = loop.sweep();
    CHECK_FALSE(report.converged);
    CHECK(report.sweeps == 64);
    CHECK(std::fabs(std::log10(report.residual) + 5.5) < 1.5);
    Coupled line;  // against the order of its rows a change passes one coupling in each sweep
    for (int i = 0; i < 200; ++i) line.add_shaft(1, i == 199 ? 1 : 0);
    for (std::uint32_t i = 0; i < 199; ++i) line.impulse.add(i, i, i + 1, 1);
    line.prepare(), line.begin_speeds();
    CHECK(line.sweep().sweeps == simulation::kMaxCouplingSweeps);
}

TEST_CASE("a rate that is not a number does not count as converged")
{
    Coupled t;
    t.add_shaft(1, NAN), t.add_shaft(1, 1);
    t.impulse.add(0, 0, 1, 2);
    t.prepare();
    t.begin_speeds();
    CHECK_FALSE(t.sweep(10).converged);
}

TEST_CASE("uncoupled shafts keep their bits, and so do those that already agree")
{
    Coupled t;
    for (const double w : {0.1, 0.2, 0.3, -0.6, 1e-300}) t.add_shaft(0.7, w);
    t.impulse.add(0, 0, 1, 2), t.gears.add(1, 2, 3, -2);
    t.prepare();
    t.shafts.speed[3] = -2 * t.shafts.speed[2];
    const auto before = t.shafts.speed;
    t.graph.engage(t.shafts);
    t.solve_speeds();
    CHECK(t.shafts.speed == before);
    // The acceleration of an uncoupled shaft is its torque over its inertia, to the bit.
    CHECK(t.solve({0, 0, 0, 0, 0.3})[4] == 0.3 / 0.7);
}

TEST_CASE("an Impulse against prescribed motion, and between two prescribed shafts")
{
    Coupled t;
    t.add_shaft(1, 3, Motion::Kinematic), t.add_shaft(2, 0), t.add_shaft(1, 7, Motion::Kinematic);
    t.impulse.add(0, 0, 1, 2), t.impulse.add(1, 0, 2, 1);
    t.prepare();
    t.solve_speeds();
    CHECK(t.shafts.speed == std::vector<double>{3, 6, 7});
    std::vector<double> work(2, 0.0);
    t.coupling.account(work, 1);
    CHECK(relative_error(work[0], 36) < 1e-15);
    CHECK(work[1] == 0);
    CHECK(t.solve({0, 5, 0})[1] == 0);
    t.react();
    CHECK(t.torque(0) == -5);
}

TEST_CASE("a line of 1000 gears costs microseconds per evaluation")
{
    Train t;
    for (int i = 0; i < 1000; ++i) t.add_shaft(1);
    for (std::uint32_t i = 0; i + 1 < 1000; ++i) t.gear(i, i + 1, i % 2 == 0 ? -0.5 : -2.0);
    t.build();
    std::vector<double> torque(1000, 0.001), out(1000);
    const auto begin = std::chrono::steady_clock::now();
    for (int k = 0; k < 2000; ++k)
    {
        t.coupling.begin_accelerations(t.graph, t.shafts, torque, t.members, t.prescribed);
        t.shafts.speed[0] += 1e-3 * t.coupling.rate(shaft(0));
        t.graph.derive(t.shafts);
    }
    const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - begin;
    const double per_shaft = spent.count() / 2000 / 1000;
    MESSAGE("ns per shaft and evaluation: ", per_shaft);
    CHECK(per_shaft < 500);  // a bound for slow and instrumented builds; about 5 where nothing else runs
}
