/// Pairwise corrections weighted by inertia: each pair is corrected by itself, and the host sweeps over all pairs until nothing
/// changes.
///
///   lambda = -C' / (1/J_b + f^2 / J_a)         likewise for accelerations, where lambda is a torque
///   J_eff  = J_a + f^2 J_b                     effective inertia for a torque on the driver
/// Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems (1996), section 3, for a single row.
#pragma once

#include "angular_velocity/coupling_rows.h"

namespace plab::constraints
{

struct ImpulseRows : CouplingRows
{
    void describe(Schema& s);
};

/// Phase::Couple.
void exchange_impulses(const StepContext& step, Rows which, const ImpulseRows& rows, ShaftMotion& motion);

}  // namespace plab::constraints
