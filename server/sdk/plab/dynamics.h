/// What a solver integrates: a group's equations of motion in coordinates that are local to the step.
#pragma once

#include <cstddef>
#include <span>

#include "plab/vector.h"

namespace plab
{

/// A body as solvers that know rigid bodies see it, at the start of the advance.
struct RigidMember
{
    Quat orientation;  ///< q_WB
    Mat3 inertia_B;    ///< about C, kg m^2
    Mat3 inverse_inertia_B;
    double mass = 0;      ///< kg
    bool needle = false;  ///< its speeds 3..5 are the angular velocity in B instead of the angular momentum in W
};

/// x' = X(x, u), u' = U(t, x, u), with as many coordinates x as speeds u, starting at x = 0.
///
/// Per body: 3 displacements of the centre of mass (m) and a rotation vector in the body's starting frame (rad), with
/// velocity (m/s) and angular momentum in W (N m s); per shaft: angle since the start (rad) and speed (rad/s); per
/// quantity: nothing (a coordinate that stays 0) and its value as a speed. Bodies come first, then shafts, then
/// quantities. The host
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
    /// How many of the members are bodies; body i has coordinates and speeds 6i .. 6i+5.
    virtual std::size_t body_count() const = 0;
    virtual RigidMember rigid(std::size_t body) const = 0;
    /// How many of the last coordinates belong to quantities.
    virtual std::size_t quantity_count() const = 0;
    /// Forces are the same whatever time and state (gravity alone), and no rows hold the members.
    virtual bool forces_are_uniform() const = 0;
    /// Rows hold the members together: the motion is projected onto them when the advance is over.
    virtual bool is_constrained() const = 0;
    /// The host has cut the step for stiff forces of its own (contacts), but may not cut as often as they ask: methods that
    /// would make those steps themselves break its bound.
    virtual bool is_undersampled() const { return false; }
    /// The step is given up: evaluate() does nothing any more, and a solver that goes on by small steps leaves off.
    virtual bool interrupted() const { return false; }
    /// Working memory of the length of coordinates(), kept warm between steps; i < 32. Contents are undefined.
    virtual std::span<double> workspace(int i) = 0;
};

}  // namespace plab
