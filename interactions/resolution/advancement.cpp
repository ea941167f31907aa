#include "advancement.h"

#include <algorithm>
#include <cmath>

#include "bracket.h"

namespace plab::resolution
{

void AdvancementRows::describe(Schema& s)
{
    s.param(gap_tolerance, "gap_tolerance", unit::metre, "a gap this small counts as closed; rounding of positions always does")
        .or_else(1e-12)
        .not_negative();
    s.param(max_iterations, "max_iterations", unit::one, "steps towards one contact before giving up")
        .or_else(1000)
        .positive()
        .at_most(1e6);
    describe_work(s, max_work);
}

void advance_to_contact(const StepContext& context, Row row, const AdvancementRows& rows, Trial& trial)
{
    trial.decision = Trial::Decision::Accept;
    const bool bracketed = trial.gap_end < 0 && trial.begin < trial.last;
    if (trial.gap_begin <= rows.gap_tolerance[row] || trial.end - trial.begin <= shortest_bracket(trial)) return;
    if (trial.iteration >= rows.max_iterations[row])
    {
        trial.decision = Trial::Decision::GiveUp;
        report_grazing(context, row, trial);
        return;
    }
    trial.decision = Trial::Decision::Try;
    // If the bodies overlap at a trial time, the forces differed from those in the bound; halving is always correct.
    trial.next = bracketed || !(trial.closing > 0) ? 0.5 * (trial.begin + trial.end) : trial.begin + trial.gap_begin / trial.closing;
}

}  // namespace plab::resolution
