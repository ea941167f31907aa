/// Pairwise and weighted by inertia: each pair is corrected by itself, the host sweeps over all until nothing changes.
///
///   lambda = -C' / (1/J_b + f^2 / J_a)         and the same with accelerations, where lambda is a torque
///   J_eff  = J_a + f^2 J_b                     that a torque on the driver feels
/// Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems (1996), section 3, for one row.
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
