#include "joints/coupler.h"

#include <utility>

namespace plab::constraints
{

// One coordinate ------------------------------------------------------------------------------------------------------

void CoupledColumns::describe_coordinate(Schema& s, const std::string& prefix, const std::string& whose, std::optional<bool> slides)
{
    slides_always = slides;
    if (!slides)
        s.param(along, prefix + "along", unit::one, "motion of " + whose + ": turn about the axis, slide along it")
            .or_else("turn")
            .one_of({"turn", "slide"});
    if (slides && *slides)
        describe_axle(s, prefix, whose);
    else
        describe_spin(s, prefix, whose);
    if (slides && !*slides) return;
    s.state(base_point, prefix + "base_point", unit::metre, "where the origin of " + whose + " was when its axis was placed, in the base");
}

Result<bool> CoupledColumns::place_coordinate(Row row, Ref participant, Ref base, const Bodies& bodies)
{
    const bool fresh = participant.facet == Facet::Body && placed_axis[row] != axis[row];
    if (!slides(row))
    {
        if (auto placed = place(row, participant, base, bodies); !placed) return placed.errors();
        return fresh;
    }
    if (participant.facet != Facet::Body) return reason("a shaft cannot slide");
    if (base.valid() && base.facet != Facet::Body) return reason("a body cannot slide along a shaft");
    const Side from = side_of(bodies, base, {}), to = side_of(bodies, participant, {});
    place_axis(row, from.q, to.q);
    if (fresh) base_point[row] = rotate(conjugate(from.q), to.p - from.p);
    return fresh;
}

void CoupledColumns::begin_turn(Row row, Ref participant, Ref base, const Bodies& bodies, const Shafts& shafts, double now)
{
    if (!slides(row)) begin(row, spin_of(row, participant, base, bodies, shafts), now);
}

void CoupledColumns::keep_turn(Row row, const Coordinate& c, double now)
{
    if (!slides(row)) angle[row] = c.x, start(row, c.speed, now);
}

Coordinate CoupledColumns::coordinate_of(Row row, Ref participant, Ref base, const Bodies& bodies, const Shafts& shafts, double now) const
{
    if (!slides(row))
    {
        const Spin spin = spin_of(row, participant, base, bodies, shafts);
        return turning(spin, angle_now(row, spin, now));
    }
    const Sides s = sides_of(side_of(bodies, base, base_point[row]), side_of(bodies, participant, {}));
    return sliding(s, rotate(s.a.q * frame_a[row], Vec3{0, 0, 1}));
}

// Two of them ---------------------------------------------------------------------------------------------------------

void CoupledRows::describe_outputs(Schema& s, const std::string& driver_name, const std::string& driven_name)
{
    s.state(offset, "offset", unit::one, "of " + driven_name + " when they engaged, rad or m");
    s.state(engaged_factor, "engaged_factor", unit::one, "factor for which offset was taken; 0: not engaged yet");
    s.state(placed_as, "placed_as", unit::one,
            "how the axes were placed: 1: " + driver_name + " slides, 2: " + driven_name + " slides, 4: in a chain; their sum; -1: not yet")
        .initially(-1);
    s.output(driver_position, driver_name + "_position", unit::one, "value of its coordinate, rad or m");
    s.output(driven_position, driven_name + "_position", unit::one, "likewise");
    s.output(driver_effort, driver_name + "_effort", unit::one,
             "on it along its coordinate, at the last solver stage of the step, N m or N");
    s.output(driven_effort, driven_name + "_effort", unit::one, "likewise");
    s.output(position_error, "position_error", unit::one, "of " + driven_name + " since they engaged, rad or m").reported_as_error();
    s.output(speed_error, "speed_error", unit::one, "of its rate").reported_as_error();
    s.output(redundant, "redundant", unit::one, "1: the row is implied by other rows");
}

void CoupledRows::place_anew_as(Row row, bool chained)
{
    const std::int64_t as = (driver_coordinate.slides(row) ? 1 : 0) + (driven_coordinate.slides(row) ? 2 : 0) + (chained ? 4 : 0);
    if (std::exchange(placed_as[row], as) == as) return;
    driver_coordinate.placed_axis[row] = driven_coordinate.placed_axis[row] = {};
    engaged_factor[row] = 0;
}

void CouplerRows::describe(Schema& s)
{
    s.role(driver, "driver", {Facet::Body, Facet::Shaft}, "the leading side").writes();
    s.role(driven, "driven", {Facet::Body, Facet::Shaft}, "the side that follows; it acts back on the other").writes();
    s.role(carrier, "carrier", {Facet::Body}, "the body relative to which both move; none: the world").optional().writes();
    s.param(factor, "factor", unit::one, "motion of driven for each of driver: rad or m for rad or m").or_else(1).nonzero();
    s.param(in_chain, "in_chain", unit::one, "driven moves relative to driver, as the next joint of a finger, instead of the carrier")
        .or_else(false);
    driver_coordinate.describe_coordinate(s, "driver_", "driver", {});
    driven_coordinate.describe_coordinate(s, "driven_", "driven", {});
    describe_outputs(s, "driver", "driven");
}

void RackRows::describe(Schema& s)
{
    s.role(driver, "pinion", {Facet::Body, Facet::Shaft}, "the wheel").writes();
    s.role(driven, "rack", {Facet::Body}, "the bar with teeth").writes();
    s.role(carrier, "carrier", {Facet::Body}, "the body on which both are borne; none: the world").optional().writes();
    s.param(factor, "radius", unit::metre, "of the pinion's pitch circle: travel per radian").positive();
    driver_coordinate.describe_coordinate(s, "pinion_", "the pinion", false);
    driven_coordinate.describe_coordinate(s, "rack_", "the rack, in which it moves as the pinion turns positively", true);
    describe_outputs(s, "pinion", "rack");
}

namespace
{

struct CoupledPair
{
    Coordinate driver, driven;
    double phase = 0, speed = 0;  ///< before the offset
};

template <class Table>
CoupledPair coupled_pair(const Table& rows, Row row, const Bodies& bodies, const Shafts& shafts, double now)
{
    CoupledPair p;
    p.driver = rows.driver_coordinate.coordinate_of(row, rows.driver[row], rows.base_of_driver(row), bodies, shafts, now);
    p.driven = rows.driven_coordinate.coordinate_of(row, rows.driven[row], rows.base_of_driven(row), bodies, shafts, now);
    p.phase = p.driven.x - rows.factor[row] * p.driver.x;
    p.speed = p.driven.speed - rows.factor[row] * p.driver.speed;
    return p;
}

/// The block of driven is the last one, as reports are of that.
ConstraintRow row_of(const CoupledPair& p, double factor, Ref driven)
{
    ConstraintRow out;
    add_row(p.driver.row, -factor, out);
    add_row(p.driven.row, 1, out);
    for (std::uint32_t k = 0; k < out.count; ++k)
        if (out.blocks[k].participant == driven) std::swap(out.blocks[k], out.blocks[out.count - 1]);
    return out;
}

/// What acts along the coordinate of driven, from what that does to the last participant of the row.
double multiplier(const ConstraintRow& row, const RowReport& report)
{
    const RowBlock& last = row.blocks[row.count - 1];
    const double square = length_squared(last.linear) + length_squared(last.angular);
    return square > 0 ? (dot(last.linear, report.force) + dot(last.angular, report.torque)) / square : 0.0;
}

}  // namespace

template <class Table>
Result<void> prepare_coupled(Row row, Table& rows, const Bodies& bodies)
{
    rows.place_anew_as(row, rows.chained(row));
    const auto first = rows.driver_coordinate.place_coordinate(row, rows.driver[row], rows.base_of_driver(row), bodies);
    if (!first) return first.errors();
    const auto second = rows.driven_coordinate.place_coordinate(row, rows.driven[row], rows.base_of_driven(row), bodies);
    if (!second) return second.errors();
    if (*first || *second) rows.engaged_factor[row] = 0;
    return {};
}

template <class Table>
void begin_coupled(const StepContext& step, Rows which, Table& rows, const Bodies& bodies, const Shafts& shafts)
{
    for (const Row row : which)
    {
        rows.driver_coordinate.begin_turn(row, rows.driver[row], rows.base_of_driver(row), bodies, shafts, step.time);
        rows.driven_coordinate.begin_turn(row, rows.driven[row], rows.base_of_driven(row), bodies, shafts, step.time);
        const CoupledPair p = coupled_pair(rows, row, bodies, shafts, step.time);
        if (rows.engaged_factor[row] != rows.factor[row]) rows.offset[row] = p.phase, rows.engaged_factor[row] = rows.factor[row];
    }
}

template <class Table>
void constrain_coupled(const StepContext& step, Rows which, const Table& rows, const Bodies& bodies, const Shafts& shafts, RowSink& sink)
{
    for (const Row row : which)
    {
        const CoupledPair p = coupled_pair(rows, row, bodies, shafts, step.time);
        ConstraintRow out = row_of(p, rows.factor[row], rows.driven[row]);
        out.error = p.phase - rows.offset[row];
        sink.begin(step.component_of_row[row]);
        sink.add(out);
    }
}

template <class Table>
void finish_coupled(const StepContext& step, Rows which, Table& rows, const Bodies& bodies, const Shafts& shafts, const RowReports& reports)
{
    for (const Row row : which)
    {
        const CoupledPair p = coupled_pair(rows, row, bodies, shafts, step.time);
        rows.driver_coordinate.keep_turn(row, p.driver, step.time);
        rows.driven_coordinate.keep_turn(row, p.driven, step.time);
        const RowReport report = reports.of(step.component_of_row[row]);
        rows.driver_position[row] = p.driver.x, rows.driven_position[row] = p.driven.x;
        rows.driven_effort[row] = multiplier(row_of(p, rows.factor[row], rows.driven[row]), report);
        rows.driver_effort[row] = -rows.factor[row] * rows.driven_effort[row];
        rows.position_error[row] = p.phase - rows.offset[row], rows.speed_error[row] = p.speed;
        rows.redundant[row] = report.redundant;
    }
}

#define PLAB_COUPLED(Table)                                                                                          \
    template Result<void> prepare_coupled(Row, Table&, const Bodies&);                                               \
    template void begin_coupled(const StepContext&, Rows, Table&, const Bodies&, const Shafts&);                     \
    template void constrain_coupled(const StepContext&, Rows, const Table&, const Bodies&, const Shafts&, RowSink&); \
    template void finish_coupled(const StepContext&, Rows, Table&, const Bodies&, const Shafts&, const RowReports&)
PLAB_COUPLED(CouplerRows);
PLAB_COUPLED(RackRows);
#undef PLAB_COUPLED

}  // namespace plab::constraints
