/// Two coordinates in a ratio, over any number of turns: each is the turn of a body or shaft about an axis, or the slide of a body along
/// one, relative to a base.
///
///   C = q_driven - factor q_driver - offset = 0
///   turn    q, J and bias as in spin.h
///   slide   q = t . d, t fixed in the base, d from the base's point to the body's origin: a travel row of sides.h
///
/// Coupler is the general one: fingers of a gripper that close together, joints of a robot that follow another one (the `mimic` of URDF).
/// In a Rack the driver turns and the driven slides, and the factor is the radius of the pinion. The coordinates need joints of their own,
/// a hinge or a slider. What acts is a couple where a coordinate turns, and a force through the origin where it slides; on the bases the
/// opposite.
#pragma once

#include <optional>

#include "joints/spin.h"

namespace plab::constraints
{

/// The turn or slide of one participant.
struct CoupledColumns : SpinColumns
{
    Column<std::string> along;
    Column<Vec3> base_point;  // m, in the base, or in W
    std::optional<bool> slides_always;

    /// `slides`: empty: a parameter says it.
    void describe_coordinate(Schema& s, const std::string& prefix, const std::string& whose, std::optional<bool> slides);
    /// Phase::Prepare. Returns whether the axis is new.
    Result<bool> place_coordinate(Row row, Ref participant, Ref base, const Bodies& bodies);
    /// Phase::Drive and Phase::Finish: turns are counted.
    void begin_turn(Row row, Ref participant, Ref base, const Bodies& bodies, const Shafts& shafts, double now);
    void keep_turn(Row row, const Coordinate& c, double now);
    bool slides(Row row) const { return slides_always ? *slides_always : along[row] == "slide"; }
    Coordinate coordinate_of(Row row, Ref participant, Ref base, const Bodies& bodies, const Shafts& shafts, double now) const;
};

struct CoupledRows
{
    Column<Ref> driver, driven, carrier;
    Column<double> factor;
    CoupledColumns driver_coordinate, driven_coordinate;
    Column<double> offset, engaged_factor;
    Column<std::int64_t> placed_as;  ///< which sides slid, and in which order they stand, when axes were placed last; -1: they were not
    Column<double> driver_position, driven_position, driver_effort, driven_effort;
    Column<double> position_error, speed_error;
    Column<std::int64_t> redundant;

    /// The base of a participant; the axle of a shaft is fixed in the world.
    Ref carried(Ref participant, Row row) const { return participant.facet == Facet::Body ? carrier[row] : Ref{}; }
    Ref base_of_driver(Row row) const { return carried(driver[row], row); }
    /// Another motion, or another base, needs axes at the present poses.
    void place_anew_as(Row row, bool chained);
    void describe_outputs(Schema& s, const std::string& driver_name, const std::string& driven_name);
};
struct CouplerRows : CoupledRows
{
    Column<bool> in_chain;

    void describe(Schema& s);
    bool chained(Row row) const { return in_chain[row]; }
    Ref base_of_driven(Row row) const { return in_chain[row] ? driver[row] : carried(driven[row], row); }
};
struct RackRows : CoupledRows
{
    void describe(Schema& s);
    static bool chained(Row) { return false; }
    Ref base_of_driven(Row row) const { return carrier[row]; }
};

// For CouplerRows and RackRows.
template <class Table>
Result<void> prepare_coupled(Row row, Table& rows, const Bodies& bodies);
template <class Table>
void begin_coupled(const StepContext& step, Rows which, Table& rows, const Bodies& bodies, const Shafts& shafts);
template <class Table>
void constrain_coupled(const StepContext& step, Rows which, const Table& rows, const Bodies& bodies, const Shafts& shafts, RowSink& sink);
template <class Table>
void finish_coupled(const StepContext& step, Rows which, Table& rows, const Bodies& bodies, const Shafts& shafts,
                    const RowReports& reports);

}  // namespace plab::constraints
