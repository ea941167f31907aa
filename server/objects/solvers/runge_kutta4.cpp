#include "runge_kutta4.h"

#include <array>

namespace plab::solvers
{
namespace
{

struct StageOfMethod
{
    double time;        ///< share of h at which this stage is evaluated
    double next;        ///< share of h of this stage's slope in the next stage's point; 0: the last one
    double weight;      ///< share in the result
    double sum_weight;  ///< six times that: exact
};

constexpr std::array<StageOfMethod, 4> kStages{{
    {0.0, 0.5, 1.0 / 6, 1},
    {0.5, 0.5, 1.0 / 3, 2},
    {0.5, 1.0, 1.0 / 3, 2},
    {1.0, 0.0, 1.0 / 6, 1},
}};

}  // namespace

void advance_runge_kutta4(const StepContext& context, Row, const RungeKutta4Rows&, DynamicSystem& system)
{
    const double h = context.dt;
    const auto x = system.coordinates();
    const auto u = system.speeds();
    const auto dx = system.coordinate_rates();
    const auto du = system.speed_rates();
    const auto u0 = system.workspace(0);
    const auto sum_dx = system.workspace(1);
    const auto sum_du = system.workspace(2);
    const std::size_t n = u.size();

    for (std::size_t i = 0; i < n; ++i) u0[i] = u[i], sum_dx[i] = 0, sum_du[i] = 0;
    for (const StageOfMethod& stage : kStages)
    {
        system.evaluate(stage.time * h, stage.weight);
        for (std::size_t i = 0; i < n; ++i)
        {
            sum_dx[i] += stage.sum_weight * dx[i];
            sum_du[i] += stage.sum_weight * du[i];
            x[i] = h * stage.next * dx[i];
            u[i] = u0[i] + h * stage.next * du[i];
        }
    }
    for (std::size_t i = 0; i < n; ++i)
    {
        x[i] = h / 6 * sum_dx[i];
        u[i] = u0[i] + h / 6 * sum_du[i];
    }
}

}  // namespace plab::solvers
