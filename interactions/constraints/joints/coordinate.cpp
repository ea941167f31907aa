#include "joints/motor.h"

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
    Coordinate c;
    if (rows.turns(row))
    {
        const Spin spin = rows.spin_of(row, rows.b[row], rows.a[row], bodies, shafts);
        c.x = rows.angle_now(row, spin, now), c.speed = spin.speed;
        add_spin(spin, 1, c.row);
        return c;
    }
    const Sides s = rows.sides(row, bodies);
    const Vec3 n = rotate(s.a.q, rows.travel_axis_a[row]);
    c.row = travel_row(s, n, 0, 0);
    c.x = c.row.error, c.row.error = 0;
    c.speed = dot(n, s.rate) + dot(cross(s.a.w, n), s.d);
    return c;
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

}  // namespace plab::constraints
