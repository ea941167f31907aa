/// Islands: bodies and shafts that contacts and one-sided rows hold together, as a manager steps them.
#pragma once

#include <span>

#include "plab/collision.h"
#include "plab/interruption.h"
#include "plab/rows.h"

namespace plab
{

/// How a manager moves its island. Forces are those of the state at the start of the step.
class IslandMotion
{
public:
    virtual ~IslandMotion() = default;
    /// Speeds change by what the forces do in h (s); gyroscopic terms are taken at the present attitude.
    virtual void kick(double h) = 0;
    /// Poses and angles move for h (s) with the present speeds.
    virtual void move(double h) = 0;
    /// The same with the mean of the present speeds and those before the last kick: exact for constant deceleration.
    virtual void move_mean(double h) = 0;
    /// Rows anew at the present state: Jacobians, errors, rates; impulses are kept.
    virtual void refresh_rows() = 0;
    /// Contact depth anew at the present state, from where the two surface points have moved; normals are kept.
    virtual void refresh_depths() = 0;
};

/// Phase::Solve: one step of length h. Everything that moves between start and end is in here; bodies that are not
/// members have mobility 0. The manager leaves poses and speeds at the end of the step in the host tables.
struct Island
{
    double h = 0;                            ///< s
    double time = 0;                         ///< s, at the start of the step
    double size = 0;                         ///< m, the least radius of gyration of its bodies: what is small is small beside it
    std::span<const std::uint32_t> bodies;   ///< dynamic members, host rows, in id order
    std::span<const std::uint32_t> shafts;   ///< dynamic members that carry coordinates (roots of trains), in id order
    std::span<const double> shaft_mobility;  ///< by host row: 1/(kg m^2) of the train that the shaft carries
    std::span<ConstraintRow> rows;           ///< joints, limits, motors: in id order; shafts stand for their roots
    std::span<Contact> contacts;             ///< sorted by pair and feature; depth < 0: a gap that may close
    IslandMotion* motion = nullptr;
    const Interruption* interruption = nullptr;  ///< asked in each sweep, factorisation and part of the step
    // out
    int iterations = 0;   ///< sweeps, or pivots of a direct method
    double residual = 0;  ///< m/s: largest violation left of what the contact law and the rows ask of speeds
    bool converged = true;
    bool fell_back = false;  ///< another algorithm than the one asked for had to finish

    bool interrupted() const { return interruption && interruption->due(); }
};

}  // namespace plab
