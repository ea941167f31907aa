#include "by_budget.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sight.h"

namespace plab::governors
{
namespace
{

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

/// s per step of a component at each level. What has not been measured is guessed, with a factor that makes a finer level look expensive.
Reals costs_of(const Reals& measured, std::int32_t levels)
{
    constexpr double kDearer = 4, kCheaper = 0.5;
    Reals out(static_cast<std::size_t>(levels), -1.0);
    for (std::size_t k = 0; k < std::min(out.size(), measured.size()); ++k) out[k] = measured[k];
    for (std::size_t k = 1; k < out.size(); ++k)
        if (out[k] < 0 && out[k - 1] >= 0) out[k] = kDearer * out[k - 1];
    for (std::size_t k = out.size(); k-- > 1;)
        if (out[k - 1] < 0 && out[k] >= 0) out[k - 1] = kCheaper * out[k];
    return out;
}

/// Compares the change that was expected with the one that came.
void learn(Row row, BudgetRows& rows)
{
    constexpr double kLeast = 0.1, kMost = 50;
    if (rows.cost_before[row] <= 0) return;
    const double expected = rows.predicted[row], came = rows.step_cost[row] - rows.cost_before[row];
    rows.cost_before[row] = 0;
    constexpr double kNoise = 0.05;  // of the step: smaller changes cannot be told from noise
    if (std::fabs(expected) * rows.scale[row] < kNoise * rows.step_cost[row]) return;
    rows.scale[row] = std::clamp(0.5 * (rows.scale[row] + came / expected), kLeast, kMost);
}

struct Plan
{
    std::vector<std::int32_t> level;  ///< by watched component
    double change = 0;                ///< s, of the step, without scale
};

/// One level at a time for all, then another one, because the first level down usually costs the least exactness.
Plan plan_savings(const Look& look, const std::vector<std::size_t>& order, const Reals& costs, double needed)
{
    Plan plan;
    for (const GovernedComponent& g : look.watched()) plan.level.push_back(g.level);
    for (bool any = true; any && -plan.change < needed;)
    {
        any = false;
        for (const std::size_t k : order)
        {
            if (-plan.change >= needed) break;
            const std::int32_t l = plan.level[k];
            if (l <= 0) continue;
            const double saved = costs[static_cast<std::size_t>(l)] - costs[static_cast<std::size_t>(l - 1)];
            if (saved <= 0) continue;
            --plan.level[k], plan.change -= saved, any = true;
        }
    }
    return plan;
}

/// The most important ones get one finer level each, as far as there is room.
Plan plan_spending(const Look& look, const std::vector<std::size_t>& order, const Reals& costs, double room)
{
    Plan plan;
    for (const GovernedComponent& g : look.watched()) plan.level.push_back(g.level);
    for (auto k = order.rbegin(); k != order.rend(); ++k)
    {
        const std::int32_t l = plan.level[*k];
        if (l < 0 || l >= look.finest() || !look.rested(*k)) continue;
        const double more = std::max(0.0, costs[static_cast<std::size_t>(l + 1)] - costs[static_cast<std::size_t>(l)]);
        if (plan.change + more > room) break;
        ++plan.level[*k], plan.change += more;
    }
    return plan;
}

}  // namespace

void BudgetRows::describe(Schema& schema)
{
    watch.describe(schema);
    schema.param(budget, "budget", unit::second, "processor time of a step; 0: `share` of the step's length, so that real time is held")
        .or_else(0)
        .not_negative();
    schema.param(share, "share", unit::one, "of the step's length, if no budget is given").or_else(0.8).positive();
    schema.param(headroom, "headroom", unit::one, "fraction of the budget that is left free before levels become finer")
        .or_else(0.15)
        .not_negative();
    schema.state(step_cost, "step_cost", unit::second, "what a step costs, as measured; set by the host").input();
    schema
        .state(level_costs, "level_costs", unit::second,
               "what a component costs at each level, as measured; set by the host; negative: not known")
        .input();
    schema.state(scale, "scale", unit::one, "the cost of a change of level relative to the component's own cost, as learnt").initially(1);
    schema.state(cost_before, "cost_before", unit::second, "what a step cost when levels were changed last; 0: the change has been judged");
    schema.state(predicted, "predicted", unit::second, "the change of the cost that was expected then");
    schema.output(spent, "spent", unit::one, "cost of a step relative to the budget");
    schema.output(given_up, "given_up", unit::one, "number of components that are not at the most exact level");
}

void keep_budget(const StepContext& context, Row row, BudgetRows& governors, LevelControl& control)
{
    if (!due(context, governors.watch.every[row]) || governors.step_cost[row] <= 0) return;
    const double budget = governors.budget[row] > 0 ? governors.budget[row] : governors.share[row] * context.dt;
    const double cost = governors.step_cost[row];
    governors.spent[row] = cost / budget;
    learn(row, governors);
    Look look(context, row, governors.watch, control);
    const auto count = static_cast<std::int64_t>(look.watched().size());
    std::vector<double> importance;
    for (const GovernedComponent& g : look.watched()) importance.push_back(importance_of(g, control.viewpoints()));
    std::vector<std::size_t> order(importance.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return importance[a] < importance[b]; });
    const Reals costs = costs_of(governors.level_costs[row], control.levels(row));
    const double scale = governors.scale[row], goal = budget * (1 - 0.5 * governors.headroom[row]);
    const bool over = cost > budget;
    Plan plan;
    if (over)
        plan = plan_savings(look, order, costs, (cost - goal) / scale);
    else if (cost < budget * (1 - governors.headroom[row]))
        plan = plan_spending(look, order, costs, (goal - cost) / scale);
    const std::string why =
        (over ? "a step takes " : "there is room: a step takes ") + brief(1e3 * cost) + " ms of " + brief(1e3 * budget) + " ms";
    bool any = false;
    for (std::size_t k = 0; k < plan.level.size(); ++k)
        if (plan.level[k] >= 0) any = look.choose(k, plan.level[k], why + "; importance " + brief(importance[k])) || any;
    if (any) governors.cost_before[row] = cost, governors.predicted[row] = plan.change;
    governors.given_up[row] = count - static_cast<std::int64_t>(governors.watch.count[row].empty() ? 0 : governors.watch.count[row].back());
}

