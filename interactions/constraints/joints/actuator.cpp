#include "joints/actuator.h"

#include <algorithm>

namespace plab::constraints
{

void ActuatorRows::describe(Schema& s)
{
    describe_coordinate(s, {"turn", "slide", "distance"});
    s.param(control, "control", unit::one, "u, what it is told").or_else(0);
    s.param(control_lower, "control_lower", unit::one, "least u that counts; -inf: none").or_else(-kInfinity).may_be_infinite();
    s.param(control_upper, "control_upper", unit::one, "largest u that counts; inf: none").or_else(kInfinity).may_be_infinite();
    s.param(gain, "gain", unit::one, "force per u").or_else(1);
    s.param(bias, "bias", unit::one, "further force: constant, per length (gear times position), per rate of that length").or_else({});
    s.param(gear, "gear", unit::one, "length per position, and effort per force").or_else(1).nonzero();
    s.param(force_lower, "force_lower", unit::one, "least force; -inf: none").or_else(-kInfinity).may_be_infinite();
    s.param(force_upper, "force_upper", unit::one, "largest force; inf: none").or_else(kInfinity).may_be_infinite();
    s.output(effort, "effort", unit::one, "torque or force on b along the coordinate, N m or N");
}

Result<void> prepare_actuator(Row row, ActuatorRows& rows, const Bodies& bodies)
{
    if (!(rows.control_lower[row] <= rows.control_upper[row])) return reason("control_lower must not be above control_upper");
    if (!(rows.force_lower[row] <= rows.force_upper[row])) return reason("force_lower must not be above force_upper");
    return rows.place_coordinate(row, bodies);
}

namespace
{

/// F without its limits.
double wanted_force(const ActuatorRows& rows, Row row, const Coordinate& c)
{
    const double u = std::clamp(rows.control[row], rows.control_lower[row], rows.control_upper[row]);
    const Vec3& bias = rows.bias[row];
    return rows.gain[row] * u + bias.x + rows.gear[row] * (bias.y * c.x + bias.z * c.speed);
}

double effort_of(const ActuatorRows& rows, Row row, const Coordinate& c)
{
    return rows.gear[row] * std::clamp(wanted_force(rows, row, c), rows.force_lower[row], rows.force_upper[row]);
}

}  // namespace

void apply_actuator(const StepContext& step, Rows which, const ActuatorRows& rows, const Bodies& bodies, const Shafts& shafts,
                    Wrenches& wrenches)
{
    for (const Row row : which)
    {
        const Coordinate c = coordinate_of(rows, row, bodies, shafts, step.time);
        wrenches.begin(step.component_of_row[row]);
        add_effort(c, effort_of(rows, row, c), bodies, shafts, wrenches);
    }
}

void linearize_actuator(const StepContext& step, Rows which, const ActuatorRows& rows, const Bodies& bodies, const Shafts& shafts,
                        RowSink& sink)
{
    for (const Row row : which)
    {
        const Coordinate c = coordinate_of(rows, row, bodies, shafts, step.time);
        const double gear = rows.gear[row], wanted = wanted_force(rows, row, c);
        const double lower = rows.force_lower[row], upper = rows.force_upper[row], force = std::clamp(wanted, lower, upper);
        ConstraintRow change = change_along(c, -gear * gear * rows.bias[row].y, -gear * gear * rows.bias[row].z);
        change.bias = gear * (wanted - force);
        change.lower = gear * ((gear > 0 ? lower : upper) - force), change.upper = gear * ((gear > 0 ? upper : lower) - force);
        sink.begin(step.component_of_row[row]);
        sink.add(change);
    }
}

void finish_actuator(const StepContext& step, Rows which, ActuatorRows& rows, const Bodies& bodies, const Shafts& shafts)
{
    for (const Row row : which)
    {
        keep_coordinate(rows, row, bodies, shafts, step.time);
        rows.effort[row] = effort_of(rows, row, coordinate_of(rows, row, bodies, shafts, step.time));
    }
}

}  // namespace plab::constraints
