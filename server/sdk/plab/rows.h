/// Constraint rows: the equations that joints, limits and motors impose on their participants, and how forces change with their state.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "plab/ref.h"
#include "plab/vector.h"

namespace plab
{

/// One participant's part of a row. A body: linear . v_WC + angular . w_WB (both in W); a shaft: angular.x * speed.
struct RowBlock
{
    Ref participant;
    Vec3 linear;
    Vec3 angular;
};

enum class RowKind : std::uint8_t
{
    Equality,  ///< error = 0, enforced for acceleration, speed and position
    Rate,      ///< J v = rate: motors. No position error
    OneSided,  ///< error >= 0 with lambda >= 0: limits. To be added only if the row may become active within the step
    /// lambda = bias - stiffness error - damping (J v - rate): by how much a force of Phase::Force differs, later in a step, from what it
    /// was when it was evaluated. Only of Phase::Linearize
    ForceChange,
};

/// A scalar row J v = rate with the multiplier lambda: wrench_k = J_k^T lambda.
///
///   error = phi(q),  d(error)/dt = J v - rate,  J a = bias  keeps its second derivative at zero:  bias = -(dJ/dt) v + d(rate)/dt.
/// M and J are stored separately and never multiplied in advance.
struct ConstraintRow
{
    static constexpr std::size_t kMostBlocks = 3;

    std::array<RowBlock, kMostBlocks> blocks{};
    std::uint32_t count = 0;
    RowKind kind = RowKind::Equality;
    double error = 0;                                         ///< phi, m or rad; ForceChange: displacement since the force was evaluated
    double rate = 0;                                          ///< m/s or rad/s: required J v; ForceChange: J v at the evaluation
    double bias = 0;                                          ///< m/s^2 or rad/s^2: required J a; ForceChange: N or N m, see there
    double lower = -std::numeric_limits<double>::infinity();  ///< bounds of lambda, N or N m
    double upper = std::numeric_limits<double>::infinity();
    double stiffness = 0;       ///< ForceChange: N/m or N m/rad, >= 0
    double damping = 0;         ///< ForceChange: N s/m or N m s/rad, >= 0
    double restitution = 0;     ///< OneSided: ratio of separation speed to approach speed
    std::uint32_t feature = 0;  ///< which row of its component; stable, for warm starting
    // Filled by the host:
    std::uint32_t component = kNoIndex;  ///< directory index
    double impulse = 0;                  ///< N s or N m s over the step: warm start on input, result on output

    /// A row that may become inactive, so only a manager can hold it.
    bool may_yield() const
    {
        return kind == RowKind::OneSided || lower > -std::numeric_limits<double>::infinity() ||
               upper < std::numeric_limits<double>::infinity();
    }
};

/// Receives the rows of Phase::Constrain or Phase::Linearize, for one row of the table after the other.
class RowSink
{
public:
    virtual ~RowSink() = default;
    /// Names the component (directory index) to which the following rows belong. To be called before adding them.
    virtual void begin(std::uint32_t component) = 0;
    virtual void add(const ConstraintRow& row) = 0;
};

/// The effect of a joint in the finished step, by component; filled by the host for Phase::Finish.
struct RowReport
{
    double position_error = 0;    ///< largest |phi| at the end of the step, m or rad
    double speed_error = 0;       ///< largest |J v - rate| at the end of the step
    Vec3 force;                   ///< N on the second participant, in W, at the end of the step
    Vec3 torque;                  ///< N m on the second participant about its centre of mass, in W; for a shaft, x
    std::uint32_t redundant = 0;  ///< rows of this component that the others imply
};
class RowReports
{
public:
    virtual ~RowReports() = default;
    virtual RowReport of(std::uint32_t component) const = 0;
};

}  // namespace plab
