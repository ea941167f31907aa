#include "exact.h"

#include <cmath>
#include <span>

#include "fixed_step.h"
#include "plab/free_rotation.h"
#include "plab/rotation.h"
#include "rotation_splitting.h"

namespace plab::solvers
{
namespace
{

Vec3 vector(std::span<const double> from, std::size_t at) { return {from[at], from[at + 1], from[at + 2]}; }
void place(std::span<double> to, std::size_t at, const Vec3& v) { to[at] = v.x, to[at + 1] = v.y, to[at + 2] = v.z; }

void rotate_freely(double h, DynamicSystem& system, std::size_t body)
{
    const RigidMember member = system.rigid(body);
    const PrincipalAxes principal = principal_axes(member);
    const auto u = system.speeds();
    const Vec3 s = vector(u, 6 * body + 3);
    Vec3 m;
    if (member.needle)
    {
        const Vec3 w = transposed_times(principal.axes, s);
        m = {w.x * principal.moment.x, w.y * principal.moment.y, w.z * principal.moment.z};
    }
    else
        m = transposed_times(principal.axes, rotate_back(member.orientation, s));
    const FreeTop top(principal, m);
    place(system.coordinates(), 6 * body + 3, principal.axes * log_rotation(top.turn(h)));
    if (!member.needle) return;
    const Vec3 after = top.momentum(h);
    place(u, 6 * body + 3,
          principal.axes * Vec3{after.x * principal.reciprocal.x, after.y * principal.reciprocal.y, after.z * principal.reciprocal.z});
}

/// Whether speed i is the rotation of a body (its last three of six).
bool is_rotation(const DynamicSystem& system, std::size_t i) { return i < 6 * system.body_count() && i % 6 >= 3; }

/// A uniform field exerts no torque: the rates of angular momentum are 0. For needles the rates are those of free rotation.
bool nothing_is_turned(const DynamicSystem& system)
{
    const auto du = system.speed_rates();
    for (std::size_t i = 0; i < system.body_count(); ++i)
        if (!system.rigid(i).needle && vector(du, 6 * i + 3) != Vec3{}) return false;
    return true;
}

bool same_rates(const DynamicSystem& system, std::span<const double> before)
{
    const auto du = system.speed_rates();
    for (std::size_t i = 0; i < du.size(); ++i)
        if (!is_rotation(system, i) && !(std::fabs(du[i] - before[i]) <= 1e-12 * std::fabs(before[i]))) return false;
    return nothing_is_turned(system);
}

}  // namespace

bool advance_in_closed_form(double h, DynamicSystem& system)
{
    const auto x = system.coordinates();
    const auto u = system.speeds();
    const auto u0 = system.workspace(0), a = system.workspace(1);
    const std::size_t n = u.size(), places = n - system.quantity_count();
    // Under a uniform force the power is linear in time, so the mean of both ends gives the work. Both ends must agree, otherwise the
    // forces are not uniform as the host stated.
    system.evaluate(0, 0.5);
    const auto du = system.speed_rates();
    for (std::size_t i = 0; i < n; ++i) u0[i] = u[i], a[i] = du[i];
    for (std::size_t i = 0; i < n; ++i)
    {
        if (is_rotation(system, i)) continue;
        if (i < places) x[i] = h * u0[i] + 0.5 * h * h * a[i];
        u[i] = u0[i] + h * a[i];
    }
    for (std::size_t i = 0; i < system.body_count(); ++i) rotate_freely(h, system, i);
    system.evaluate(h, 0.5);
    if (same_rates(system, a)) return true;
    system.evaluate(h, -0.5);
    for (std::size_t i = 0; i < n; ++i) u[i] = u0[i], x[i] = 0;
    system.evaluate(0, -0.5);
    return false;
}

void advance_exact(const StepContext& context, Row row, ExactRows& rows, DynamicSystem& system)
{
    const StepContext start = context;  // evaluations change the host's context
    if (system.is_constrained())
    {
        rows.resolved.fall_back(start, row, Fallback::Constrained, "RungeKutta4", "joints constrain the group, so no closed form is known");
        return advance_runge_kutta4(start, row, {}, system);
    }
    if (system.forces_are_uniform() && advance_in_closed_form(start.dt, system)) return rows.resolved.say(start, row, "Exact");
    rows.resolved.fall_back(start, row, Fallback::NotUniform, "RotationSplitting",
                            "forces depend on time, position or velocity, so no closed form is known");
    advance_by_splitting(start.dt, 4, system);
}

}  // namespace plab::solvers
