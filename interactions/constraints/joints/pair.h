/// Shared by the joints between two bodies: the bodies they connect, the points, the axis, and what they report.
///
/// Points and axes are given in the world, at the pose at which the joint is placed (when its scene starts, when it is added, or
/// when the parameter changes). They are kept in the frames of the bodies as state, so that mementos and swaps preserve them.
#pragma once

#include <limits>

#include "joints/sides.h"
#include "plab/registrar.h"

namespace plab::constraints
{

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr Vec3 kNotGiven{kInfinity, kInfinity, kInfinity};

/// Roles a and b, and a point on each body.
struct PairRows
{
    Column<Ref> a, b;
    Column<Vec3> anchor, anchor_a, anchor_b;       // m
    Column<Vec3> point_a, point_b, placed_anchor;  // m
    Column<bool> placed;

    void describe_pair(Schema& s, std::vector<Facet> facets = {Facet::Body});
    /// The default of a point that no parameter gives.
    enum class Missing : std::uint8_t
    {
        WhereOtherIs,  ///< where the other body's point is
        Origin,        ///< each body's own origin
    };
    /// Sets the points from the parameters, if these are new.
    void place_points(Row row, const Bodies& bodies, Missing missing = Missing::WhereOtherIs);
    Sides sides(Row row, const Bodies& bodies) const
    {
        return sides_of(side_of(bodies, a[row], point_a[row]), side_of(bodies, b[row], point_b[row]));
    }
};

/// An axis through the point, stored as frames whose z axis lies along it.
struct AxisColumns
{
    Column<Vec3> axis, placed_axis;
    Column<Quat> frame_a, frame_b;  // q_BF; of the world: q_WF

    void describe_axis(Schema& s);
    /// Returns false if the axis is unchanged.
    bool place_axis(Row row, const Quat& q_a, const Quat& q_b);
};

/// An angle that is never wrapped. Attitudes show it only within half a turn; whole turns are decided by extrapolating from the
/// last known angle with the mean speed since then.
struct MeterColumns
{
    Column<double> angle, rate, time;  // rad, rad/s, s

    /// `prefix`: prefix of the field names.
    void describe_meter(Schema& s, const std::string& prefix, const std::string& doc);
    void reset(Row row) { angle[row] = rate[row] = 0, time[row] = kNotRead; }
    /// The unwrapped angle at `now`, given the `twist` that the attitudes show and the present `speed`.
    double read(Row row, double twist, double speed, double now) const;
    /// The same, and stores it. `step`: the time since the stored angle, used if no time is stored.
    void keep(Row row, double twist, double speed, double now, double step);
    bool is_read(Row row) const { return time[row] != kNotRead; }
    /// Stores the angle as valid at `now`.
    void start(Row row, double speed, double now) { rate[row] = speed, time[row] = now; }

private:
    static constexpr double kNotRead = -kInfinity;
};

/// Outputs of interactions by rows.
struct ReactionColumns
{
    Column<Vec3> force, torque;                  // N, N m
    Column<double> position_error, speed_error;  // m or rad
    Column<std::int64_t> redundant;

    void describe_reaction(Schema& s, const std::string& on);
    RowReport take_report(Row row, const RowReports& reports, std::uint32_t component);
};

/// A joint between two bodies at a point.
struct JointRows : PairRows, ReactionColumns
{
};
/// The same, with an axis.
struct AxisJointRows : JointRows, AxisColumns
{
    void place(Row row, const Bodies& bodies)
    {
        place_points(row, bodies);
        place_axis(row, attitude(bodies, a[row]), attitude(bodies, b[row]));
    }
    static Quat attitude(const Bodies& bodies, Ref body) { return body.valid() ? bodies.orientation[body.index] : Quat{}; }
};

/// Travel along the axis of an AxisJointRows. Its point of a moves along, so that a joint that replaces this one holds b where it is.
struct TravelColumns
{
    Column<double> travel, travel_rate;  // m, m/s
    Column<double> travelled;            // m

    void describe_travel(Schema& s);
};
/// Places points and axis. A new anchor begins at no travel; a point of a that is given anew has moved along the axis.
template <class Table>
bool place_travelling(Row row, Table& rows, const Bodies& bodies)
{
    const bool fresh = !rows.placed[row] || rows.placed_anchor[row] != rows.anchor[row];
    const Vec3 before = rows.point_a[row];
    rows.place_points(row, bodies);
    const bool turned = rows.place_axis(row, rows.attitude(bodies, rows.a[row]), rows.attitude(bodies, rows.b[row]));
    const Vec3 n_a = rotate(rows.frame_a[row], Vec3{0, 0, 1});
    rows.travelled[row] = fresh ? 0.0 : rows.travelled[row] + dot(n_a, rows.point_a[row] - before);
    return fresh || turned;
}
/// Phase::Finish: lets the point of a follow along the axis.
template <class Table>
void keep_travel(Row row, Table& rows, const Sides& s)
{
    const Vec3 n = rotate(s.a.q * rows.frame_a[row], Vec3{0, 0, 1});
    const double rolled = dot(n, s.d);
    rows.travel[row] = rows.travelled[row] += rolled;
    rows.point_a[row] += rolled * rotate(rows.frame_a[row], Vec3{0, 0, 1});
    rows.travel_rate[row] = dot(n, s.rate) + dot(cross(s.a.w, n), s.d);
}

/// Phase::Finish of joints that have no further outputs.
template <class Table>
void finish_reaction(const StepContext& step, Rows which, Table& rows, const RowReports& reports)
{
    for (const Row row : which) rows.take_report(row, reports, step.component_of_row[row]);
}

}  // namespace plab::constraints
