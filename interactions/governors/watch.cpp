#include "watch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace plab::governors
{

void WatchRows::describe(Schema& schema)
{
    schema
        .param(watches, "watches", unit::one,
               "ids of the components whose level it chooses; `*` stands for any text, `?` for any character")
        .or_else("*");
    schema.param(levels, "levels", unit::one,
                 "the ladder, from the cheapest to the most exact level: types with parameters, separated by `;`, or the name of a family");
    schema.param(every, "every", unit::second, "time between two looks").or_else(0.25).positive();
    schema.param(dwell, "dwell", unit::second, "a level is kept at least for this time before it becomes cheaper")
        .or_else(1)
        .not_negative();
    schema.param(hysteresis, "hysteresis", unit::one, "a bound is exceeded by this fraction before the level becomes cheaper")
        .or_else(0.1)
        .not_negative();
    schema.state(changed, "changed", unit::one, "when components were changed within the last `dwell`, s");
    schema.output(count, "count", unit::one, "number of components at each level");
    schema.output(changes, "changes", unit::one, "number of changes that it has asked for");
}

bool due(const StepContext& context, double every)
{
    constexpr double kRounding = 1e-9;
    const auto looks = [&](double time) { return std::floor(time / every + kRounding); };
    return context.tick == 0 || looks(context.time) != looks(context.time - context.dt);
}

Look::Look(const StepContext& context, Row row, WatchRows& rows, LevelControl& control)
    : context_(context), row_(row), rows_(rows), control_(control), watched_(control.watched(row)), finest_(control.levels(row) - 1)
{
    const double forgotten = context.time - rows.dwell[row];
    std::erase_if(rows.changed[row], [&](const Entry& e) { return std::get<double>(e.value) < forgotten; });
    rows.count[row].assign(static_cast<std::size_t>(finest_ + 1), 0.0);
    for (const GovernedComponent& g : watched_)
        if (g.level >= 0) ++rows.count[row][static_cast<std::size_t>(g.level)];
}

/// Entries stay in the order of ids, so that they can be searched.
Look::~Look()
{
    Entries& changed = rows_.changed[row_];
    const auto before = [](const Entry& a, const Entry& b) { return a.name < b.name; };
    std::sort(fresh_.begin(), fresh_.end(), before);
    std::erase_if(changed, [&](const Entry& e) { return std::binary_search(fresh_.begin(), fresh_.end(), e, before); });
    const auto old = static_cast<std::ptrdiff_t>(changed.size());
    changed.insert(changed.end(), fresh_.begin(), fresh_.end());
    std::inplace_merge(changed.begin(), changed.begin() + old, changed.end(), before);
}

double Look::since(std::size_t index) const
{
    const Entries& changed = rows_.changed[row_];
    const std::string_view id = control_.id_of(watched_[index].component);
    const auto found =
        std::lower_bound(changed.begin(), changed.end(), id, [](const Entry& e, std::string_view name) { return e.name < name; });
    return found != changed.end() && found->name == id ? std::get<double>(found->value) : -std::numeric_limits<double>::infinity();
}

bool Look::rested(std::size_t index) const { return context_.time - since(index) >= rows_.dwell[row_] * (1 - 1e-9); }

bool Look::choose(std::size_t index, std::int32_t level, std::string reason, bool urgent)
{
    const GovernedComponent& g = watched_[index];
    if (g.level == level) return false;
    if (level < g.level && !urgent && !rested(index)) return false;
    fresh_.push_back({std::string(control_.id_of(g.component)), context_.time});
    if (g.level >= 0) --rows_.count[row_][static_cast<std::size_t>(g.level)];
    ++rows_.count[row_][static_cast<std::size_t>(level)];
    ++rows_.changes[row_];
    control_.choose(row_, index, level, std::move(reason));
    return true;
}

std::string brief(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

}  // namespace plab::governors
