/// A massless rod between two points, and the spring that can replace it. One family.
///
///   Distance       |d| = l                                    1 row: J v = u . d', u = d/|d|
///                  bias = -( (|d'|^2 - (u . d')^2) / |d| + u . (w_b x (w_b x r_b) - w_a x (w_a x r_a)) )
///   SpringDamper   f = -(k (|d| - l) + c u . d') u on b       force; stores k (|d| - l)^2 / 2
#pragma once

#include "joints/pair.h"
#include "joints/spin.h"

namespace plab::constraints
{

/// Two points and the length between them.
struct LengthRows : PairRows
{
    Column<double> length;         // m, as given
    Column<double> placed_length;  // m, as measured when the joint was placed
    Column<double> distance, distance_rate;

    void describe_length(Schema& s);
    void place_length(Row row, const Bodies& bodies);
    double rest(Row row) const { return length[row] < kInfinity ? length[row] : placed_length[row]; }
    void measure(Row row, const Bodies& bodies);
};
struct DistanceRows : LengthRows, ReactionColumns
{
    void describe(Schema& s);
};
struct SpringDamperRows : LengthRows
{
    Column<double> stiffness, damping;  // N/m, N s/m
    Column<Vec3> force;
    void describe(Schema& s);
};

/// The vector between the points at the present state.
struct Stretch
{
    Sides sides;
    double distance = 0, rate = 0;
    Vec3 u;  ///< from a to b; if the points coincide, their direction of motion, or any direction
};
Stretch stretch_of(const Sides& sides);
/// The distance as a coordinate.
Coordinate stretching(const Stretch& s);
/// A row with the error sign (|d| - length).
ConstraintRow stretch_row(const Stretch& s, double length, double sign, std::uint32_t feature);

void prepare_distance(Row row, DistanceRows& rows, const Bodies& bodies);
void constrain_distance(const StepContext& step, Rows which, const DistanceRows& rows, const Bodies& bodies, RowSink& sink);
void finish_distance(const StepContext& step, Rows which, DistanceRows& rows, const Bodies& bodies, const RowReports& reports);

void prepare_spring(Row row, SpringDamperRows& rows, const Bodies& bodies);
void apply_spring(const StepContext& step, Rows which, const SpringDamperRows& rows, const Bodies& bodies, Wrenches& wrenches);
void linearize_spring(const StepContext& step, Rows which, const SpringDamperRows& rows, const Bodies& bodies, RowSink& sink);
void stored_by_spring(Rows which, const SpringDamperRows& rows, const Bodies& bodies, StoredEnergy& stored);
void finish_spring(Rows which, SpringDamperRows& rows, const Bodies& bodies);

}  // namespace plab::constraints
