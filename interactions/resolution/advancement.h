/// Resolution/ConservativeAdvancement: approaches a contact from the separated side in steps that cannot pass it.
///
///   t' = t + gap(t) / closing,    closing >= any speed at which the gap can shrink in the rest of the piece
///
/// The host provides this bound; it covers linear speeds along the normal, forces, and rotation about the centres. Source:
/// Mirtich, Impulse-based Dynamic Simulation, PhD thesis, UC Berkeley (1996), section 2.3.
#pragma once

#include "plab/collision.h"
#include "plab/context.h"
#include "plab/schema.h"

namespace plab::resolution
{

struct AdvancementRows
{
    Column<double> gap_tolerance;         // m
    Column<double> max_work;              // 1
    Column<std::int64_t> max_iterations;  // steps

    void describe(Schema& schema);
};
/// Phase::Locate.
void advance_to_contact(const StepContext& context, Row row, const AdvancementRows& rows, Trial& trial);

}  // namespace plab::resolution