void ErrorRows::describe(Schema& schema)
{
    watch.describe(schema);
    schema
        .param(bound, "bound", unit::one,
               "error that is allowed within `interval`: m for bodies, rad for what acts on shafts only, relative to the most exact level")
        .positive();
    schema.param(interval, "interval", unit::second, "time within which the error is counted").or_else(0.25).positive();
    schema.param(looks, "looks", unit::one, "components that are measured at most in one look").or_else(8).positive();
    schema.state(next, "next", unit::one, "when a component is measured again, s");
    schema.output(worst, "worst", unit::one, "the largest error that was measured in the last look, of the levels that were kept");
    schema.output(measured, "measured", unit::one, "number of measurements");
    schema.output(unknown, "unknown", unit::one, "number of measurements that gave no error");
}

namespace
{

/// s, when the component is due; components that were never measured are due at once.
double next_of(const Entries& next, std::string_view id)
{
    const auto found = std::lower_bound(next.begin(), next.end(), id, [](const Entry& e, std::string_view name) { return e.name < name; });
    return found != next.end() && found->name == id ? std::get<double>(found->value) : 0;
}

void set_next(Entries& next, std::string_view id, double time)
{
    const auto found = std::lower_bound(next.begin(), next.end(), id, [](const Entry& e, std::string_view name) { return e.name < name; });
    if (found != next.end() && found->name == id)
        found->value = time;
    else
        next.insert(found, {std::string(id), time});
}

}  // namespace

void keep_error(const StepContext& context, Row row, ErrorRows& governors, LevelControl& control)
{
    if (!due(context, governors.watch.every[row])) return;
    Look look(context, row, governors.watch, control);
    Entries& next = governors.next[row];
    const double bound = governors.bound[row], interval = governors.interval[row], every = governors.watch.every[row];
    governors.worst[row] = 0;
    std::vector<std::size_t> order(look.watched().size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(
        order.begin(), order.end(),
        [&](std::size_t a, std::size_t b)
        { return next_of(next, control.id_of(look.watched()[a].component)) < next_of(next, control.id_of(look.watched()[b].component)); });
    std::int64_t left = governors.looks[row];
    for (const std::size_t k : order)
    {
        const GovernedComponent& g = look.watched()[k];
        const std::string_view id = control.id_of(g.component);
        if (left-- <= 0 || next_of(next, id) > context.time * (1 + 1e-9)) break;
        const auto error_at = [&](std::int32_t level)
        {
            const double e = control.error(row, k, level, interval);
            ++governors.measured[row];
            governors.unknown[row] += std::isnan(e) ? 1 : 0;
            return e;
        };
        // What cannot be told is taken for too much: then the level becomes finer.
        std::int32_t level = std::max(0, g.level);
        double error = error_at(level);
        while (level < look.finest() && !(error <= bound)) error = error_at(++level);
        if (level == g.level && level > 0 && look.rested(k))
        {
            const double cheaper = error_at(level - 1);
            if (cheaper * (1 + governors.watch.hysteresis[row]) <= bound) --level, error = cheaper;
        }
        (void)look.choose(k, level, "error " + brief(error) + " of " + brief(bound) + " in " + brief(interval) + " s");
        governors.worst[row] = std::max(governors.worst[row], error);
        // Far below the bound it is looked at less often.
        constexpr double kLongest = 16;
        const double calm = error > 0 ? std::clamp(std::sqrt(bound / error), 1.0, kLongest) : kLongest;
        set_next(next, id, context.time + every * calm);
    }
}

}  // namespace plab::governors
