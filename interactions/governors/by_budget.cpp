#include "by_budget.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include "cost_model.h"
#include "sight.h"

namespace plab::governors
{
namespace
{
/// s: what is shorter was not measured, and its square would underflow.
constexpr double kLeastCost = 1e-12;

/// rad: of what nobody sees, and of everything where there is no viewer.
constexpr double kUnseen = 1e-3;

/// The largest angle (rad, of a radius) under which a viewer sees it.
double importance_of(const GovernedComponent& g, std::span<const Viewpoint> eyes)
{
    double most = kUnseen;
    const Ball ball{g.center, g.radius};
    for (const Viewpoint& eye : eyes)
    {
        const double distance = length(g.center - eye.position);
        const double angle = distance > g.radius ? g.radius / distance : 1.0;
        if (is_in_view(widened(eye, 0.15), ball)) most = std::max(most, angle);
    }
    return most;
}

/// The new level of each watched component.
using Plan = std::vector<std::int32_t>;

Plan present_levels(const Look& look)
{
    Plan plan;
    for (const GovernedComponent& g : look.watched()) plan.push_back(g.level);
    return plan;
}

/// A change of one level, and what it is worth.
struct Offer
{
    double worth = 0;  ///< importance per second of a step
    std::size_t component = 0;
    double seconds = 0;  ///< by which the step changes
    double at_worst = 0;
};

/// Gives up the least importance for each second that is saved, one level after the other, until `needed` (s) is saved.
Plan plan_savings(const Look& look, const std::vector<double>& importance, const CostModel& model, double needed)
{
    Plan plan = present_levels(look);
    const auto dearer = [](const Offer& a, const Offer& b) { return std::tie(a.worth, a.component) > std::tie(b.worth, b.component); };
    std::priority_queue<Offer, std::vector<Offer>, decltype(dearer)> offers(dearer);
    const auto offer = [&](std::size_t k)
    {
        if (plan[k] <= 0) return;
        const auto l = static_cast<std::size_t>(plan[k]);
        const double saved = (model.cost(l) - model.cost(l - 1)) / static_cast<double>(plan.size());
        if (saved > 0) offers.push({importance[k] / saved, k, saved, saved});
    };
    for (std::size_t k = 0; k < plan.size(); ++k) offer(k);
    for (double saved = 0; saved < needed && !offers.empty();)
    {
        const Offer best = offers.top();
        offers.pop();
        saved += best.seconds, --plan[best.component];
        offer(best.component);
    }
    return plan;
}

/// Buys the most importance for each second, one level for each component, as far as there is room (s). What a level costs is taken to be
/// as much as it may well be. A level of which hardly anything is known is tried by a few components first, because it may cost many times
/// what is guessed.
Plan plan_spending(const Look& look, const std::vector<double>& importance, const CostModel& model, double cost, double room)
{
    constexpr double kDoubtful = 0.5, kWorst = 20;  // of what a level is taken to cost; of what a step costs now
    Plan plan = present_levels(look);
    std::vector<Offer> offers;
    for (std::size_t k = 0; k < plan.size(); ++k)
    {
        if (plan[k] < 0 || plan[k] >= look.finest() || !look.rested(k)) continue;
        const auto l = static_cast<std::size_t>(plan[k]);
        const double likely = model.cost(l + 1) + model.deviation(l + 1);
        const bool doubtful = model.deviation(l + 1) > kDoubtful * model.cost(l + 1);
        const double share = 1 / static_cast<double>(plan.size()), spent = share * std::max(1e-12, likely - model.cost(l));
        offers.push_back({importance[k] / spent, k, spent, doubtful ? std::max(spent, share * kWorst * cost) : spent});
    }
    std::sort(offers.begin(), offers.end(),
              [](const Offer& a, const Offer& b) { return a.worth != b.worth ? a.worth > b.worth : a.component < b.component; });
    double spent = 0;
    bool tried = false;  // one component may always try what is not known
    for (const Offer& o : offers)
    {
        const bool doubtful = o.at_worst > o.seconds;
        const double seconds = doubtful && tried ? o.at_worst : o.seconds;
        if (spent + seconds > room) continue;
        spent += seconds, ++plan[o.component], tried = tried || doubtful;
    }
    return plan;
}

/// While the budget is used up: takes from what has become unimportant, one level each, and gives that to what has become important.
/// `room`: s.
Plan plan_exchange(const Look& look, const std::vector<double>& importance, const CostModel& model, double room)
{
    constexpr double kMuch = 2;  // as important
    Plan plan = present_levels(look);
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < plan.size(); ++k)
        if (plan[k] >= 0 && look.rested(k)) order.push_back(k);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return importance[a] < importance[b]; });
    const auto step = [&](std::int32_t level)
    {
        const auto l = static_cast<std::size_t>(level);
        return std::max(0.0, model.cost(l + 1) - model.cost(l)) / static_cast<double>(plan.size());
    };
    std::size_t least = 0;
    for (std::size_t n = order.size(); n-- > 0;)
    {
        const std::size_t up = order[n];
        if (plan[up] >= look.finest()) continue;
        const double needed = step(plan[up]);
        const std::size_t first = least;
        double free = room;
        for (; free < needed && least < n && kMuch * importance[order[least]] < importance[up]; ++least)
            if (plan[order[least]] > 0) free += step(plan[order[least]] - 1);
        if (free < needed) break;
        for (std::size_t k = first; k < least; ++k) plan[order[k]] = std::max(0, plan[order[k]] - 1);
        ++plan[up], room = free - needed;
    }
    return plan;
}

