#include "joints/pair.h"

namespace plab::constraints
{

void PairRows::describe_pair(Schema& s, std::vector<Facet> facets)
{
    s.role(a, "a", facets, "the base to which b is held; none: the world").optional().writes();
    s.role(b, "b", facets, "the body or shaft that is held").writes();
    s.param(anchor, "anchor", unit::metre,
            "the point in the world at the present poses; infinite: not given, then the origin of b (for a "
            "length, those of both)")
        .or_else(kNotGiven)
        .may_be_infinite();
    s.param(anchor_a, "anchor_a", unit::metre, "the point in the frame of a (of the world, if there is no a), instead of anchor")
        .or_else(kNotGiven)
        .may_be_infinite();
    s.param(anchor_b, "anchor_b", unit::metre, "the point in the frame of b, instead of anchor").or_else(kNotGiven).may_be_infinite();
    s.state(point_a, "point_a", unit::metre, "the joint's point in the frame of a, or of the world");
    s.state(point_b, "point_b", unit::metre, "the joint's point in the frame of b");
    s.state(placed_anchor, "placed_anchor", unit::metre, "the anchor parameter from which the points were taken")
        .initially({})
        .may_be_infinite();
    s.state(placed, "placed", unit::one, "the points have been taken").initially(false);
}

void PairRows::place_points(Row row, const Bodies& bodies, Missing missing)
{
    const bool fresh = !placed[row] || placed_anchor[row] != anchor[row];
    const Pose pose_b = bodies.pose(b[row].index);
    const Pose pose_a = a[row].valid() ? bodies.pose(a[row].index) : Pose{};
    const bool own_a = anchor_a[row] != kNotGiven, own_b = anchor_b[row] != kNotGiven;
    const bool given = anchor[row] != kNotGiven;
    Vec3 here_a = anchor[row], here_b = anchor[row];
    if (!given && missing == Missing::Origin) here_a = pose_a.p, here_b = pose_b.p;
    if (!given && missing == Missing::WhereOtherIs)
        here_a = here_b = own_b ? pose_b * anchor_b[row] : own_a ? pose_a * anchor_a[row] : pose_b.p;
    if (own_a || fresh) point_a[row] = own_a ? anchor_a[row] : inverse(pose_a) * here_a;
    if (own_b || fresh) point_b[row] = own_b ? anchor_b[row] : inverse(pose_b) * here_b;
    placed[row] = true, placed_anchor[row] = anchor[row];
}

void AxisColumns::describe_axis(Schema& s)
{
    s.param(axis, "axis", unit::one, "direction in the world at the present poses").or_else({0, 0, 1}).unit_length();
    s.state(frame_a, "frame_a", unit::one, "the axis' frame (z along it) in a, or in the world");
    s.state(frame_b, "frame_b", unit::one, "the same frame in b");
    s.state(placed_axis, "placed_axis", unit::one, "the axis parameter from which the frames were taken").initially({});
}

bool AxisColumns::place_axis(Row row, const Quat& q_a, const Quat& q_b)
{
    if (placed_axis[row] == axis[row]) return false;
    const Quat frame_W = frame_of_axis(axis[row]);
    frame_a[row] = conjugate(q_a) * frame_W, frame_b[row] = conjugate(q_b) * frame_W;
    placed_axis[row] = axis[row];
    return true;
}

void MeterColumns::describe_meter(Schema& s, const std::string& prefix, const std::string& doc)
{
    s.state(angle, prefix + "angle", unit::radian, doc + ", never wrapped");
    s.state(rate, prefix + "angle_rate", unit::radian_per_second, "speed when that angle was read");
    s.state(time, prefix + "angle_time", unit::second, "when that angle was read; -inf: not yet").initially(kNotRead).may_be_infinite();
}

double MeterColumns::read(Row row, double twist_now, double speed, double now) const
{
    const double since = time[row] == kNotRead ? 0.0 : now - time[row];
    return unwrapped(twist_now, angle[row] + 0.5 * (rate[row] + speed) * since);
}

void MeterColumns::keep(Row row, double twist_now, double speed, double now, double step)
{
    if (time[row] == kNotRead) start(row, speed, now - step);
    angle[row] = read(row, twist_now, speed, now);
    start(row, speed, now);
}

void TravelColumns::describe_travel(Schema& s)
{
    s.output(travel, "travel", unit::metre, "displacement of b's point along the axis since the joint was placed");
    s.output(travel_rate, "travel_rate", unit::metre_per_second, "its rate");
    s.state(travelled, "travelled", unit::metre, "displacement of point_a along the axis, with b").initially(0);
}

void ReactionColumns::describe_reaction(Schema& s, const std::string& on)
{
    s.output(force, "force", unit::newton, "on " + on + ", in the world, at the last solver stage of the step");
    s.output(torque, "torque", unit::newton_metre,
             "on " + on + " about its centre of mass, in the world, at the last solver stage of the step");
    s.output(position_error, "position_error", unit::one, "largest error of its rows at the end of the step, m or rad").reported_as_error();
    s.output(speed_error, "speed_error", unit::one, "largest error of its rows' speeds, m/s or rad/s").reported_as_error();
    s.output(redundant, "redundant", unit::one, "number of its rows that are implied by other rows");
}

RowReport ReactionColumns::take_report(Row row, const RowReports& reports, std::uint32_t component)
{
    const RowReport report = reports.of(component);
    force[row] = report.force, torque[row] = report.torque;
    position_error[row] = report.position_error, speed_error[row] = report.speed_error;
    redundant[row] = report.redundant;
    return report;
}

}  // namespace plab::constraints
