/// What a solver integrates: a group's equations of motion in coordinates that are local to the step.
#pragma once

#include <span>

namespace plab
{

/// x' = X(x, u), u' = U(t, x, u), with as many coordinates x as speeds u, starting at x = 0.
///
/// Per body: 3 displacements of the centre of mass (m) and a rotation vector in the body's starting frame (rad), with
/// velocity (m/s) and angular momentum in W (N m s); per shaft: angle since the start (rad) and speed (rad/s). The host
/// maps the rotation vector back with the exponential map, so any method for flat ODEs is a Lie-group method here
/// (Munthe-Kaas) of the same order, and free rotation keeps its angular momentum exactly.
class DynamicSystem
{
public:
    virtual ~DynamicSystem() = default;

    virtual std::span<double> coordinates() = 0;
    virtual std::span<double> speeds() = 0;
    virtual std::span<const double> coordinate_rates() const = 0;
    virtual std::span<const double> speed_rates() const = 0;

    /// Both rates at (t, coordinates, speeds). t in s from the start of this advance. `weight` is the share of h that
    /// this evaluation has in the result (RK4: 1/6, 1/3, 1/3, 1/6); the energy ledger books power * weight * h.
    virtual void evaluate(double t, double weight) = 0;
    /// Coordinate rates only, from the present speeds: no forces are asked.
    virtual void evaluate_kinematics() = 0;
    /// Working memory of the length of coordinates(), kept warm between steps; i < 32. Contents are undefined.
    virtual std::span<double> workspace(int i) = 0;
};

}  // namespace plab
