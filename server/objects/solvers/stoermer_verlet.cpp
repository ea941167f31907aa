#include "stoermer_verlet.h"

namespace plab::solvers
{

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

}  // namespace plab::solvers
