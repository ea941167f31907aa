/// Islands: bodies and shafts connected by contacts and one-sided rows, which a manager advances together.
#pragma once

#include <span>

#include "plab/collision.h"
#include "plab/interruption.h"
#include "plab/rows.h"

namespace plab
{

/// The operations by which a manager moves its island. Forces are those of the state at the start of the step. Several threads may move
/// different islands at once. An island with rows comes alone, as its rows share their working memory.
class IslandMotion
{
public:
    virtual ~IslandMotion() = default;
    /// Changes the speeds by the effect of the forces during h (s); gyroscopic terms are taken at the present attitude.
    virtual void kick(double h) = 0;
    /// Moves poses and angles for h (s) with the present speeds.
    virtual void move(double h) = 0;
    /// The same with the mean of the present speeds and those before the last kick, which is exact for constant acceleration.
    virtual void move_mean(double h) = 0;
    /// Recomputes the rows at the present state (Jacobians, errors, rates); impulses are kept.
    virtual void refresh_rows() = 0;
    /// Takes the rows halfway through a step of h (s) at the present speeds: Jacobians, rates and biases become those there, but for
    /// RowKind::ForceChange; errors and impulses are kept. Returns false and changes nothing where levers turn far by then, or joints close
    /// a loop: its rows depend on one another, and they would contradict one another where it is not quite closed.
    virtual bool put_rows_midway(double h) = 0;
    /// Recomputes the contact depths at the present state: where the pivot is known, from where the contact point is and how the face has
    /// turned, else from the motion of the two surface points. Normals are kept.
    virtual void refresh_depths() = 0;
};

/// What resists that the bodies of a pair roll on one another, or spin about their normal: couples of at most the given lever times the sum
/// of the normal impulses of its contacts (rolling resistance; Johnson, Contact Mechanics (1985), chapter 8).
struct RollingResistance
{
    std::uint32_t first = 0, end = 0;  ///< the contacts of the pair
    double rolling = 0, spinning = 0;  ///< m
};

/// Phase::Solve: one step of length h. It contains everything that moves during the step; bodies that are not members have mobility 0.
/// The manager leaves poses and speeds at the end of the step in the host tables.
/// A call may bring several islands of the same time and length of the step. No body or shaft that moves is a member of two, so a manager
/// may advance them in any order, also at once; what becomes of one must not depend on which others come with it.
struct Island
{
    double h = 0;                            ///< s
    double time = 0;                         ///< s, at the start of the step
    double size = 0;                         ///< m, the smallest radius of gyration of its bodies: a reference for what counts as small
    std::span<const std::uint32_t> bodies;   ///< dynamic members, host rows, in id order
    std::span<const std::uint32_t> shafts;   ///< dynamic members that carry coordinates (roots of trains), in id order
    std::span<const double> shaft_mobility;  ///< by host row: 1/(kg m^2) of the train that the shaft carries
    std::span<ConstraintRow> rows;           ///< joints, limits, motors: in id order; shafts are represented by their roots
    std::span<Contact> contacts;             ///< sorted by pair and feature; depth < 0: a gap that may close
    std::span<const RollingResistance> resistances;  ///< of those pairs that have any, in the order of their contacts
    IslandMotion* motion = nullptr;
    const Interruption* interruption = nullptr;  ///< to be checked in each sweep, factorisation and part of the step
    // out
    int iterations = 0;   ///< sweeps, or pivots of a direct method
    double residual = 0;  ///< m/s: largest remaining violation of the speeds that contact law and rows require
    bool converged = true;
    bool fell_back = false;  ///< the requested algorithm failed and another one finished the step
    /// Out, by contact: N s on b, W, that the step gave besides Contact::impulse, which tells how hard a contact presses: impacts that went
    /// through it. All zero on input; empty: nobody asks.
    std::span<Vec3> further_impulses;

    bool interrupted() const { return interruption && interruption->due(); }
};

}  // namespace plab
