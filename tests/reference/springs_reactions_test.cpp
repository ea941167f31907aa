// B5: stiff numbers with rates, the rates in scripts, whole runs in one to ten steps of the scene. References: test set for IVP solvers
// (Mazzia, Magherini), recomputed there in quadruple precision. Correct digits (scd: relative, of the worst component) at rtol 1e-9:
//
//   algorithm        Robertson, 1e11 s   van der Pol, 1e-6, 2 s   HIRES, 321.8122 s
//   Radau5           10.4                                                    with absolute_tolerance 1e-18
//   Radau5           6.3                 9.8                      8.3, 8.6   with its default, 1e-12; in 1 step, in 10
//   Automatic        6.3                 9.8                      8.6        is Radau5 with its defaults: it has no tolerances of its own
//   DormandPrince54  gives up, reported  gives up, reported       9.7
//
// Robertson's second number ends at 8e-14, below an absolute tolerance of 1e-12, so the relative one does not control it. Radau5
// computes eight digits of it with an absolute tolerance well below.
#include <vector>

#include "reference/algorithms.h"

using namespace plab;
using namespace plab::test;

namespace
{

struct Reaction
{
    std::string values, code;
    double until;
    std::vector<double> reference;
};

/// Its time is in units of 1e8 s, because steps of a scene are not as long.
const Reaction kRobertson{"1 0 0",
                          R"(local y = between[1]
                          local a, b, c = y:value(1), y:value(2), y:value(3)
                          local f, s = -0.04 * a + 1e4 * b * c, 3e7 * b * b
                          y:add_rate(1, 1e8 * f) y:add_rate(3, 1e8 * s) y:add_rate(2, -1e8 * (f + s)))",
                          1e3,
                          {0.2083340149701255e-7, 0.8333360770334713e-13, 0.9999999791665050}};
const Reaction kVanDerPol{"2 0",
                          R"(local y = between[1]
                          local a, b = y:value(1), y:value(2)
                          y:add_rate(1, b) y:add_rate(2, ((1 - a * a) * b - a) / 1e-6))",
                          2,
                          {0.1706167732170483e1, -0.8928097010247975}};
const Reaction kHires{"1 0 0 0 0 0 0 0.0057",
                      R"(local z = between[1]
                      local y = {}
                      for i = 1, 8 do y[i] = z:value(i) end
                      local fast = 280 * y[6] * y[8]
                      z:add_rate(1, -1.71 * y[1] + 0.43 * y[2] + 8.32 * y[3] + 0.0007)
                      z:add_rate(2, 1.71 * y[1] - 8.75 * y[2])
                      z:add_rate(3, -10.03 * y[3] + 0.43 * y[4] + 0.035 * y[5])
                      z:add_rate(4, 8.32 * y[2] + 1.71 * y[3] - 1.12 * y[4])
                      z:add_rate(5, -1.745 * y[5] + 0.43 * y[6] + 0.43 * y[7])
                      z:add_rate(6, -fast + 0.69 * y[4] + 1.71 * y[5] - 0.43 * y[6] + 0.69 * y[7])
                      z:add_rate(7, fast - 1.81 * y[7])
                      z:add_rate(8, -fast + 1.81 * y[7]))",
                      321.8122,
                      {0.7371312573325668e-3, 0.1442485726316185e-3, 0.5888729740967575e-4, 0.1175651343283149e-2, 0.2386356198831331e-2,
                       0.6238968252742796e-2, 0.2849998395185769e-2, 0.2850001604814231e-2}};

Scene scene_of(const Reaction& r, const SolverAlgorithm& algorithm, int steps)
{
    char dt[40];
    std::snprintf(dt, sizeof dt, "dt=\"%.17g\"", r.until / steps);
    return Scene(solver(algorithm) + "<component id=\"z\" type=\"State/Quantities\" values=\"" + r.values +
                     "\"/><component id=\"law\" type=\"Script/Lua\" between=\"z\"><param name=\"code\">function force(t, state) " + r.code +
                     " end</param></component>",
                 dt);
}

/// Correct digits of the worst component.
double scd(const Reaction& r, const SolverAlgorithm& algorithm, int steps)
{
    Scene s = scene_of(r, algorithm, steps);
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(steps);
    const Reals z = std::get<Reals>(s.get("z", "values"));
    double worst = 1e-16;
    for (std::size_t i = 0; i < r.reference.size(); ++i) worst = std::fmax(worst, std::fabs(z[i] / r.reference[i] - 1));
    return -std::log10(worst);
}

}  // namespace

TEST_CASE("B5: Radau5 has eight digits and more, with an absolute tolerance below the smallest number")
{
    struct Row
    {
        const Reaction* reaction;
        std::string attributes;
        int steps;
        double digits;
    };
    const std::string tight = "relative_tolerance=\"1e-9\" absolute_tolerance=\"1e-18\"",
                      usual = "relative_tolerance=\"1e-9\" absolute_tolerance=\"1e-12\"";
    for (const Row& row :
         {Row{&kRobertson, tight, 1, 10}, Row{&kRobertson, tight, 10, 10}, Row{&kVanDerPol, usual, 4, 9.5}, Row{&kHires, usual, 1, 8}})
    {
        const double digits = scd(*row.reaction, {"Radau5", row.attributes}, row.steps);
        MESSAGE(row.reaction->values << ": " << digits);
        CHECK(digits > row.digits);
    }
}

