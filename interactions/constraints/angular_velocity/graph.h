/// Reduced coordinates: coupled shafts form one degree of freedom, and only the root of each tree is integrated.
///
///   J_root = sum rho_i^2 J_i,  alpha_root = sum rho_i tau_i / J_root,  speed_i = rho_i speed_root
/// Ratios to the root are products of exact rationals; loops are compared exactly
/// (server/simulation/shafts/constraint_graph.h).
#pragma once

#include "angular_velocity/coupling_rows.h"

namespace plab::constraints
{

struct GraphRows : CouplingRows
{
    void describe(Schema& s);
};

/// Phase::Connect.
void connect(const StepContext& step, Rows which, const GraphRows& rows, RatioGraph& graph);

}  // namespace plab::constraints
