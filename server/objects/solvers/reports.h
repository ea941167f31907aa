/// What solvers say of themselves: which method was used, what the control of errors did, and why an advance ended early.
#pragma once

#include <string>
#include <string_view>

#include "plab/registrar.h"

namespace plab::solvers
{

/// A trial advance finds out where bodies would be and leaves no trace in states, outputs or events. It does book to the ledger: what an
/// event undoes is cancelled by a trial of the same part of the step, so solvers book in trials as usual.
inline bool is_trial(const StepContext& context) { return context.events == nullptr; }

/// Fallbacks that a row has already reported, as bits of a declared state, so that an event reports each only once.
enum class Fallback : std::int64_t
{
    Constrained = 1,
    NotUniform = 2,
    TooLarge = 4,
    NotTree = 8,
};

/// How a solver says which method it has actually used.
struct ResolvedColumns
{
    Column<std::string> resolved;
    Column<std::int64_t> announced;

    void describe(Schema& schema)
    {
        schema.output(resolved, "resolved", unit::one, "the method used for the group that was advanced last");
        schema
            .state(announced, "announced", unit::one,
                   "fallbacks reported by events: 1 joints, 2 forces, 4 size, 8 no tree of joints (a sum)")
            .not_negative();
    }
    /// To be called before the first evaluation, because it emits with the context's own rows.
    void say(const StepContext& context, Row row, std::string_view method)
    {
        if (!is_trial(context) && resolved[row] != method) resolved[row].assign(method);
    }
    void fall_back(const StepContext& context, Row row, Fallback why, std::string_view method, std::string_view reason)
    {
        if (is_trial(context)) return;
        say(context, row, method);
        const auto bit = static_cast<std::int64_t>(why);
        if ((announced[row] & bit) != 0) return;
        announced[row] |= bit;
        context.emit(row, "solver.fell_back", Severity::Info, std::string(reason) + "; " + std::string(method) + " is used");
    }
};

/// Of solvers that choose internal steps by an error estimate.
struct SubstepCounts
{
    std::int64_t accepted = 0, refused = 0, evaluations = 0;
    double reached = 0;  ///< s, the end of the last accepted internal step
};

/// Parameters and counts of error control.
struct ErrorControlRows
{
    Column<double> relative_tolerance, absolute_tolerance;
    Column<std::int64_t> max_substeps;
    Column<std::int64_t> substeps, refused, evaluations;

    void describe_control(Schema& schema);
    void report(Row row, const SubstepCounts& counts);
};

/// Emits the event solver.gave_up; `advice` is the end of its message, after what is done about it.
void report_gave_up(const StepContext& start, Row row, const SubstepCounts& counts, std::string_view advice,
                    std::string_view done = "the group stays as it was there");

}  // namespace plab::solvers
