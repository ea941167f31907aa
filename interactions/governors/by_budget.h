/// Governors that spend a budget where it counts: of processor time, or of error.
#pragma once

#include "watch.h"

namespace plab::governors
{

/// Governor/Budget. The host measures what steps cost and sets it as inputs, which are recorded with the run (plab/levels.h).
struct BudgetRows
{
    WatchRows watch;
    Column<double> budget, share, headroom;
    Column<double> step_cost;    ///< s, input
    Column<Reals> level_costs;   ///< s, by level, input; negative: not known
    Column<double> scale;        ///< by how much more a change of level saves than the component's own cost says
    Column<double> cost_before;  ///< s, step_cost at the last change; 0: it has been judged
    Column<double> predicted;    ///< s, the change of step_cost that was expected then, without scale
    Column<double> spent;
    Column<std::int64_t> given_up;

    void describe(Schema& schema);
};

/// Above the budget, components become cheaper, the least important ones first, until the step is expected to fit. Below it, the most
/// important ones become finer as far as there is room. Importance is the angle under which a viewer sees the component.
void keep_budget(const StepContext& context, Row row, BudgetRows& governors, LevelControl& control);

/// Governor/Error: the cheapest level whose error stays below a bound.
struct ErrorRows
{
    WatchRows watch;
    Column<double> bound, interval;
    Column<std::int64_t> looks;
    Column<Entries> next;  ///< s: when a component is measured again, by id
    Column<double> worst;
    Column<std::int64_t> measured, unknown;

    void describe(Schema& schema);
};

/// Measures by trial steps how far a component departs from its most exact level within the interval, and chooses its level by that.
void keep_error(const StepContext& context, Row row, ErrorRows& governors, LevelControl& control);

}  // namespace plab::governors
