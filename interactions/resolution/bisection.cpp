#include "bisection.h"

#include "bracket.h"
#include "plab/number_text.h"

namespace plab::resolution
{

void accept_end(const StepContext&, Row, const NoneRows&, Trial& trial) { trial.decision = Trial::Decision::Accept; }

void BisectionRows::describe(Schema& s)
{
    s.param(time_tolerance, "time_tolerance", unit::second,
            "length of the bracket at which the search ends; never less than 2^-48 of the step")
        .or_else(1e-15)
        .not_negative();
    s.param(max_iterations, "max_iterations", unit::one, "trials per impact before giving up").or_else(60).positive().at_most(1e6);
    describe_work(s, max_work);
}

void bisect(const StepContext& context, Row row, const BisectionRows& rows, Trial& trial)
{
    const double tolerance = shortest_bracket(trial, rows.time_tolerance[row]);
    const double length = trial.end - trial.begin;
    const double middle = trial.begin + 0.5 * length;
    trial.decision = Trial::Decision::Accept;
    if (length <= tolerance || !(middle > trial.begin && middle < trial.end)) return;
    if (trial.iteration < rows.max_iterations[row])
    {
        trial.decision = Trial::Decision::Try;
        trial.next = middle;
        return;
    }
    trial.decision = Trial::Decision::GiveUp;
    context.emit(row, "resolution.gave_up", Severity::Warning,
                 "the time of impact is known only to " + rounded_text(length / trial.step) + " of the step after " +
                     std::to_string(trial.iteration) + " trials; allow more max_iterations or a larger time_tolerance",
                 {trial.begin, trial.end});
}

}  // namespace plab::resolution
