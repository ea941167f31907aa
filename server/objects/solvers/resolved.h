/// What a solver says about the method that it really used.
#pragma once

#include <string>
#include <string_view>

#include "plab/registrar.h"

namespace plab::solvers
{

/// A trial advance finds out where bodies would be: it leaves no trace in states, outputs or events. In the ledger
/// it may: what an event undoes is taken back by a trial of the same piece, so that solvers book in trials as ever.
inline bool is_trial(const StepContext& context) { return context.events == nullptr; }

/// Fallbacks that a row has told of already, as bits of a declared state, so that an event tells of each once.
enum class Fallback : std::int64_t
{
    Constrained = 1,
    NotUniform = 2,
    TooLarge = 4,
};

struct ResolvedColumns
{
    Column<std::string> resolved;
    Column<std::int64_t> announced;

    void describe(Schema& schema)
    {
        schema.output(resolved, "resolved", unit::one, "the method that was used for the last group that was advanced");
        schema.state(announced, "announced", unit::one, "fallbacks that events told of: 1 joints, 2 forces, 4 size (a sum)").not_negative();
    }
    /// To be called before the first evaluation: it emits with the context's own rows.
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

}  // namespace plab::solvers
