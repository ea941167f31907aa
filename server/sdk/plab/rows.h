/// Constraint rows: what joints, limits and motors say about the motion of their participants.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "plab/ref.h"
#include "plab/vector.h"

namespace plab
{

/// One participant's share in a row. A body: linear . v_WC + angular . w_WB (both in W); a shaft: angular.x * speed.
struct RowBlock
{
    Ref who;
    Vec3 linear;
    Vec3 angular;
};

enum class RowKind : std::uint8_t
{
    Equality,  ///< error = 0 is held: in acceleration, speed and position
    Rate,      ///< J v = rate is held: motors. No position error
    OneSided,  ///< error >= 0 is held by lambda >= 0: limits. To be added only where the row may act within the step
};

/// A scalar row J v = rate, with the force lambda on it: wrench_k = J_k^T lambda.
///
///   error = phi(q),  d(error)/dt = J v - rate,  J a = bias  keeps its second derivative at zero:  bias = -(dJ/dt) v + d(rate)/dt.
/// M and J stay apart; nobody multiplies them beforehand.
struct ConstraintRow
{
    static constexpr std::size_t kMostBlocks = 3;

    std::array<RowBlock, kMostBlocks> blocks{};
    std::uint32_t count = 0;
    RowKind kind = RowKind::Equality;
    double error = 0;                                         ///< phi, m or rad
    double rate = 0;                                          ///< m/s or rad/s: what J v has to be
    double bias = 0;                                          ///< m/s^2 or rad/s^2: what J a has to be
    double lower = -std::numeric_limits<double>::infinity();  ///< least and largest lambda, N or N m
    double upper = std::numeric_limits<double>::infinity();
    double restitution = 0;     ///< OneSided: share of the approach that comes back
    std::uint32_t feature = 0;  ///< which row of its component; stable, for warm starts
    // Filled by the host:
    std::uint32_t component = kNoIndex;  ///< directory index
    double impulse = 0;                  ///< N s or N m s over the step: warm start in, result out

    /// A row that only a manager can hold: it may let go.
    bool may_yield() const
    {
        return kind == RowKind::OneSided || lower > -std::numeric_limits<double>::infinity() ||
               upper < std::numeric_limits<double>::infinity();
    }
};

/// Phase::Constrain adds its rows here, for each of its rows of the table in turn.
class RowSink
{
public:
    virtual ~RowSink() = default;
    /// Names the component (directory index) that the following rows belong to. To be called before the first of them.
    virtual void begin(std::uint32_t component) = 0;
    virtual void add(const ConstraintRow& row) = 0;
};

/// What a joint did in the finished step, by component; filled by the host for Phase::Finish.
struct RowReport
{
    double position_error = 0;    ///< largest |phi| left at the end of the step, m or rad
    double speed_error = 0;       ///< largest |J v - rate| left
    Vec3 force;                   ///< N on the second participant, in W, at the end of the step
    Vec3 torque;                  ///< N m on the second participant about its centre of mass, in W; a shaft: x
    std::uint32_t redundant = 0;  ///< rows of this component that others already imply
};
class RowReports
{
public:
    virtual ~RowReports() = default;
    virtual RowReport of(std::uint32_t component) const = 0;
};

}  // namespace plab
