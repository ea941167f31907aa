/// What a solver integrates: the equations of motion of a group, in coordinates that are local to the step.
#pragma once

#include <cstddef>
#include <span>

#include "plab/vector.h"

namespace plab
{

/// A body at the start of the advance, for solvers that treat rigid bodies specially.
struct RigidMember
{
    Quat orientation;  ///< q_WB
    Mat3 inertia_B;    ///< about C, kg m^2
    Mat3 inverse_inertia_B;
    double mass = 0;      ///< kg
    bool needle = false;  ///< its speeds 3..5 are the angular velocity in B, not the angular momentum in W
};

/// x' = X(x, u), u' = U(t, x, u), with as many coordinates x as speeds u, starting at x = 0.
///
/// Per body: 3 displacements of the centre of mass (m) and a rotation vector in the body's starting frame (rad); the speeds are velocity
/// (m/s) and angular momentum in W (N m s). Per shaft: the angle since the start (rad) and the speed (rad/s). Per quantity: a coordinate
/// that stays 0, and its value as a speed. Bodies come first, then shafts, then quantities. The host maps the rotation vector back with
/// the exponential map. Any method for flat ODEs therefore acts as a Lie-group method (Munthe-Kaas) of the same order, and free rotation
/// conserves its angular momentum exactly.
class DynamicSystem
{
public:
    virtual ~DynamicSystem() = default;

    virtual std::span<double> coordinates() = 0;
    virtual std::span<double> speeds() = 0;
    virtual std::span<const double> coordinate_rates() const = 0;
    virtual std::span<const double> speed_rates() const = 0;

    /// Computes both rates at (t, coordinates, speeds). t in s from the start of this advance. `weight` is the share of h that this
    /// evaluation has in the result (RK4: 1/6, 1/3, 1/3, 1/6); the energy ledger books power * weight * h.
    virtual void evaluate(double t, double weight) = 0;
    /// Computes the rates of the coordinates only, from the present speeds, without evaluating forces.
    virtual void evaluate_kinematics() = 0;
    /// The number of members that are bodies; body i has the coordinates and speeds 6i .. 6i+5.
    virtual std::size_t body_count() const = 0;
    virtual RigidMember rigid(std::size_t body) const = 0;
    /// The number of coordinates at the end that belong to quantities.
    virtual std::size_t quantity_count() const = 0;
    /// Forces are independent of time and state (gravity alone), and no rows constrain the members.
    virtual bool forces_are_uniform() const = 0;
    /// Rows constrain the members: the motion is projected onto them at the end of the advance.
    virtual bool is_constrained() const = 0;
    /// The host has divided the step because of its own stiff forces (contacts), but its limit may not allow as many parts as they need.
    /// Methods that would choose such small steps themselves would exceed that limit.
    virtual bool is_undersampled() const { return false; }
    /// The step has been interrupted: evaluate() does nothing any more, and a solver that makes many small steps should return.
    virtual bool interrupted() const { return false; }
    /// Work memory of the length of coordinates(), kept between steps; i < 32. Its contents are undefined.
    virtual std::span<double> workspace(int i) = 0;
};

}  // namespace plab
