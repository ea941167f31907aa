/// Shared by the algorithms of Constraint/AngularVelocity, which are interchangeable.
///
///   C  = angle_b - f angle_a - phase_offset    rad      a: driver, b: driven, f: velocity factor
///   C' = speed_b - f speed_a                   rad/s
///   J  = [ -f | 1 ]                            lambda: torque on b about its axle; a receives -f lambda
#pragma once

#include "angular_velocity/ratio.h"
#include "plab/registrar.h"

namespace plab::constraints
{

/// Columns of one algorithm's table. Angles are never wrapped, so C needs no special case for whole turns.
struct CouplingRows
{
    Column<Ref> driver, driven;
    Column<double> velocity_factor;  // turns of driven per turn of driver
    Column<std::int64_t> driver_teeth, driven_teeth;
    Column<std::string> mesh;
    Column<double> phase_offset, phase_factor;   // rad, 1
    Column<double> velocity_error, phase_error;  // rad/s, rad
    Column<double> torque;                       // N m
    Column<Ratio> ratio;

protected:
    RoleBuilder describe_driver(Schema& s);
    RoleBuilder describe_driven(Schema& s);
    void describe_fields(Schema& s);
};

/// Sets the ratio from the factor or the tooth counts.
Result<void> prepare_ratio(CouplingRows& rows, Row row);
/// Errors and torque at the end of a step. The phase is measured from the end of the first step, and anew after a change of the
/// factor.
void measure_coupling(CouplingRows& rows, Row row, const Shafts& shafts, const ShaftReactions& reactions, std::uint32_t component);

/// Phase::Prepare.
template <class Table>
Result<void> prepare(Row row, Table& rows)
{
    return prepare_ratio(rows, row);
}

/// Phase::Finish.
template <class Table>
void finish(const StepContext& step, Rows which, Table& rows, const Shafts& shafts, const ShaftReactions& reactions)
{
    for (const Row row : which) measure_coupling(rows, row, shafts, reactions, step.component_of_row[row]);
}

}  // namespace plab::constraints
