// B1, B3 and B4 by the algorithms: a spring from soft to 1e12 N/m, quadratic drag, stiff drag. References: closed forms.
//
// B1, m = 1, damping ratio 0.05, from rest at 1 m, 0.3 s; error of the position in m
//   algorithm                    step      k
//   Exponential                  1e-2 s    1e2 .. 1e12: 1e-12
//   Automatic                    1e-2 s    the same from 1e4 on; 1e2: 1e-5 (RungeKutta4)
//   Radau5                       1e-2 s    1e2 .. 1e12: 1e-8
//   ImplicitMidpoint             1e-2 s    1e2 .. 1e12: it oscillates within the amplitude, and does not diverge; order 2 at k = 1e2
//   DormandPrince54              1e-2 s    1e2 .. 1e8: 1e-8
//   RungeKutta4, RotationSplitting, StoermerVerlet, SemiImplicitEuler
//                                1e-3 s    k = 1e2, 1e4: the table below, with orders; beyond 2.8 / w (2 / w): not_finite is reported
// B3, quadratic drag 0.01 kg/m: v(5), y(5), and the final speed; B4, c / m = 1e6 1/s, wind of 10 m/s from t = 0
#include <vector>

#include "exact/motions.h"
#include "reference/motion.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// m and m/s.
struct Swing
{
    double place = 0, speed = 0;
};

/// With damping ratio 0.05, from rest at 1 m.
Swing exact_swing(double k, double t)
{
    Swing out;
    exact::Damped{k, 0.05 * std::sqrt(k)}.at(t, 1, 0, out.place, out.speed);
    return out;
}

/// m, of the position and of the speed divided by w: the error of the position alone passes 0 in each oscillation.
double spring_error(const SolverAlgorithm& algorithm, double k, const std::string& step)
{
    Scene s(spring_scene(algorithm, k, 0.1 * std::sqrt(k)), step);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(0.3);
    const Swing due = exact_swing(k, 0.3);
    return std::hypot(s.vec("mass", "position").x - due.place, (s.vec("mass", "linear_velocity").x - due.speed) / std::sqrt(k));
}

struct Fall
{
    double speed = 0, place = 0, last = 0;  ///< relative errors at 5 s, and of the final speed at 65 s
};

Fall fall_error(const SolverAlgorithm& algorithm, int steps)
{
    Scene s(solver(algorithm) + R"(<component id="ball" type="State/RigidBody" mass="1" inertia="1 1 1"/>
                              <component id="g" type="Field/Gravity" between="ball"/>
                              <component id="drag" type="Field/Drag" between="ball" quadratic="0.01"/>)",
            per_second(steps));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.run(5);
    Fall out;
    out.speed = std::fabs(s.vec("ball", "linear_velocity").z / -28.7023194557054083 - 1);
    out.place = std::fabs(s.vec("ball", "position").z / -91.5600402510837169 - 1);
    s.run(65);
    out.last = std::fabs(s.vec("ball", "linear_velocity").z / -31.3209195267316505 - 1);
    return out;
}

Scene windy(const SolverAlgorithm& algorithm, const std::string& step)
{
    return Scene(solver(algorithm) + R"(<component id="ball" type="State/RigidBody" mass="1" inertia="1 1 1"/>
                                   <component id="drag" type="Field/Drag" between="ball" linear="1e6" medium_velocity="10 0 0"/>)",
                 step);
}

}  // namespace

TEST_CASE("B1: the references of the closed form")
{
    CHECK(exact_swing(1e2, 0.3).place == doctest::Approx(-0.84539188273933843).epsilon(1e-14));
    CHECK(exact_swing(1e6, 0.3).place / -1.3249336825406493e-7 == doctest::Approx(1).epsilon(1e-9));
}