/// Of the components that are on the ladder.
Reals fractions_of(const Look& look)
{
    Reals out(static_cast<std::size_t>(look.finest() + 1), 0.0);
    double all = 0;
    for (const GovernedComponent& g : look.watched())
        if (g.level >= 0) ++out[static_cast<std::size_t>(g.level)], ++all;
    for (double& f : out) f = all > 0 ? f / all : 0;
    return out;
}

/// Before anything is known of costs, the first steps must not take longer than the scene can help.
void begin_cheaply(Look& look, Row row, BudgetRows& governors)
{
    for (std::size_t k = 0; k < look.watched().size(); ++k)
        if (look.watched()[k].level > 0 && look.may_choose(k, 0)) (void)look.choose(k, 0, "nothing is known yet of what levels cost");
    governors.given_up[row] = static_cast<std::int64_t>(static_cast<double>(look.watched().size()) - governors.watch.count[row].back());
}

void publish_what_is_given_up(const Look& look, const std::vector<double>& importance, Row row, BudgetRows& governors)
{
    governors.given_up[row] = static_cast<std::int64_t>(static_cast<double>(look.watched().size()) - governors.watch.count[row].back());
    double all = 0, lost = 0;
    for (std::size_t k = 0; k < importance.size(); ++k)
    {
        all += importance[k];
        if (look.watched()[k].level < look.finest()) lost += importance[k];
    }
    governors.lost[row] = all > 0 ? lost / all : 0;
}

}  // namespace

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
    schema.state(step_cost, "step_cost", unit::second, "what a step costs, as measured; set by the host").input();
    schema.state(costs, "costs", unit::second,
                 "cost of a step with all components at each level, as learnt, and then the covariance (s^2) of these costs");
    schema.output(spent, "spent", unit::one, "cost of a step relative to the budget");
    schema.output(given_up, "given_up", unit::one, "number of components that are not at the most exact level");
    schema.output(lost, "lost", unit::one, "their share of the importance of all components, when it looked last");
}

void keep_budget(const StepContext& context, Row row, BudgetRows& governors, LevelControl& control)
{
    if (!due(context, governors.watch.every[row])) return;
    const double budget = governors.budget[row] > 0 ? governors.budget[row] : governors.share[row] * context.dt;
    const double cost = governors.step_cost[row] > kLeastCost ? governors.step_cost[row] : 0;
    governors.spent[row] = cost / budget;
    Look look(context, row, governors.watch, control);
    if (look.watched().empty()) return;
    const bool is_first = governors.costs[row].empty();
    if (is_first && cost <= 0) return begin_cheaply(look, row, governors);
    if (cost <= 0) return;
    CostModel model(governors.costs[row], static_cast<std::size_t>(look.finest() + 1));
    model.update(fractions_of(look), cost);
    std::vector<double> importance;
    for (const GovernedComponent& g : look.watched()) importance.push_back(importance_of(g, control.viewpoints()));
    const double goal = budget * (1 - 0.5 * governors.headroom[row]);
    const bool over = cost > budget;
    Plan plan;
    if (over)
        plan = plan_savings(look, importance, model, cost - goal);
    else if (cost < budget * (1 - governors.headroom[row]))
        plan = plan_spending(look, importance, model, cost, goal - cost);
    else
        plan = plan_exchange(look, importance, model, std::max(0.0, goal - cost));
    const std::string why = (over || cost >= budget * (1 - governors.headroom[row]) ? "a step takes " : "there is room: a step takes ") +
                            brief(1e3 * cost) + " ms of " + brief(1e3 * budget) + " ms";
    for (std::size_t k = 0; k < plan.size(); ++k)
        if (plan[k] >= 0) (void)look.choose(k, plan[k], why + "; importance " + brief(importance[k]));
    publish_what_is_given_up(look, importance, row, governors);
}

}  // namespace plab::governors