TEST_CASE("B5: Automatic detects that reactions are stiff, and has the digits of Radau5 with its defaults")
{
    for (const auto& [reaction, steps, digits] : {std::tuple{&kRobertson, 10, 6.0}, {&kVanDerPol, 4, 9.5}, {&kHires, 10, 8.5}})
    {
        const double found = scd(*reaction, {"Automatic"}, steps), radau = scd(*reaction, {"Radau5"}, steps);
        MESSAGE(reaction->values << ": " << found << ", Radau5 " << radau);
        CHECK(found > digits);
        CHECK(found == radau);
    }
    // The missing digits are due to the absolute tolerance: all but the second number, far below it, have nine digits.
    Scene s = scene_of(kRobertson, {"Automatic"}, 10);
    s.step(10);
    const Reals z = std::get<Reals>(s.get("z", "values"));
    CHECK(std::fabs(z[1] - kRobertson.reference[1]) < 1e-19);
    CHECK(std::fabs(z[2] / kRobertson.reference[2] - 1) < 1e-9);
}

TEST_CASE("B5: explicit steps give up and are named, or take a long time")
{
    Scene s = scene_of(kRobertson, {"DormandPrince54", "max_substeps=\"2000\""}, 1);
    s.warnings_expected = s.keep_events = true;
    s.step();
    REQUIRE(s.count("solver.gave_up") == 1);
    CHECK(s.events.back().message.find("Solver/Radau5") != std::string::npos);
    const double digits = scd(kHires, {"DormandPrince54"}, 10);
    MESSAGE("HIRES: " << digits);
    CHECK(digits > 9);
}

namespace
{

/// Relative, of the worst component.
double relative_error(const Reaction& r, const SolverAlgorithm& algorithm, int steps) { return std::pow(10, -scd(r, algorithm, steps)); }

}  // namespace

TEST_CASE("B5: HIRES with the solvers that are not made for it")
{
    // Its fastest rate is about 200 1/s for a while: explicit algorithms need 64000 (orders 1 and 2) or 32000 steps. Without
    // positions a kick is the whole of a step, so StoermerVerlet is Heun's method and RotationSplitting of order 2 is RungeKutta4.
    const auto error = [](const SolverAlgorithm& algorithm, int steps) { return relative_error(kHires, algorithm, steps); };
    const AlgorithmRow table[] = {
        {{"SemiImplicitEuler"}, 64000, 5.9e-4, 0}, {{"StoermerVerlet"}, 64000, 6.3e-6, 0}, {{"RungeKutta4"}, 32000, 1.1e-10, 0},
        {{"ImplicitMidpoint"}, 1000, 1.0e-2, 2},   {{"Exponential"}, 1000, 2.7e-7, 0},
    };
    for (const AlgorithmRow& row : table) check_algorithm(row, error);
    check_same({"RotationSplitting", "order=\"2\""}, {"RungeKutta4"}, 16000, error);
    // Beyond their limits they oscillate within the bounds of the nonlinear rates: wrong, finite, and without any report.
    CHECK(error({"SemiImplicitEuler"}, 32000) > 0.3);
    CHECK(error({"RotationSplitting"}, 8000) > 0.3);
}

TEST_CASE(
    "B5: Robertson and van der Pol in 1000 steps with the solvers that are not made for them: what they report, or how wrong they are")
{
    struct Row
    {
        SolverAlgorithm algorithm;
        std::string event;              ///< for both
        double robertson, van_der_pol;  ///< relative; 0: the event reports the failure
    };
    const Row table[] = {
        {{"SemiImplicitEuler"}, "lost", 0, 0},
        {{"StoermerVerlet"}, "lost", 0, 0},
        {{"RungeKutta4"}, "lost", 0, 0},
        {{"RotationSplitting", "order=\"2\""}, "lost", 0, 0},
        {{"RotationSplitting"}, "lost", 0, 0},
        {{"Exact"}, "lost", 0, 0},                               // RotationSplitting
        {{"Exponential"}, "solver.fell_back", 2.2e-5, 3.9e-11},  // to Radau5
    };
    for (const Row& row : table)
        for (const Reaction* reaction : {&kRobertson, &kVanDerPol})
        {
            const std::string name = name_of(row.algorithm);
            CAPTURE(name);
            CAPTURE(reaction->values);
            Scene s = scene_of(*reaction, row.algorithm, 1000);
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.warnings_expected = s.keep_events = true;
            s.step(1000);
            // Caused by a script whose rates overflow, or by values that do.
            const bool lost = row.event == "lost";
            CHECK((lost ? s.count("script.error") + s.count("state.not_finite") >= 1 : s.count(row.event) == 1));
            const double bound = reaction == &kRobertson ? row.robertson : row.van_der_pol;
            if (bound > 0) CHECK(relative_error(*reaction, row.algorithm, 1000) < 2 * bound);
        }
    // ImplicitMidpoint is not L-stable. Robertson: it oscillates about the solution, the second number 5e7 times too large (4e-6).
    // Van der Pol: it does not find its midpoints, and reports that.
    CHECK(relative_error(kRobertson, {"ImplicitMidpoint"}, 1000) == doctest::Approx(4.8e7).epsilon(0.5));
    Scene s = scene_of(kVanDerPol, {"ImplicitMidpoint"}, 200);
    s.warnings_expected = s.keep_events = true;
    s.step(200);
    CHECK(s.count("solver.failed") > 0);
}