TEST_CASE(
    "B1: springs of 1e2 to 1e12 N/m in steps of 10 ms: the stiff algorithms are accurate, the explicit one with error control up to 1e8")
{
    for (const double k : {1e2, 1e4, 1e6, 1e8, 1e10, 1e12})
    {
        CAPTURE(k);
        for (const SolverAlgorithm& algorithm : {SolverAlgorithm{"Exponential"}, SolverAlgorithm{"Automatic"}})
        {
            const double error = spring_error(algorithm, k, "dt=\"1/100\"");
            MESSAGE(algorithm.type << " " << k << ": " << error);
            CHECK(error < (algorithm.type == "Automatic" && k < 1e3 ? 1e-5 : 1e-12));  // there it is RungeKutta4
        }
        const double radau = spring_error({"Radau5"}, k, "dt=\"1/100\"");
        MESSAGE("Radau5 " << k << ": " << radau);
        CHECK(radau < 1e-8);
        const double midpoint = spring_error({"ImplicitMidpoint"}, k, "dt=\"1/100\"");
        MESSAGE("ImplicitMidpoint " << k << ": " << midpoint);
        CHECK(midpoint < 2);  // twice the amplitude: it stays within the amplitude, at an arbitrary phase
        if (k > 1e8) continue;
        const double pair = spring_error({"DormandPrince54"}, k, "dt=\"1/100\"");
        MESSAGE("DormandPrince54 " << k << ": " << pair);
        CHECK(pair < 1e-8);
    }
}

TEST_CASE("B1: algorithms of fixed step below their limit, with their orders")
{
    struct Row
    {
        SolverAlgorithm algorithm;
        int order;
        double soft, stiffer;  ///< m, at 1/1000 with k = 1e2 and 1e4
    };
    const Row table[] = {
        {{"SemiImplicitEuler"}, 1, 1e-2, 0.1}, {{"StoermerVerlet"}, 2, 3e-5, 1e-2}, {{"RotationSplitting", "order=\"2\""}, 2, 3e-5, 1e-2},
        {{"ImplicitMidpoint"}, 2, 3e-5, 1e-2}, {{"RungeKutta4"}, 4, 1e-9, 2e-5},    {{"RotationSplitting"}, 4, 1e-12, 1e-7}};
    for (const Row& row : table)
    {
        CAPTURE(row.algorithm.type);
        CAPTURE(row.algorithm.attributes);
        const double soft = spring_error(row.algorithm, 1e2, per_second(1000)),
                     stiffer = spring_error(row.algorithm, 1e4, per_second(1000));
        const double coarse = spring_error(row.algorithm, 1e2, per_second(100)), middle = spring_error(row.algorithm, 1e2, per_second(200)),
                     fine = spring_error(row.algorithm, 1e2, per_second(400));
        MESSAGE(row.algorithm.type << ": " << soft << " " << stiffer << " orders " << observed_order(coarse, middle) << " "
                                   << observed_order(middle, fine));
        CHECK(soft < row.soft);
        CHECK(stiffer < row.stiffer);
        CHECK(observed_order(coarse, middle) == doctest::Approx(row.order).epsilon(0.15));
        CHECK(observed_order(middle, fine) == doctest::Approx(row.order).epsilon(0.1));
    }
}

