/// Shared by the resolutions: the shortest useful bracket, the work limit, and the warning about contacts that are hard to find.
#pragma once

#include <algorithm>
#include <string>

#include "plab/collision.h"
#include "plab/context.h"
#include "plab/number_text.h"
#include "plab/schema.h"

namespace plab::resolution
{

/// s: below 2^-48 of the step, consecutive representable times are hardly distinct.
inline double shortest_bracket(const EventBracket& trial, double tolerance = 0) { return std::max(tolerance, 0x1p-48 * trial.step); }

/// Describes the limit on the work for locating events. The largest value of all resolutions of a scene applies.
inline void describe_work(Schema& s, Column<double>& max_work)
{
    s.param(max_work, "max_work", unit::one,
            "limit on the work for locating events in a step, as a multiple of the work of the step without it; "
            "100000 queries are always allowed. Beyond the limit, the remaining events are answered at the end "
            "of the step (resolution.over_budget)")
        .or_else(20)
        .positive();
}

/// Two bodies that pass one another at a small distance require many small steps.
inline void report_grazing(const StepContext& context, Row row, const EventBracket& trial)
{
    context.emit(row, "resolution.grazing", Severity::Warning,
                 "two bodies pass one another within " + rounded_text(trial.gap_begin) + " m; after " + std::to_string(trial.iteration) +
                     " distance queries it is still uncertain whether they touch; allow more max_iterations or use "
                     "shorter steps",
                 {trial.begin, trial.gap_begin});
}

}  // namespace plab::resolution
