// A stiff spring on a slider at any step: m = 1 on a vertical slider, k = 1e6, c = 20, rest position 0.01 m below the start, 1 s
// (1000 rad/s); and 1e-3 kg against 1e3 kg on k = 1e6. References: the damped oscillator.
//
// algorithm                  steps of                position rel. to 0.01 m    ledger, relative to the spring's energy
// Exponential                1/2 .. 1/1000 s         1e-11                       1e-9
// Automatic                  1/2 .. 1/240 s          1e-9                        1e-8
#include "exact/motions.h"
#include "reference/motion.h"
#include "support/gravity.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kStiffness = 1e6, kDamping = 20, kStretch = 0.01;

/// m, displacement below the start.
double exact_position(double t)
{
    // The mass swings about its place of rest, which lies below the start.
    const double rest = kStretch + kG / kStiffness;
    double above = 0, speed = 0;
    exact::Damped{kStiffness, 0.5 * kDamping}.at(t, rest, 0, above, speed);
    return rest - above;
}

std::string on_slider(const SolverAlgorithm& algorithm)
{
    return solver(algorithm) + R"(<component id="mass" type="State/RigidBody" mass="1" inertia="1 1 1"/>
        <component id="rail" type="Constraint/Slider" b="mass" anchor="0 0 0" axis="0 0 1"/>
        <component id="spring" type="Constraint/SpringDamper" b="mass" anchor_a="0 0 -1" anchor_b="0 0 0" length="0.99"
            stiffness="1e6" damping="20"/>
        <component id="g" type="Field/Gravity" between="mass" acceleration="0 0 -9.81"/>)";
}

double sum(const std::vector<double>& all)
{
    double out = 0;
    for (const double w : all) out += w;
    return out;
}

}  // namespace

TEST_CASE("a spring of 1000 rad/s on a slider is correct at any step, and its energy ledger closes")
{
    struct Row
    {
        SolverAlgorithm algorithm;
        int steps;
        double place, ledger;
    };
    for (const Row& row :
         {Row{{"Exponential"}, 2, 1e-11, 1e-9}, Row{{"Exponential"}, 10, 1e-11, 1e-9}, Row{{"Exponential"}, 60, 1e-11, 1e-9},
          Row{{"Exponential"}, 1000, 1e-11, 1e-9}, Row{{"Automatic"}, 2, 1e-9, 1e-8}, Row{{"Automatic"}, 10, 1e-9, 1e-8},
          Row{{"Automatic"}, 60, 1e-9, 1e-8}, Row{{"Automatic"}, 240, 1e-9, 1e-8}})
    {
        CAPTURE(row.algorithm.type);
        CAPTURE(row.steps);
        Scene s(on_slider(row.algorithm), per_second(row.steps));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        double worst = 0, books = 0;
        for (int i = 1; i <= row.steps; ++i)
        {
            s.step();
            worst = std::fmax(worst, std::fabs(s.vec("mass", "position").z + exact_position(s.simulation().time())));
            books = std::fmax(books, std::fabs(s.simulation().totals().kinetic - sum(s.simulation().stepper().work())));
        }
        MESSAGE(row.algorithm.type << " 1/" << row.steps << ": " << worst / kStretch << " " << books / 50);
        CHECK(worst < row.place * kStretch);
        CHECK(books < row.ledger * 0.5 * kStiffness * kStretch * kStretch);
    }
}

TEST_CASE("1e-3 kg against 1e3 kg on a stiff spring: the stretch by its closed form, momentum to rounding, at any step")
{
    const double light = 1e-3, heavy = 1e3, reduced = light * heavy / (light + heavy), c = 2 * 0.01 * std::sqrt(kStiffness * reduced);
    for (const int steps : {2, 10, 60, 240})
        for (const SolverAlgorithm& algorithm : {SolverAlgorithm{"Exponential"}, SolverAlgorithm{"Automatic"}})
        {
            CAPTURE(algorithm.type);
            CAPTURE(steps);
            char damping[32];
            std::snprintf(damping, sizeof damping, "%.17g", c);
            Scene s(solver(algorithm) + R"(<component id="a" type="State/RigidBody" mass="1e-3" inertia="1e-5 1e-5 1e-5"/>
                <component id="b" type="State/RigidBody" mass="1e3" inertia="100 100 100" position="1.01 0 0"/>
                <component id="spring" type="Constraint/SpringDamper" a="a" b="b" anchor_a="0 0 0" anchor_b="0 0 0" length="1" stiffness="1e6" damping=")" +
                        damping + "\"/>",
                    per_second(steps));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.run(0.5);
            double stretch = 0, speed = 0;
            exact::Damped{kStiffness / reduced, 0.01 * std::sqrt(kStiffness / reduced)}.at(0.5, 0.01, 0, stretch, speed);
            CHECK(std::fabs(distance(s.vec("a", "position"), s.vec("b", "position")) - 1 - stretch) < 1e-11);
            CHECK(length(s.simulation().totals().momentum) < 1e-10);
        }
}

TEST_CASE("a stiff spring that nothing holds to its line oscillates along it, in any direction")
{
    // Across the line it pushes outwards and inwards alternately, 16 rad per step: a method that is exact on the line would let
    // rounding grow across it.
    for (const SolverAlgorithm& algorithm : {SolverAlgorithm{"Exponential"}, SolverAlgorithm{"Automatic"}})
        for (const std::string place : {"1.1 0 0", "0.66 0.88 0"})
        {
            CAPTURE(algorithm.type);
            CAPTURE(place);
            Scene s(solver(algorithm) + R"(<component id="mass" type="State/RigidBody" mass="1" inertia="1 1 1" position=")" + place +
                        R"("/><component id="spring" type="Constraint/SpringDamper" b="mass" anchor_a="0 0 0" anchor_b="0 0 0" length="1"
                            stiffness="1e6"/>)",
                    per_second(60));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.run(0.5);
            CHECK(std::fabs(length(s.vec("mass", "position")) - 1 - 0.1 * std::cos(500.0)) < 1e-7);
        }
}