TEST_CASE("B1: beyond its limit an explicit algorithm is reported by name and never gives a silent NaN")
{
    for (const SolverAlgorithm& algorithm :
         {SolverAlgorithm{"SemiImplicitEuler"}, SolverAlgorithm{"StoermerVerlet"}, SolverAlgorithm{"RungeKutta4"},
          SolverAlgorithm{"RotationSplitting"}, SolverAlgorithm{"RotationSplitting", "order=\"2\""}})
    {
        CAPTURE(algorithm.type);
        Scene s(spring_scene(algorithm, 1e8, 0), "dt=\"1/100\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.warnings_expected = s.keep_events = true;
        s.step(400);
        CHECK(s.count("state.not_finite") >= 1);
        CHECK(is_finite(s.vec("mass", "position")));
    }
}

TEST_CASE("B3: quadratic drag with the algorithms")
{
    struct Row
    {
        SolverAlgorithm algorithm;
        int steps, order;  ///< 0: error control
        double bound, last;
    };
    const Row table[] = {{{"SemiImplicitEuler"}, 240, 1, 2e-3, 1e-12},
                         {{"StoermerVerlet"}, 240, 2, 1e-6, 1e-12},
                         {{"RotationSplitting", "order=\"2\""}, 240, 2, 1e-6, 1e-12},
                         {{"ImplicitMidpoint"}, 240, 2, 1e-6, 1e-12},
                         {{"RungeKutta4"}, 240, 4, 1e-12, 1e-12},
                         {{"Automatic"}, 240, 4, 1e-12, 1e-12},
                         {{"RotationSplitting"}, 240, 4, 1e-12, 1e-12},
                         {{"Exponential"}, 240, 4, 1e-12, 1e-12},
                         {{"DormandPrince54"}, 10, 0, 1e-11, 1e-12},
                         {{"Radau5"}, 10, 0, 1e-8, 1e-12}};
    for (const Row& row : table)
    {
        CAPTURE(row.algorithm.type);
        CAPTURE(row.algorithm.attributes);
        const Fall error = fall_error(row.algorithm, row.steps);
        MESSAGE(row.algorithm.type << ": " << error.speed << " " << error.place << " " << error.last);
        CHECK(error.speed < row.bound);
        CHECK(error.place < row.bound);
        CHECK(error.last < row.last);
        if (row.order == 0) continue;
        const double order = observed_order(fall_error(row.algorithm, 10).place, fall_error(row.algorithm, 20).place);
        MESSAGE("order " << order);
        CHECK(order == doctest::Approx(row.order).epsilon(0.15));
    }
}

TEST_CASE("B4: a jump of the wind on stiff drag")
{
    struct Row
    {
        SolverAlgorithm algorithm;
        double speed, place;  ///< m/s, m, at 1 s in steps of 0.01 s
    };
    for (const Row& row : {Row{{"Exponential"}, 1e-12, 1e-12}, Row{{"Automatic"}, 1e-12, 1e-12}, Row{{"Radau5"}, 1e-8, 1e-8}})
    {
        CAPTURE(row.algorithm.type);
        Scene s = windy(row.algorithm, "dt=\"1/100\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.run(1);
        const double speed = std::fabs(s.vec("ball", "linear_velocity").x - 10),
                     place = std::fabs(s.vec("ball", "position").x - (10 - 1e-5));
        MESSAGE(row.algorithm.type << ": " << speed << " " << place);
        CHECK(speed < row.speed);
        CHECK(place < row.place);
    }
    // A-stable, not L-stable: it oscillates about the solution, and never leaves (0, 20).
    Scene midpoint = windy({"ImplicitMidpoint"}, "dt=\"1/100\"");
    for (int i = 0; i < 100; ++i)
    {
        midpoint.step();
        CHECK(std::fabs(midpoint.vec("ball", "linear_velocity").x - 10) < 10.001);
    }
    // The transient itself.
    for (const SolverAlgorithm& algorithm :
         {SolverAlgorithm{"DormandPrince54"}, SolverAlgorithm{"RungeKutta4"}, SolverAlgorithm{"Radau5"}, SolverAlgorithm{"Exponential"}})
    {
        CAPTURE(algorithm.type);
        Scene s = windy(algorithm, "dt=\"1e-7\"");
        s.run(2e-6);
        const double error = std::fabs(s.vec("ball", "linear_velocity").x - 10 * (1 - std::exp(-2.0)));
        MESSAGE(algorithm.type << ": " << error);
        CHECK(error < 1e-5);
    }
}

TEST_CASE("B4: explicit algorithms that cannot follow report that")
{
    Scene pair = windy({"DormandPrince54", "max_substeps=\"1000\""}, "dt=\"1/100\"");
    pair.warnings_expected = pair.keep_events = true;
    pair.step(2);
    CHECK(pair.count("solver.gave_up") >= 1);
    for (const SolverAlgorithm& algorithm : {SolverAlgorithm{"SemiImplicitEuler"}, SolverAlgorithm{"StoermerVerlet"},
                                             SolverAlgorithm{"RungeKutta4"}, SolverAlgorithm{"RotationSplitting"}})
    {
        CAPTURE(algorithm.type);
        Scene s = windy(algorithm, "dt=\"1/100\"");
        s.warnings_expected = s.keep_events = true;
        s.step(200);
        CHECK(s.count("state.not_finite") >= 1);
        CHECK(is_finite(s.vec("ball", "linear_velocity")));
    }
}
