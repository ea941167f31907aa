/// Constraint/AngularVelocity: couplings that keep the speeds of two shafts at a ratio. Three algorithms, which are interchangeable.
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

/// Constraint/AngularVelocity/Assign, a one-way coupling: the driven shaft copies the speed of the driver, and the driver feels no
/// reaction.
struct AssignRows : CouplingRows
{
    void describe(Schema& s);
};

/// Phase::Couple: rate_b = f rate_a.
void assign_driven(const StepContext& step, Rows which, const AssignRows& rows, ShaftMotion& motion);

/// Constraint/AngularVelocity/Impulse: pairwise corrections weighted by inertia. Each pair is corrected by itself, and the host sweeps over
/// all pairs until nothing changes (projected Gauss-Seidel without bounds). lambda makes C' zero after the correction:
///
///   lambda = -C' / (1/J_b + f^2 / J_a)         likewise for accelerations, where lambda is a torque
///   J_eff  = J_a + f^2 J_b                     effective inertia for a torque on the driver
/// lambda is the difference of two speeds that agree in most digits where |f| is far from 1, so one correction leaves rounding errors that
/// the next sweep removes; a pair is always swept at least twice.
/// Source: Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems, PhD thesis, UC Berkeley (1996), section 3, for a single row.
struct ImpulseRows : CouplingRows
{
    void describe(Schema& s);
};

/// Phase::Couple.
void exchange_impulses(const StepContext& step, Rows which, const ImpulseRows& rows, ShaftMotion& motion);

/// Constraint/AngularVelocity/Graph: reduced coordinates. Shafts are the nodes of a graph and couplings its edges. In a tree of it one
/// angle determines all others, speed_i = rho_i speed_root, with rho_i the product of the factors along the path from the root. By
/// d'Alembert's principle the torques between the teeth do no work together, so they drop out of the equation of that one coordinate:
///
///   J_root = sum rho_i^2 J_i,  alpha_root = sum rho_i tau_i / J_root
///
/// Only the root is integrated; the others follow without drift, however long the train. An edge that closes a loop adds no equation if the
/// factors around the loop multiply to 1, and contradicts the others if not. To decide that without a tolerance, ratios are products of
/// exact rationals. This type only names the edges; the host keeps the graph (server/simulation/shafts/constraint_graph.h).
/// Source: the generalised coordinates of analytical mechanics, e.g. H. Goldstein, Classical mechanics, sections 1.3 and 1.4.
struct GraphRows : CouplingRows
{
    void describe(Schema& s);
};

/// Phase::Connect.
void connect(const StepContext& step, Rows which, const GraphRows& rows, RatioGraph& graph);

}  // namespace plab::constraints
