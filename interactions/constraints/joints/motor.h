/// Motor: turns b against a, slides it along a or changes the distance between two points, at a given speed; or moves it to a target and
/// holds it there.
///
/// Both are conditions on a speed; neither has a position error that a projection could remove. The servo's own bias makes its law hold for
/// accelerations too, d/dt of the line below, so that a solver of high order sees a smooth equation.
///
///   rate      J v = speed
///   servo     J v = gain (target - x), within +-speed: x approaches its target as exp(-gain t)      bias = -gain J v
///
/// J v is the angular velocity about the axis, or the rate of travel along it or of the distance. If the effort of a motor is limited, its
/// row can only be solved by a manager.
#pragma once

#include "joints/spin.h"

namespace plab::constraints
{

/// A coordinate between a and b, over bodies or shafts: turning about an axis, travel along it, or the distance between two points.
struct CoordinateRows : PairRows, SpinColumns
{
    Column<std::string> along;
    Column<Vec3> travel_axis_a, placed_travel_axis;  // fixed in a
    Column<double> position, speed_now;              // rad or m, rad/s or m/s

    void describe_coordinate(Schema& s, std::vector<std::string> coordinates);
    Result<void> place_coordinate(Row row, const Bodies& bodies);
    bool turns(Row row) const { return along[row] == "turn"; }
    bool of_shafts(Row row) const { return b[row].facet == Facet::Shaft; }
};

Coordinate coordinate_of(const CoordinateRows& rows, Row row, const Bodies& bodies, const Shafts& shafts, double now);
/// Adds `effort` (N m or N) along the coordinate to the wrench that has been begun.
void add_effort(const Coordinate& c, double effort, const Bodies& bodies, const Shafts& shafts, Wrenches& wrenches);
/// How an effort -stiffness x - damping x' changes (RowKind::ForceChange); negative ones, which drive, count as 0.
ConstraintRow change_along(const Coordinate& c, double stiffness, double damping);
/// Phase::Drive and Phase::Finish of coordinates that count turns.
void begin_coordinate(CoordinateRows& rows, Row row, const Bodies& bodies, const Shafts& shafts, double now);
void keep_coordinate(CoordinateRows& rows, Row row, const Bodies& bodies, const Shafts& shafts, double now);

template <class Table>
void begin_turning(const StepContext& step, Rows which, Table& rows, const Bodies& bodies, const Shafts& shafts)
{
    for (const Row row : which) begin_coordinate(rows, row, bodies, shafts, step.time);
}
template <class Table>
Result<void> prepare_coordinate(Row row, Table& rows, const Bodies& bodies)
{
    return rows.place_coordinate(row, bodies);
}
template <class Table>
void finish_coordinate(const StepContext& step, Rows which, Table& rows, const Bodies& bodies, const Shafts& shafts,
                       const RowReports& reports)
{
    for (const Row row : which)
    {
        keep_coordinate(rows, row, bodies, shafts, step.time);
        rows.take_report(row, reports, step.component_of_row[row]);
    }
}

struct MotorRows : CoordinateRows, ReactionColumns
{
    Column<std::string> mode;
    Column<double> speed, target, gain, max_effort;
    Column<Ref> manager;
    void describe(Schema& s);
};
Result<void> prepare_motor(Row row, MotorRows& rows, const Bodies& bodies);
void constrain_motor(const StepContext& step, Rows which, const MotorRows& rows, const Bodies& bodies, const Shafts& shafts, RowSink& sink);

/// TorsionSpring: a torque -(k (x - rest) + c x') on b about the axis, or a force along it.
struct TorsionSpringRows : CoordinateRows
{
    Column<double> stiffness, damping, rest, effort;
    void describe(Schema& s);
};
void apply_torsion(const StepContext& step, Rows which, const TorsionSpringRows& rows, const Bodies& bodies, const Shafts& shafts,
                   Wrenches& wrenches);
void linearize_torsion(const StepContext& step, Rows which, const TorsionSpringRows& rows, const Bodies& bodies, const Shafts& shafts,
                       RowSink& sink);
void stored_by_torsion(const StepContext& step, Rows which, const TorsionSpringRows& rows, const Bodies& bodies, const Shafts& shafts,
                       StoredEnergy& stored);
void finish_torsion(const StepContext& step, Rows which, TorsionSpringRows& rows, const Bodies& bodies, const Shafts& shafts);

}  // namespace plab::constraints
