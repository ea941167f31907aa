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
    Column<double> step_cost, spread;              ///< s; how many times that 99 of 100 steps take at most; inputs
    Column<Reals> trial_time;                      ///< number of levels that were tried, s; input
    Column<Reals> trial_costs;                     ///< s for each object, by level; input
    Column<Reals> exchange_cost;                   ///< number of components, s; input
    Column<Reals> costs;                           ///< what is known of the cost of each level (cost_model.h)
    Column<Reals> errors;                          ///< and of their errors (error_table.h)
    Column<Reals> exchange;                        ///< and of the cost of an exchange: s, and s for each component
    Column<double> cost, last_step_cost;           ///< s: what a step is taken to cost now; `step_cost` as it was used last
    Column<double> trial;                          ///< s, that it takes to try a level; 0: not known
    Column<std::int64_t> trials_left, next_trial;  ///< until the next look; position in the list of those watched
    Column<Reals> partial;                         ///< m: errors of the levels of that component that have been tried, most exact one first
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
/// Steps differ by chance and by what happens in them, so the usual step must cost less than the budget by as much as 99 of 100 steps
/// exceed it. Exchanges and trials cost time as well. They are spread over as many steps as needed for the usual one of these to keep the
/// budget: they come before few steps, so that hardly one of these is unusual too. Where not even one exchange fits, all are made at once,
/// and where no trial fits, one level is tried, but only once in 128 steps, so that 99 of 100 keep the budget; while steps exceed it
/// anyway, components become cheaper at once.
void keep_budget(const StepContext& context, Row row, BudgetRows& governors, LevelControl& control);

}  // namespace plab::governors
