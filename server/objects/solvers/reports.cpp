#include "reports.h"

#include "plab/number_text.h"

#include <string>

namespace plab::solvers
{

void ErrorControlRows::describe_control(Schema& schema)
{
    schema
        .param(relative_tolerance, "relative_tolerance", unit::one,
               "error of an internal step, relative to speeds and to the path within the step")
        .or_else(1e-9)
        .positive();
    schema
        .param(absolute_tolerance, "absolute_tolerance", unit::one,
               "error that is always allowed, in m, rad, m/s, rad/s or the quantity's unit")
        .or_else(1e-12)
        .positive();
    schema.param(max_substeps, "max_substeps", unit::one, "internal steps tried within a step before it gives up")
        .or_else(100000)
        .at_least(1)
        .at_most(1e7);
    schema.output(substeps, "substeps", unit::one, "internal steps in the last step");
    schema.output(refused, "refused", unit::one, "internal steps that were rejected and repeated with a shorter length");
    schema.output(evaluations, "evaluations", unit::one, "force evaluations in the last step");
}

void ErrorControlRows::report(Row row, const SubstepCounts& counts)
{
    substeps[row] = counts.accepted, refused[row] = counts.refused, evaluations[row] = counts.evaluations;
}

void report_gave_up(const StepContext& start, Row row, const SubstepCounts& counts, std::string_view advice, std::string_view done)
{
    start.emit(row, "solver.gave_up", Severity::Warning,
               std::to_string(counts.accepted) + " internal steps (" + std::to_string(counts.refused) + " more refused) reached " +
                   rounded_text(counts.reached) + " s of " + rounded_text(start.dt) + " s; " + std::string(done) + ": " +
                   std::string(advice),
               {counts.reached, start.dt});
}

}  // namespace plab::solvers
