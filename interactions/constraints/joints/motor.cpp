#include "joints/motor.h"

#include <algorithm>

#include "joints/distance.h"

namespace plab::constraints
{

void CoordinateRows::describe_coordinate(Schema& s, std::vector<std::string> coordinates)
{
    describe_pair(s, {Facet::Body, Facet::Shaft});
    describe_spin(s, "", "b relative to a");
    s.param(along, "along", unit::one,
            "kind of motion: turn about the axis, slide along it" +
                std::string(coordinates.size() > 2 ? ", or distance between the points" : ""))
        .or_else("turn")
        .one_of(std::move(coordinates));
    s.state(travel_axis_a, "travel_axis", unit::one, "the axis in the frame of a, or in the world");
    s.state(placed_travel_axis, "placed_travel_axis", unit::one, "the axis parameter from which it was taken").initially({});
    s.output(position, "position", unit::one, "value of the coordinate, rad or m");
    s.output(speed_now, "rate", unit::one, "its rate, rad/s or m/s");
}

Result<void> CoordinateRows::place_coordinate(Row row, const Bodies& bodies)
{
    if (of_shafts(row) && !turns(row)) return reason("shafts only turn: along must be turn");
    if (auto placed_spin = SpinColumns::place(row, b[row], a[row], bodies); !placed_spin) return placed_spin;
    if (of_shafts(row)) return {};
    place_points(row, bodies, along[row] == "distance" ? Missing::Origin : Missing::WhereOtherIs);
    if (placed_travel_axis[row] == axis[row]) return {};
    travel_axis_a[row] = a[row].valid() ? rotate_back(bodies.orientation[a[row].index], axis[row]) : axis[row];
    placed_travel_axis[row] = axis[row];
    return {};
}

Coordinate coordinate_of(const CoordinateRows& rows, Row row, const Bodies& bodies, const Shafts& shafts, double now)
{
    if (rows.turns(row))
    {
        const Spin spin = rows.spin_of(row, rows.b[row], rows.a[row], bodies, shafts);
        return turning(spin, rows.angle_now(row, spin, now));
    }
    const Sides s = rows.sides(row, bodies);
    if (rows.along[row] == "distance") return stretching(stretch_of(s));
    return sliding(s, rotate(s.a.q, rows.travel_axis_a[row]));
}

void begin_coordinate(CoordinateRows& rows, Row row, const Bodies& bodies, const Shafts& shafts, double now)
{
    if (rows.turns(row)) rows.begin(row, rows.spin_of(row, rows.b[row], rows.a[row], bodies, shafts), now);
}

void keep_coordinate(CoordinateRows& rows, Row row, const Bodies& bodies, const Shafts& shafts, double now)
{
    if (rows.turns(row)) rows.keep_spin(row, rows.spin_of(row, rows.b[row], rows.a[row], bodies, shafts), now);
    const Coordinate c = coordinate_of(rows, row, bodies, shafts, now);
    rows.position[row] = c.x, rows.speed_now[row] = c.speed;
}

void add_effort(const Coordinate& c, double effort, const Bodies& bodies, const Shafts& shafts, Wrenches& wrenches)
{
    for (std::uint32_t k = 0; k < c.row.count; ++k)
    {
        const RowBlock& block = c.row.blocks[k];
        if (block.participant.facet == Facet::Shaft)
        {
            if (shafts.dynamic(block.participant.index)) wrenches.add_shaft_torque(block.participant, block.angular.x * effort);
            continue;
        }
        if (!bodies.dynamic(block.participant.index)) continue;
        wrenches.add_force(block.participant, block.linear * effort);
        wrenches.add_torque(block.participant, block.angular * effort);
    }
}

ConstraintRow change_along(const Coordinate& c, double stiffness, double damping)
{
    ConstraintRow row = c.row;
    row.kind = RowKind::ForceChange;
    row.error = row.rate = row.bias = 0;
    row.stiffness = std::fmax(0.0, stiffness), row.damping = std::fmax(0.0, damping);
    return row;
}

void MotorRows::describe(Schema& s)
{
    describe_coordinate(s, {"turn", "slide", "distance"});
    s.role(manager, "manager", {Facet::Component}, "solves the row if max_effort is finite").optional();
    s.param(mode, "mode", unit::one, "rate: moves at speed; servo: goes to target, at most at speed")
        .or_else("rate")
        .one_of({"rate", "servo"});
    s.param(speed, "speed", unit::one, "rad/s or m/s; infinite for a servo: no limit").or_else(0).may_be_infinite();
    s.param(target, "target", unit::one, "of a servo, rad or m").or_else(0);
    s.param(gain, "gain", unit::one, "of a servo, 1/s: the error decays as exp(-gain t)").or_else(10).positive();
    s.param(max_effort, "max_effort", unit::one, "largest torque or force, N m or N; infinite: no limit")
        .or_else(kInfinity)
        .not_negative()
        .may_be_infinite();
    describe_reaction(s, "b");
}

Result<void> prepare_motor(Row row, MotorRows& rows, const Bodies& bodies)
{
    if (rows.max_effort[row] < kInfinity && !rows.manager[row].valid())
        return reason("a finite max_effort needs a manager: manager='Manager/Automatic', or the id of one");
    return rows.place_coordinate(row, bodies);
}

void constrain_motor(const StepContext& step, Rows which, const MotorRows& rows, const Bodies& bodies, const Shafts& shafts, RowSink& sink)
{
    for (const Row row : which)
    {
        Coordinate c = coordinate_of(rows, row, bodies, shafts, step.time);
        c.row.kind = RowKind::Rate;
        c.row.rate = rows.speed[row];
        if (rows.mode[row] == "servo")
        {
            const double most = std::fabs(rows.speed[row]) > 0 ? std::fabs(rows.speed[row]) : kInfinity;
            const double wanted = rows.gain[row] * (rows.target[row] - c.x);
            c.row.rate = std::clamp(wanted, -most, most);
            if (c.row.rate == wanted) c.row.bias -= rows.gain[row] * c.speed;
        }
        c.row.lower = -rows.max_effort[row], c.row.upper = rows.max_effort[row];
        sink.begin(step.component_of_row[row]);
        sink.add(c.row);
    }
}

void TorsionSpringRows::describe(Schema& s)
{
    describe_coordinate(s, {"turn", "slide"});
    s.param(stiffness, "stiffness", unit::one, "k, N m/rad or N/m").or_else(0).not_negative();
    s.param(damping, "damping", unit::one, "c, N m s/rad or N s/m").or_else(0).not_negative();
    s.param(rest, "rest", unit::one, "position without force, rad or m").or_else(0);
    s.output(effort, "effort", unit::one, "torque or force on b along the axis, N m or N");
}

namespace
{

double effort_of(const TorsionSpringRows& rows, Row row, const Coordinate& c)
{
    return -rows.stiffness[row] * (c.x - rows.rest[row]) - rows.damping[row] * c.speed;
}

}  // namespace

void apply_torsion(const StepContext& step, Rows which, const TorsionSpringRows& rows, const Bodies& bodies, const Shafts& shafts,
                   Wrenches& wrenches)
{
    for (const Row row : which)
    {
        const Coordinate c = coordinate_of(rows, row, bodies, shafts, step.time);
        wrenches.begin(step.component_of_row[row]);
        add_effort(c, effort_of(rows, row, c), bodies, shafts, wrenches);
    }
}

void linearize_torsion(const StepContext& step, Rows which, const TorsionSpringRows& rows, const Bodies& bodies, const Shafts& shafts,
                       RowSink& sink)
{
    for (const Row row : which)
    {
        sink.begin(step.component_of_row[row]);
        sink.add(change_along(coordinate_of(rows, row, bodies, shafts, step.time), rows.stiffness[row], rows.damping[row]));
    }
}

void stored_by_torsion(const StepContext& step, Rows which, const TorsionSpringRows& rows, const Bodies& bodies, const Shafts& shafts,
                       StoredEnergy& stored)
{
    for (const Row row : which)
    {
        const double stretch = coordinate_of(rows, row, bodies, shafts, step.time).x - rows.rest[row];
        stored.add(0.5 * rows.stiffness[row] * stretch * stretch, rows.b[row], rows.a[row]);
    }
}

void finish_torsion(const StepContext& step, Rows which, TorsionSpringRows& rows, const Bodies& bodies, const Shafts& shafts)
{
    for (const Row row : which)
    {
        keep_coordinate(rows, row, bodies, shafts, step.time);
        rows.effort[row] = effort_of(rows, row, coordinate_of(rows, row, bodies, shafts, step.time));
    }
}

}  // namespace plab::constraints
