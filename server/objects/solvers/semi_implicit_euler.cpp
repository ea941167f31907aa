#include "semi_implicit_euler.h"

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

}  // namespace plab::solvers
