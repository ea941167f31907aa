/// A governor that spends a budget of processor time where it removes most error.
#pragma once

#include "watch.h"

namespace plab::governors
{

/// Governor/Budget. The host measures what steps, trial steps and exchanges cost and sets that as inputs, which are recorded with the run
/// (plab/levels.h).
struct BudgetRows
{
    WatchRows watch;
    Column<double> budget, share, headroom;
    Column<double> tolerance;  ///< pixels
    Column<double> interval;   ///< s
    Column<std::int64_t> trials;
    Column<std::string> clock;
    Column<double> step_cost;                      ///< s, input
    Column<Reals> trial_costs;                     ///< s for each object, by level; input
    Column<Reals> exchange_cost;                   ///< number of components, s; input
    Column<Reals> costs;                           ///< what is known of the cost of each level (cost_model.h)
    Column<Reals> errors;                          ///< and of their errors (error_table.h)
    Column<Reals> exchange;                        ///< and of the cost of an exchange: s, and s for each component
    Column<std::int64_t> trials_left, next_trial;  ///< until the next look; position in the list of those watched
    Column<std::int64_t> waiting;                  ///< changes that the last look left for later boundaries
    Column<double> last_long;                      ///< s, when exchanges made a step longer than the budget
    Column<double> retry;                          ///< s, when the changes that wait are planned again
    Column<double> spent;
    Column<std::int64_t> given_up;
    Column<double> lost;

    void describe(Schema& schema);
};

/// Learns from trial steps what error each level makes, and from the measurements what it costs; then gives each component the level with
/// which the budget removes most error (spending.h). Its error counts in pixels of the viewer who sees it largest.
///
/// Exchanges cost time as well. They are spread over as many steps as needed for each of these to keep the budget. Where not even one
/// exchange fits, all are made at once, but only once in 128 steps, so that 99 of 100 steps keep the budget; while steps exceed it anyway,
/// components become cheaper at once.
void keep_budget(const StepContext& context, Row row, BudgetRows& governors, LevelControl& control);

}  // namespace plab::governors
