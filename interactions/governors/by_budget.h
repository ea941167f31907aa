/// A governor that spends a budget of processor time where it counts.
#pragma once

#include "watch.h"

namespace plab::governors
{

/// Governor/Budget. The host measures what steps cost and sets it as an input, which is recorded with the run (plab/levels.h).
struct BudgetRows
{
    WatchRows watch;
    Column<double> budget, share, headroom;
    Column<std::string> clock;
    Column<double> step_cost;  ///< s, input
    Column<Reals> costs;       ///< what is known of the cost of each level (cost_model.h)
    Column<double> spent;
    Column<std::int64_t> given_up;
    Column<double> lost;

    void describe(Schema& schema);
};

/// Above the budget, components become cheaper where the least importance is lost for each second that is saved, until the step is expected
/// to fit. Below it, they become finer where a second buys the most importance, as far as there is room. Importance is the angle under
/// which a viewer sees the component.
void keep_budget(const StepContext& context, Row row, BudgetRows& governors, LevelControl& control);

}  // namespace plab::governors
