#include "searches.h"

#include <algorithm>
#include <cmath>

#include "bracket.h"
#include "plab/number_text.h"

namespace plab::resolution
{

void accept_end(const StepContext&, Row, const NoneRows&, EventBracket& trial) { trial.decision = EventBracket::Decision::Accept; }

void BisectionRows::describe(Schema& s)
{
    s.param(time_tolerance, "time_tolerance", unit::second,
            "length of the bracket at which the search ends; never less than 2^-48 of the step")
        .or_else(1e-15)
        .not_negative();
    s.param(max_iterations, "max_iterations", unit::one, "trials per impact before giving up").or_else(60).positive().at_most(1e6);
    describe_work(s, max_work);
}

void bisect(const StepContext& context, Row row, const BisectionRows& rows, EventBracket& trial)
{
    const double tolerance = shortest_bracket(trial, rows.time_tolerance[row]);
    const double length = trial.end - trial.begin;
    const double middle = trial.begin + 0.5 * length;
    trial.decision = EventBracket::Decision::Accept;
    if (length <= tolerance || !(middle > trial.begin && middle < trial.end)) return;
    if (trial.iteration < rows.max_iterations[row])
    {
        trial.decision = EventBracket::Decision::Try;
        trial.next = middle;
        return;
    }
    trial.decision = EventBracket::Decision::GiveUp;
    context.emit(row, "resolution.gave_up", Severity::Warning,
                 "the time of impact is known only to " + rounded_text(length / trial.step) + " of the step after " +
                     std::to_string(trial.iteration) + " trials; allow more max_iterations or a larger time_tolerance",
                 {trial.begin, trial.end});
}

void describe_acceleration(Schema& s, Column<double>& acceleration)
{
    s.param(acceleration, "acceleration", unit::metre_per_second2,
            "largest expected acceleration by forces; determines how far a body at rest may move in a step")
        .or_else(20)
        .not_negative();
}

void SpeculativeRows::describe(Schema& s) { describe_acceleration(s, acceleration); }

void accept_speculation(const StepContext&, Row, const SpeculativeRows&, EventBracket& trial)
{
    trial.decision = EventBracket::Decision::Accept;
}

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

void advance_to_contact(const StepContext& context, Row row, const AdvancementRows& rows, EventBracket& trial)
{
    trial.decision = EventBracket::Decision::Accept;
    const bool bracketed = trial.gap_end < 0 && trial.begin < trial.last;
    if (trial.gap_begin <= rows.gap_tolerance[row] || trial.end - trial.begin <= shortest_bracket(trial)) return;
    if (trial.iteration >= rows.max_iterations[row])
    {
        trial.decision = EventBracket::Decision::GiveUp;
        report_grazing(context, row, trial);
        return;
    }
    trial.decision = EventBracket::Decision::Try;
    trial.next = trial.begin + trial.gap_begin / trial.closing;
    // If the bodies overlap at a trial time, the forces differed from those in the bound; halving is always correct.
    if (bracketed || !(trial.closing > 0) || (trial.gap_end < 0 && trial.next >= trial.end)) trial.next = 0.5 * (trial.begin + trial.end);
}

void RootRows::describe_search(Schema& s)
{
    s.param(time_tolerance, "time_tolerance", unit::second,
            "length of the bracket at which the search ends; never less than 2^-48 of the step")
        .or_else(0)
        .not_negative();
    s.param(max_iterations, "max_iterations", unit::one, "distance queries for one pair in one piece of a step before giving up")
        .or_else(1000)
        .positive()
        .at_most(1e6);
}

void RootRows::describe(Schema& s)
{
    describe_search(s);
    describe_work(s, max_work);
}

double hermite_zero(double t0, double g0, double r0, double t1, double g1, double r1)
{
    const double T = t1 - t0, chord = g1 - g0;
    const double a = std::isfinite(r0) ? r0 * T : chord, b = std::isfinite(r1) ? r1 * T : chord;
    // g(s) = g0 + a s + (3 chord - 2 a - b) s^2 + (a + b - 2 chord) s^3,  s in (0, 1): one zero by safeguarded Newton.
    const double q = 3 * chord - 2 * a - b, c = a + b - 2 * chord;
    double low = 0, high = 1, s = g0 / (g0 - g1);
    for (int i = 0; i < 40; ++i)
    {
        const double g = g0 + s * (a + s * (q + s * c)), slope = a + s * (2 * q + s * 3 * c);
        (g > 0 ? low : high) = s;
        double next = s - g / slope;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (std::fabs(next - s) <= 1e-16) break;
        s = next;
    }
    return t0 + s * T;
}

namespace
{

/// The next trial time in a bracket after `iteration` queries.
double next_in_bracket(const EventBracket& t)
{
    const double length = t.end - t.begin, middle = t.begin + 0.5 * length;
    // Guarantees that it is never much slower than halving, whatever the shape of the gap function.
    if (length > std::ldexp(t.step, 3 - t.iteration)) return middle;
    double next = hermite_zero(t.begin, t.gap_begin, t.rate_begin, t.end, t.gap_end, t.rate_end);
    // One end of the bracket soon comes close to the zero. A time slightly beyond the zero moves the other end as well. The
    // shift is never less than what time can resolve.
    const double overshoot = std::max(shortest_bracket(t) * 0.5, 1e-3 * std::min(next - t.begin, t.end - next));
    const bool begin_is_near = next - t.begin < t.end - next;
    next += begin_is_near ? overshoot : -overshoot;
    return next > t.begin && next < t.end ? next : middle;
}

}  // namespace

void find_root(const StepContext& context, Row row, const RootRows& rows, EventBracket& trial)
{
    const double shortest = shortest_bracket(trial, rows.time_tolerance[row]);
    trial.decision = EventBracket::Decision::Accept;
    const bool bracketed = trial.gap_end < 0;
    if (bracketed ? trial.end - trial.begin <= shortest : trial.gap_begin <= -trial.rate_begin * shortest) return;
    if (trial.iteration >= rows.max_iterations[row])
    {
        trial.decision = EventBracket::Decision::GiveUp;
        report_grazing(context, row, trial);
        return;
    }
    trial.decision = EventBracket::Decision::Try;
    trial.next = bracketed ? next_in_bracket(trial) : trial.begin - trial.gap_begin / trial.rate_begin;
}

}  // namespace plab::resolution
