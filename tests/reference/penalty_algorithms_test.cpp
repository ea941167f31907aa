// B2 of the catalogue with every solver: the restitution of a spring contact, and its order in the length of the pieces.
#include "impacts.h"
#include "motion.h"

using namespace plab;
using namespace plab::test;

namespace
{
constexpr double kDamped = 0.72924761428767;  // exp(-pi z / sqrt(1 - z^2)), z = .1

/// Rebound speed after an approach of 1 kg at 1 m/s, relative to `e`: `pieces` per half period, at any phase of the step.
double bounce_error(const SolverAlgorithm& algorithm, const std::string& law, int pieces, double e)
{
    double worst = 0;
    for (const double phase : {0.0, 0.31, 0.77})
    {
        Scene s(solver(algorithm) + kGround + sphere("a", 0.1, at({0, 0, 0.1 + (1 + phase) / 60}, {0, 0, -1}) + " solver=\"solver\"") +
                    "<component id=\"contact\" type=\"CDetection/ODE\" between=\"a ground\" response=\"Response/" + law +
                    " response.steps_per_contact=\"" + std::to_string(pieces) + "\"/>",
                "dt=\"1/60\"");
        REQUIRE_MESSAGE(s.loaded(), s.error());
        s.step(6);
        worst = std::max(worst, std::fabs(s.vec("a", "linear_velocity").z - e));
    }
    return worst;
}

const char* const kSpring = "Penalty\" response.restitution=\"1\" response.stiffness=\"1e5\"";
const char* const kDamper = "Penalty\" response.restitution=\"1\" response.stiffness=\"1e5\" response.damping_ratio=\"0.1\"";
const char* const kHertz = "HuntCrossley\" response.restitution=\"1\" response.stiffness=\"1e7\"";

struct SolverRow
{
    SolverAlgorithm algorithm;
    double order;                  ///< 0: by its own steps within a piece, or exact for what is linear
    double spring, damper, hertz;  ///< at 200 pieces, the default
};
const SolverRow kRows[] = {
    {{"SemiImplicitEuler"}, 1, 8e-3, 4.5e-3, 6e-3},    {{"StoermerVerlet"}, 2, 1.8e-5, 8e-5, 3.5e-6},
    {{"ImplicitMidpoint"}, 2, 1e-13, 3.5e-5, 9e-6},    {{"RotationSplitting", "order=\"2\""}, 2, 8e-6, 2.2e-5, 2.5e-6},
    {{"RotationSplitting"}, 4, 5e-12, 1.2e-11, 9e-10}, {{"Exact"}, 4, 5e-12, 1.2e-11, 9e-10},
    {{"RungeKutta4"}, 4, 6e-11, 1.5e-9, 6e-8},         {{"Exponential"}, 0, 4e-14, 4e-14, 9e-8},
    {{"DormandPrince54"}, 0, 2.2e-12, 2e-12, 1.5e-8},  {{"Radau5"}, 0, 1.2e-12, 1e-12, 1.5e-8},
    {{"Automatic"}, 0, 6e-11, 1.5e-9, 1.4e-8},
};
}  // namespace

TEST_CASE("B2: the rebound from a spring, a damped one and Hertz's, with every solver at 200 pieces per contact")
{
    for (const SolverRow& row : kRows)
    {
        CAPTURE(row.algorithm.type);
        CAPTURE(row.algorithm.attributes);
        CHECK(bounce_error(row.algorithm, kSpring, 200, 1) < row.spring);
        CHECK(bounce_error(row.algorithm, kDamper, 200, kDamped) < row.damper);
        CHECK(bounce_error(row.algorithm, kHertz, 200, 1) < row.hertz);
    }
}

TEST_CASE("B2: solvers keep their order in the pieces of a contact")
{
    for (const SolverRow& row : kRows)
    {
        if (row.order == 0) continue;
        CAPTURE(row.algorithm.type);
        CAPTURE(row.algorithm.attributes);
        const double coarse = bounce_error(row.algorithm, kDamper, 25, kDamped),
                     middle = bounce_error(row.algorithm, kDamper, 100, kDamped), fine = bounce_error(row.algorithm, kDamper, 400, kDamped);
        CHECK(std::fabs(observed_order(coarse, middle) / 2 - row.order) < 0.3);
        CHECK(std::fabs(observed_order(middle, fine) / 2 - row.order) < 0.1);
    }
}
