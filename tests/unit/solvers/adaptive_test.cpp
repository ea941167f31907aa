/// Solver/DormandPrince54: the error follows the tolerance, the ledger closes, no memory between steps, limits are reported.
#include "objects/solvers/dormand_prince54.h"
#include "unit/solvers/problems.h"

using namespace plab;
using namespace plab::solvers;
using namespace plab::test;

namespace
{

struct Adaptive : Solver<DormandPrince54Rows>
{
    explicit Adaptive(double tolerance) : Solver(advance_dormand_prince54)
    {
        rows.relative_tolerance[0] = tolerance, rows.absolute_tolerance[0] = 1e-3 * tolerance;
    }
};

double planet_error(const Points& p) { return std::hypot(p.place[0] - kPlanetAt10[0], p.place[1] - kPlanetAt10[1]); }

}  // namespace

TEST_CASE("a planet's error follows the tolerance, and the work its fifth root")
{
    double evaluations = 0, error = 0;
    for (const double tolerance : {1e-7, 1e-9, 1e-11})
    {
        Adaptive solver(tolerance);
        Points p = planet();
        p.run(10, 1, std::ref(solver));
        MESSAGE("Kepler, e = 0.9, tolerance " << tolerance << ": error " << planet_error(p) << " at t = 10, "
                                              << p.evaluations * 2 * M_PI / 10 << " evaluations per orbit");
        CHECK(planet_error(p) < 50 * tolerance);
        CHECK(p.booked == doctest::Approx(1).epsilon(1e-9));
        const double gained = 0.5 * (std::pow(p.speed(0), 2) + std::pow(p.speed(1), 2)) - 0.5 * 19;
        CHECK(std::fabs(p.work - gained) < 50 * tolerance);
        if (evaluations > 0) CHECK(p.evaluations / evaluations == doctest::Approx(std::pow(100, 0.2)).epsilon(0.15));
        if (error > 0) CHECK(error / planet_error(p) > 10);
        evaluations = p.evaluations, error = planet_error(p);
        CHECK(solver.rows.evaluations[0] == p.evaluations);
    }
}

TEST_CASE("the order of a smooth step taken whole is 5")
{
    // A tolerance so loose that each step is taken at once.
    const auto error = [](int steps)
    {
        Adaptive solver(1e3);
        Points p = driven_oscillator();
        p.run(3.0 / steps, steps, std::ref(solver));
        CHECK(solver.rows.substeps[0] == 1);
        return std::fabs(p.place[0] - driven_place(3));
    };
    CHECK(order_of(error, 60) == doctest::Approx(5).epsilon(0.03));
}

TEST_CASE("trials and repetitions of an advance give the same bits and book the same; a trial leaves no trace")
{
    Adaptive first(1e-9), again(1e-9), trial(1e-9);
    trial.trial = true;
    Points a = planet(), b = planet(), c = planet();
    a.run(0.05, 40, std::ref(first));
    Points other = falling_with_drag();
    again(0.3, other);  // another group in between
    b.run(0.05, 40, std::ref(again));
    c.run(0.05, 40, std::ref(trial));
    CHECK(a.place == b.place);
    CHECK(a.place == c.place);
    CHECK(trial.rows.evaluations[0] == 0);
    // The ledger belongs to the host, which removes by a trial what an event rewinds.
    CHECK(c.booked == a.booked);
    CHECK(c.work == a.work);
}

TEST_CASE("quadratic drag, and a free box")
{
    Adaptive solver(1e-12);
    Points p = falling_with_drag();
    p.run(0.1, 50, std::ref(solver));
    CHECK(p.speed() == doctest::Approx(kDragSpeedAt5).epsilon(1e-11));
    CHECK(p.place[0] == doctest::Approx(kDragPlaceAt5).epsilon(1e-11));
    Body box(diagonal(kBoxInertia), kBoxSpin);
    box.run(0.1, 50, std::ref(solver));
    CHECK(attitude_error(box.orientation, kBoxAt5) < 1e-10);
}

TEST_CASE("the last internal step ends exactly at the end, and no evaluation is beyond it")
{
    double latest = 0;
    Points p({1}, {0}, [&](double t, const auto& q, const auto&, auto& a) { latest = std::fmax(latest, t), a[0] = -1e4 * q[0]; });
    Adaptive solver(1e-9);
    p.run(0.25, 1, std::ref(solver));
    CHECK(latest == 0.25);
    CHECK(solver.rows.substeps[0] > 10);
    CHECK(p.place[0] == doctest::Approx(std::cos(25.0)).epsilon(1e-7));
}

TEST_CASE("too many internal steps: reported, finite, and without a hang")
{
    Adaptive solver(1e-9);
    solver.rows.max_substeps[0] = 50;
    Points p({1}, {0}, [](double, const auto& q, const auto&, auto& a) { a[0] = -1e10 * q[0]; });
    p.run(1, 1, std::ref(solver));
    CHECK(solver.events.count("solver.gave_up") == 1);
    CHECK(std::isfinite(p.place[0]));
    CHECK(std::isfinite(p.speed()));

    // A force that is NaN everywhere.
    Adaptive lost(1e-9);
    Points nan({1}, {0}, [](double, const auto&, const auto&, auto& a) { a[0] = std::nan(""); });
    nan.run(1, 1, std::ref(lost));
    CHECK(lost.events.count("solver.gave_up") == 1);
    CHECK(nan.place[0] == 1);
    CHECK(nan.evaluations < 10000);
}
