/// What the resolutions share: how fine a bracket can be, and what is said when a contact is hard to find.
#pragma once

#include <algorithm>
#include <string>

#include "plab/collision.h"
#include "plab/context.h"
#include "plab/number_text.h"
#include "plab/schema.h"

namespace plab::resolution
{

/// s: below 2^-48 of the step the time itself has hardly a bit left to choose.
inline double shortest_bracket(const Trial& trial, double tolerance = 0) { return std::max(tolerance, 0x1p-48 * trial.step); }

/// How much the host may do to locate events. The largest of all resolutions of a scene counts.
inline void describe_work(Schema& s, Column<double>& max_work)
{
    s.param(max_work, "max_work", unit::one,
            "what locating may take in a step, as a multiple of the step without it, beside 100000 looks that are always allowed; beyond "
            "it the rest of the step is answered at its end (resolution.over_budget)")
        .or_else(20)
        .positive();
}

/// Two bodies that pass close by one another cost many small steps.
inline void tell_grazing(const StepContext& context, Row row, const Trial& trial)
{
    context.emit(row, "resolution.grazing", Severity::Warning,
                 "two bodies pass one another within " + rounded_text(trial.gap_begin) + " m; after " + std::to_string(trial.iteration) +
                     " looks it is not certain that they do not touch; allow more max_iterations or take shorter steps",
                 {trial.begin, trial.gap_begin});
}

}  // namespace plab::resolution
