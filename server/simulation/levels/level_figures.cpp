// What the levels that are exchanged cost and how they err, as far as it is known.
#include <algorithm>
#include <cmath>

#include "simulation/costs/component_costs.h"
#include "simulation/levels/level_book.h"

namespace plab::simulation
{
namespace
{

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Nothing costs nothing: a type whose components are timed one by one has an account without entries.
double seconds_of(const ComponentCost& cost) { return cost.last.samples > 0 && cost.last.median > 0 ? 1e-9 * cost.last.median : kUnknown; }

}  // namespace

std::pair<double, const char*> error_of_trial(const LevelTrial& trial, const std::string& unit)
{
    if (unit == "W") return {trial.error.power, "W"};
    if (unit == "rad" || std::isnan(trial.error.distance)) return {trial.error.angle, "rad"};
    return {trial.error.distance, "m"};
}

/// The largest of what its type declares as errors.
FigurePair LevelBook::own_error(std::uint32_t component) const
{
    FigurePair out;
    for (const Field& field : world_.table_of(component).schema().fields())
    {
        const auto* column = field.is_error ? dynamic_cast<const Column<double>*>(field.column) : nullptr;
        if (!column) continue;
        const double value = std::fabs((*column)[world_.component(component).row]);
        if (!(value <= out.before)) out.before = value, out.unit = field.unit.symbol;
    }
    return out;
}

/// The one that watches the component; null: none does.
const LevelBook::Governor* LevelBook::governor_of(std::uint32_t component) const
{
    if (component >= watcher_.size() || watcher_[component] == kNoIndex) return nullptr;
    const auto is_it = [&](const Governor& g) { return g.component == watcher_[component]; };
    const auto found = std::find_if(governors_.begin(), governors_.end(), is_it);
    return found == governors_.end() ? nullptr : &*found;
}

/// As people read it.
std::string LevelBook::text_of_level(const Governor& g, std::uint32_t component, std::int32_t level) const
{
    return level < 0 ? world_.type_of(component)->info.name : g.ladder.levels[static_cast<std::size_t>(level)].text;
}

/// What the components that have a level cost on the average, by level: of a sample of them, because this is done while the loop stands
/// still.
std::vector<double> LevelBook::costs_of_levels(const Governor& g, const ComponentCosts& costs) const
{
    constexpr std::size_t kMost = 64;
    const std::size_t levels = g.ladder.levels.size(), count = std::min(kMost, g.watched.size());
    std::vector<double> sum(levels, 0.0), known(levels, 0.0);
    for (std::size_t n = 0; n < count; ++n)
    {
        const std::uint32_t component = g.watched[n * g.watched.size() / count].component;
        const std::int32_t level = level_of(world_, component, g.ladder);
        const double seconds = seconds_of(costs.of(component));
        if (level < 0 || std::isnan(seconds)) continue;
        sum[static_cast<std::size_t>(level)] += seconds, known[static_cast<std::size_t>(level)] += 1;
    }
    for (std::size_t l = 0; l < levels; ++l) sum[l] = known[l] > 0 ? sum[l] / known[l] : kUnknown;
    return sum;
}

std::vector<LevelChange> LevelBook::before_exchange(const std::vector<Operation>& operations)
{
    std::vector<LevelChange> out;
    const ComponentCosts costs(world_, stepper_.cost());
    costs_of_levels_.clear();
    for (const Operation& operation : operations)
    {
        const auto* swap = std::get_if<SwapOperation>(&operation);
        LevelChange& change = out.emplace_back();
        const std::uint32_t i = swap ? world_.find(swap->id) : kNoIndex;
        const Governor* g = i == kNoIndex ? nullptr : governor_of(i);
        if (!g) continue;
        const std::int32_t level = level_of(world_, i, g->ladder);
        change.from = text_of_level(*g, i, level);
        if (!costs_of_levels_.contains(g->component)) costs_of_levels_[g->component] = costs_of_levels(*g, costs);
        const ComponentCost cost = costs.of(i);
        change.cost.before = seconds_of(cost);
        // Levels of one type share an account, unless each component is timed on its own.
        change.cost.after = swap->type == world_.type_of(i)->info.name && cost.shared > 1 ? kUnknown : 0;
        change.error = own_error(i);
        Known& known = known_[i];
        known.had.resize(g->ladder.levels.size());
        if (level >= 0) known.had[static_cast<std::size_t>(level)] = {change.cost.before, change.error.before};
    }
    return out;
}

const LevelChange& LevelBook::after_exchange(std::uint32_t component, std::string reason, double time, LevelChange change)
{
    static const LevelChange none;
    const Governor* g = governor_of(component);
    if (!g) return none;
    const std::int32_t level = level_of(world_, component, g->ladder);
    change.to = text_of_level(*g, component, level);
    const Told& tells = told_[component];
    FigurePair trial_cost, trial_error, told;
    for (const LevelTrial& trial : trials_[component])
    {
        const auto [error, unit] = error_of_trial(trial, tells.unit);
        if (trial.text == change.from) trial_cost.before = trial.seconds > 0 ? trial.seconds : kUnknown, trial_error.before = error;
        if (trial.text == change.to) trial_cost.after = trial.seconds > 0 ? trial.seconds : kUnknown, trial_error.after = error;
        trial_error.unit = unit;
    }
    const Known& known = known_[component];
    if (const auto at = static_cast<std::size_t>(level); level >= 0 && at < known.had.size())
    {
        const bool can_tell = !std::isnan(change.cost.after);
        change.cost.after = known.had[at].cost;
        const auto costs = costs_of_levels_.find(g->component);
        if (can_tell && std::isnan(change.cost.after) && costs != costs_of_levels_.end() && at < costs->second.size())
            change.cost.after = costs->second[at];
        change.error.after = known.had[at].error;
    }
    if (tells.by == g->component) told = {known.told_before, tells.error, tells.unit};
    change.is_trial = &better(change.cost, trial_cost) == &trial_cost;
    change.cost = FigurePair(better(change.cost, trial_cost));
    change.error = FigurePair(better(better(told, trial_error), change.error));
    changes_[component] = {world_.id_of(component), std::move(reason), time, std::move(change)};
    return changes_[component].what;
}

}  // namespace plab::simulation
