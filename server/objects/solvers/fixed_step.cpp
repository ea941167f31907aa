#include "fixed_step.h"

#include <array>

namespace plab::solvers
{

void advance_semi_implicit_euler(const StepContext& context, Row, const SemiImplicitEulerRows&, DynamicSystem& system)
{
    const double h = context.dt;
    const auto x = system.coordinates();
    const auto u = system.speeds();
    const auto dx = system.coordinate_rates();
    const auto du = system.speed_rates();

    system.evaluate(0, 1);
    for (std::size_t i = 0; i < u.size(); ++i) u[i] += h * du[i];
    system.evaluate_kinematics();
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += h * dx[i];
}

void advance_stoermer_verlet(const StepContext& context, Row, const StoermerVerletRows&, DynamicSystem& system)
{
    const double h = context.dt;
    const auto x = system.coordinates();
    const auto u = system.speeds();
    const auto dx = system.coordinate_rates();
    const auto du = system.speed_rates();
    const auto first = system.workspace(0), middle = system.workspace(1);
    const std::size_t n = u.size();

    system.evaluate(0, 0.5);
    for (std::size_t i = 0; i < n; ++i)
    {
        first[i] = du[i];
        middle[i] = u[i] = u[i] + 0.5 * h * du[i];
    }
    // The drift: explicit midpoint in the coordinates, which is exact for displacements and angles.
    system.evaluate_kinematics();
    for (std::size_t i = 0; i < n; ++i) x[i] = 0.5 * h * dx[i];
    system.evaluate_kinematics();
    for (std::size_t i = 0; i < n; ++i)
    {
        x[i] = h * dx[i];
        u[i] = middle[i] + 0.5 * h * first[i];
    }
    system.evaluate(h, 0.5);
    for (std::size_t i = 0; i < n; ++i) u[i] = middle[i] + 0.5 * h * du[i];
}

namespace
{

void copy(std::span<const double> from, std::span<double> to)
{
    for (std::size_t i = 0; i < from.size(); ++i) to[i] = from[i];
}

/// Moves to the point of stage s, using the slope of the stage before it.
void go_to_stage(std::size_t s, double h, DynamicSystem& system, const StageSlopes& slopes)
{
    const auto x = system.coordinates();
    const auto u = system.speeds();
    const auto u0 = system.workspace(0);
    const double length = s == 0 ? 0.0 : h * kRungeKutta4Stages[s - 1].next;
    for (std::size_t i = 0; i < u.size(); ++i)
    {
        x[i] = s == 0 ? 0.0 : length * slopes.dx[s - 1][i];
        u[i] = s == 0 ? u0[i] : u0[i] + length * slopes.du[s - 1][i];
    }
}

}  // namespace

StageSlopes::StageSlopes(DynamicSystem& system)
{
    for (std::size_t s = 0; s < 4; ++s)
        dx[s] = system.workspace(3 + static_cast<int>(s)), du[s] = system.workspace(7 + static_cast<int>(s));
}

void advance_by_runge_kutta4(double h, DynamicSystem& system, StageSlopes* slopes)
{
    const auto x = system.coordinates();
    const auto u = system.speeds();
    const auto dx = system.coordinate_rates();
    const auto du = system.speed_rates();
    const auto u0 = system.workspace(0);
    const auto sum_dx = system.workspace(1);
    const auto sum_du = system.workspace(2);
    const std::size_t n = u.size();

    for (std::size_t i = 0; i < n; ++i) u0[i] = u[i], sum_dx[i] = 0, sum_du[i] = 0;
    for (std::size_t s = 0; s < kRungeKutta4Stages.size(); ++s)
    {
        const RungeKutta4Stage& stage = kRungeKutta4Stages[s];
        system.evaluate(stage.time * h, stage.weight);
        if (slopes) copy(dx, slopes->dx[s]), copy(du, slopes->du[s]);
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

void find_slopes(double h, DynamicSystem& system, StageSlopes& slopes)
{
    copy(system.speeds(), system.workspace(0));
    for (std::size_t s = 0; s < kRungeKutta4Stages.size(); ++s)
    {
        go_to_stage(s, h, system, slopes);
        system.evaluate(kRungeKutta4Stages[s].time * h, 0);
        copy(system.coordinate_rates(), slopes.dx[s]), copy(system.speed_rates(), slopes.du[s]);
    }
    go_to_stage(0, h, system, slopes);
}

void take_back_runge_kutta4(double h, DynamicSystem& system, const StageSlopes& slopes)
{
    for (std::size_t s = 0; s < kRungeKutta4Stages.size(); ++s)
    {
        go_to_stage(s, h, system, slopes);
        system.evaluate(kRungeKutta4Stages[s].time * h, -kRungeKutta4Stages[s].weight);
    }
    go_to_stage(0, h, system, slopes);
}

void advance_runge_kutta4(const StepContext& context, Row, const RungeKutta4Rows&, DynamicSystem& system)
{
    advance_by_runge_kutta4(context.dt, system);
}

}  // namespace plab::solvers
