#include "joints/distance.h"

namespace plab::constraints
{

void LengthRows::describe_length(Schema& s)
{
    describe_pair(s);
    s.param(length, "length", unit::metre, "between the points; infinite: not given, then the distance when the joint is placed")
        .or_else(kInfinity)
        .not_negative()
        .may_be_infinite();
    s.state(placed_length, "placed_length", unit::metre, "between the points when the joint was placed");
    s.output(distance, "distance", unit::metre, "between the points");
    s.output(distance_rate, "distance_rate", unit::metre_per_second, "its rate");
}

void LengthRows::place_length(Row row, const Bodies& bodies)
{
    const bool fresh = !placed[row] || placed_anchor[row] != anchor[row];
    place_points(row, bodies, Missing::Origin);
    if (fresh) placed_length[row] = plab::length(sides(row, bodies).d);
}

void LengthRows::measure(Row row, const Bodies& bodies)
{
    const Stretch s = stretch_of(sides(row, bodies));
    distance[row] = s.distance, distance_rate[row] = s.rate;
}

void DistanceRows::describe(Schema& s)
{
    describe_length(s);
    describe_reaction(s, "b");
}

void SpringDamperRows::describe(Schema& s)
{
    describe_length(s);
    s.param(stiffness, "stiffness", unit::one, "k, N/m").or_else(0).not_negative();
    s.param(damping, "damping", unit::kilogram_per_second, "c, along the spring").or_else(0).not_negative();
    s.output(force, "force", unit::newton, "on b, in the world");
}

Stretch stretch_of(const Sides& sides)
{
    Stretch s{sides, length(sides.d), 0, {}};
    s.u = s.distance > 0 ? sides.d / s.distance : normalized(sides.rate);
    if (s.u == Vec3{}) s.u = {1, 0, 0};
    s.rate = dot(s.u, sides.rate);
    return s;
}

ConstraintRow stretch_row(const Stretch& s, double length, double sign, std::uint32_t feature)
{
    const Vec3 u = sign * s.u;
    ConstraintRow row = row_over(s.sides, u, -cross(s.sides.a.r, u), cross(s.sides.b.r, u), feature);
    row.error = sign * (s.distance - length);
    const double across = length_squared(s.sides.rate - s.rate * s.u);
    row.bias = -dot(u, s.sides.centripetal());
    if (s.distance > 0) row.bias -= sign * across / s.distance;
    return row;
}

Coordinate stretching(const Stretch& s) { return {s.distance, s.rate, stretch_row(s, s.distance, 1, 0)}; }

void prepare_distance(Row row, DistanceRows& rows, const Bodies& bodies) { rows.place_length(row, bodies); }

void constrain_distance(const StepContext& step, Rows which, const DistanceRows& rows, const Bodies& bodies, RowSink& sink)
{
    for (const Row row : which)
    {
        sink.begin(step.component_of_row[row]);
        sink.add(stretch_row(stretch_of(rows.sides(row, bodies)), rows.rest(row), 1, 0));
    }
}

void finish_distance(const StepContext& step, Rows which, DistanceRows& rows, const Bodies& bodies, const RowReports& reports)
{
    for (const Row row : which)
    {
        rows.measure(row, bodies);
        rows.take_report(row, reports, step.component_of_row[row]);
    }
}

void prepare_spring(Row row, SpringDamperRows& rows, const Bodies& bodies) { rows.place_length(row, bodies); }

namespace
{

Vec3 spring_force(const SpringDamperRows& rows, Row row, const Stretch& s)
{
    return -(rows.stiffness[row] * (s.distance - rows.rest(row)) + rows.damping[row] * s.rate) * s.u;
}

}  // namespace

void apply_spring(const StepContext& step, Rows which, const SpringDamperRows& rows, const Bodies& bodies, Wrenches& wrenches)
{
    for (const Row row : which)
    {
        const Stretch s = stretch_of(rows.sides(row, bodies));
        const Vec3 force = spring_force(rows, row, s);
        wrenches.begin(step.component_of_row[row]);
        if (bodies.dynamic(rows.b[row].index)) wrenches.add_force_at(rows.b[row], force, s.sides.b.p);
        if (rows.a[row].valid() && bodies.dynamic(rows.a[row].index)) wrenches.add_force_at(rows.a[row], -force, s.sides.a.p);
    }
}

void linearize_spring(const StepContext& step, Rows which, const SpringDamperRows& rows, const Bodies& bodies, RowSink& sink)
{
    for (const Row row : which)
    {
        const Stretch s = stretch_of(rows.sides(row, bodies));
        ConstraintRow change = row_over(s.sides, s.u, -cross(s.sides.a.r, s.u), cross(s.sides.b.r, s.u), 0);
        change.kind = RowKind::ForceChange, change.stiffness = rows.stiffness[row], change.damping = rows.damping[row];
        sink.begin(step.component_of_row[row]);
        sink.add(change);
    }
}

void stored_by_spring(Rows which, const SpringDamperRows& rows, const Bodies& bodies, StoredEnergy& stored)
{
    for (const Row row : which)
    {
        const double stretch = stretch_of(rows.sides(row, bodies)).distance - rows.rest(row);
        stored.add(0.5 * rows.stiffness[row] * stretch * stretch, rows.b[row], rows.a[row]);
    }
}

void finish_spring(Rows which, SpringDamperRows& rows, const Bodies& bodies)
{
    for (const Row row : which)
    {
        rows.measure(row, bodies);
        rows.force[row] = spring_force(rows, row, stretch_of(rows.sides(row, bodies)));
    }
}

}  // namespace plab::constraints
