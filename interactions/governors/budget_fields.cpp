// The fields of Governor/Budget.
#include "by_budget.h"

namespace plab::governors
{

void BudgetRows::describe(Schema& schema)
{
    watch.describe(schema);
    schema.param(budget, "budget", unit::second, "processor time of a step; 0: `share` of the step's length, so that real time is held")
        .or_else(0)
        .not_negative();
    schema.param(share, "share", unit::one, "of the step's length, if no budget is given").or_else(0.8).positive();
    schema
        .param(clock, "clock", unit::one, "what counts: time of the `processor` that the stepping thread uses, or time by the `wall` clock")
        .or_else("processor")
        .one_of({"processor", "wall"});
    schema.param(headroom, "headroom", unit::one, "fraction of the budget that is left free before levels become finer")
        .or_else(0.15)
        .not_negative();
    schema
        .param(tolerance, "tolerance", unit::one,
               "error in pixels that is not worth removing; for what nobody sees a metre counts as a pixel; 0: all time is spent")
        .or_else(0)
        .not_negative();
    schema.param(interval, "interval", unit::second, "time within which the error of a level is counted").or_else(0.25).positive();
    schema.param(trials, "trials", unit::one, "components whose levels are tried between two looks, one at a boundary where there is room")
        .or_else(2)
        .not_negative();
    schema.state(step_cost, "step_cost", unit::second, "what a step costs usually, as measured; set by the host").input();
    schema.state(spread, "spread", unit::one, "how many times that 99 of 100 steps cost at most; set by the host").initially(1).input();
    schema
        .state(trial_time, "trial_time", unit::one,
               "number of levels that were tried last, what that cost (s), and the step after it (s); set by the host")
        .input();
    schema
        .state(trial_costs, "trial_costs", unit::second,
               "what a trial step with each level cost for each object, as measured since the last look; 0: none was made; set by the host")
        .input();
    schema
        .state(exchange_cost, "exchange_cost", unit::one,
               "the number of components that were exchanged last, what that cost (s), and the step after it (s); set by the host")
        .input();
    schema.state(costs, "costs", unit::second,
                 "cost of a step with all components at each level, as learnt, and then the covariance (s^2) of these costs");
    schema.state(errors, "errors", unit::one,
                 "for each number of objects on which a component acts, and each level that it has: these two, the number of trials, and "
                 "the mean square of the error (m^2) of each level");
    schema.state(exchange, "exchange", unit::second,
                 "what an exchange costs, as learnt: fixed, and for each component; and then the covariance (s^2) of the two");
    schema.state(cost, "cost", unit::second, "what a step is taken to cost: as measured last, with what was chosen since");
    schema.state(last_step_cost, "last_step_cost", unit::second, "`step_cost` as it was used last");
    schema.state(trial, "trial", unit::second, "what it costs to try a level, as learnt; 0: it is not known");
    schema.state(partial, "partial", unit::metre,
                 "errors of the levels that have been tried of the component that is tried now, the most exact one first");
    schema.state(trials_left, "trials_left", unit::one, "components to be tried before the next look");
    schema.state(next_trial, "next_trial", unit::one, "position of the component that was tried last");
    schema.state(waiting, "waiting", unit::one, "changes that wait for a boundary where there is time for them");
    schema.state(last_long, "last_long", unit::second, "when exchanges made a step longer than the budget").initially(-1e9);
    schema.state(retry, "retry", unit::second, "when the changes that wait are planned again");
    schema.output(spent, "spent", unit::one, "cost of a step relative to the budget");
    schema.output(given_up, "given_up", unit::one, "number of components that are not at the most exact level");
    schema.output(lost, "lost", unit::one, "their share of the importance of all components, when it looked last");
}

}  // namespace plab::governors
