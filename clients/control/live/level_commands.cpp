#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "control/console/table.h"
#include "control/live/commands.h"
#include "control/live/metrics_text.h"
#include "control/live/refresh.h"
#include "idl/values/scene.h"
#include "link/names.h"

namespace plab::cli
{
namespace
{

/// On a terminal, more lines than this would hide the beginning.
constexpr std::size_t kMostOnTerminal = 40;

struct LevelsOptions
{
    std::vector<std::string> only;  ///< ids, or parts of them
    bool live = false;
};

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// What a governor has to do with a component, as the catalogue states it.
struct LevelOf
{
    std::string id, governor, algorithm, reason, since;
    long level = -1, levels = 0;
    double error = kUnknown;  ///< as the governor measured it, in this unit
    std::string unit;
    double next_look = kUnknown, every = 0;  ///< s
    struct Tried
    {
        long level = 0;
        std::string algorithm, unit;
        double error = kUnknown, cost = kUnknown;  ///< against the next finer level; s, of a trial step of what the component acts on
    };
    std::vector<Tried> tried;  ///< levels that trial steps have told about, from the cheapest on
    /// The last change: what is known of the level before and of the one after.
    std::string before, change_unit;  ///< of the errors
    double cost_before = kUnknown, cost_after = kUnknown, error_before = kUnknown, error_after = kUnknown;
};

const wire::Parameter& parameter_of(const std::vector<wire::Parameter>& parameters, std::string_view name)
{
    static const wire::Parameter none;
    const auto is_it = [&](const wire::Parameter& p) { return p.kind == "level" && p.name == name; };
    const auto at = std::find_if(parameters.begin(), parameters.end(), is_it);
    return at == parameters.end() ? none : *at;
}

const std::string& parameter(const std::vector<wire::Parameter>& parameters, std::string_view name)
{
    return parameter_of(parameters, name).text;
}

double real(const std::string& text) { return text.empty() ? kUnknown : std::strtod(text.c_str(), nullptr); }

std::optional<LevelOf> level_of(const std::string& id, const std::vector<wire::Parameter>& parameters)
{
    LevelOf out;
    out.id = id, out.governor = parameter(parameters, "governor");
    if (out.governor.empty()) return {};
    out.algorithm = parameter(parameters, "level_algorithm"), out.reason = parameter(parameters, "level_reason");
    out.since = parameter(parameters, "level_since");
    out.level = std::strtol(parameter(parameters, "level").c_str(), nullptr, 10);
    out.levels = std::strtol(parameter(parameters, "levels").c_str(), nullptr, 10);
    const wire::Parameter& error = parameter_of(parameters, "level_error");
    out.error = real(error.text), out.unit = error.unit;
    out.next_look = real(parameter(parameters, "level_next_look")), out.every = real(parameter(parameters, "level_every"));
    out.before = parameter(parameters, "level_before");
    out.cost_before = real(parameter(parameters, "level_cost_before")), out.cost_after = real(parameter(parameters, "level_cost_after"));
    for (const auto& [name, to] : {std::pair("level_error_before", &out.error_before), std::pair("level_error_after", &out.error_after)})
        if (const wire::Parameter& found = parameter_of(parameters, name); !found.text.empty())
            *to = real(found.text), out.change_unit = found.unit;
    for (long k = 0; k < out.levels; ++k)
    {
        const std::string of = "." + std::to_string(k);
        const std::string& name = parameter(parameters, "level_name" + of);
        if (name.empty()) continue;
        const wire::Parameter& found = parameter_of(parameters, "level_error" + of);
        out.tried.push_back({k, name, found.unit, real(found.text), real(parameter(parameters, "level_cost" + of))});
    }
    return out;
}

/// s, from now to when the governor looks at the component again; a governor that measures no errors looks at all of them at each multiple
/// of `every`.
double until_next_look(const LevelOf& level, const link::CatalogueContents& now)
{
    if (!now.metrics) return kUnknown;
    const double time = now.metrics->time;
    if (!std::isnan(level.next_look)) return std::max(0.0, level.next_look - time);
    constexpr double kRounding = 1e-9;
    return level.every > 0 ? (std::floor(time / level.every + kRounding) + 1) * level.every - time : kUnknown;
}

/// The error that the governor measured, otherwise what the component itself reports.
std::pair<std::string, std::string> error_of(const LevelOf& level, const link::InteractionMetrics* m)
{
    if (!std::isnan(level.error)) return {number(level.error), level.unit};
    return m ? std::pair(error_text(*m), error_unit(*m)) : std::pair<std::string, std::string>();
}

std::string seconds_text(double seconds) { return std::isnan(seconds) ? "" : number(std::round(seconds * 100) / 100) + " s"; }

std::vector<LevelOf> levels_in(const link::CatalogueContents& now, const std::vector<std::string>& only)
{
    std::vector<LevelOf> out;
    const auto add = [&](const std::string& id, const std::vector<wire::Parameter>& parameters)
    {
        const auto wanted = [&](const std::string& part) { return id.find(part) != std::string::npos; };
        if (!only.empty() && std::none_of(only.begin(), only.end(), wanted)) return;
        if (auto level = level_of(id, parameters)) out.push_back(std::move(*level));
    };
    for (const auto& [id, i] : now.interactions) add(id, i.parameters);
    for (const auto& [id, o] : now.objects) add(id, o.parameters);
    // The most exact ones first: they are what a governor spends its budget on.
    std::stable_sort(out.begin(), out.end(), [](const LevelOf& a, const LevelOf& b) { return a.level > b.level; });
    return out;
}

/// "3 of 4", counted from the cheapest; "-" for an algorithm that the ladder does not name.
std::string place(const LevelOf& level)
{
    return level.level < 0 ? "-" : std::to_string(level.level + 1) + " of " + std::to_string(level.levels);
}

/// "cost 1.2 us -> 3.9 us, error unknown -> 0.003 m": what the last change made of both; empty: there was none.
std::string change_text(const LevelOf& level)
{
    if (level.before.empty()) return {};
    const auto cost = [](double seconds) { return std::isnan(seconds) ? "unknown" : duration_text(1e9 * seconds); };
    const auto error = [&](double value) { return std::isnan(value) ? "unknown" : number(value) + " " + level.change_unit; };
    return "cost " + cost(level.cost_before) + " -> " + cost(level.cost_after) + ", error " + error(level.error_before) + " -> " +
           error(level.error_after);
}

Json json_of(double value) { return std::isnan(value) ? Json() : Json(value); }

Json json_of(const std::vector<LevelOf::Tried>& tried)
{
    Json out = Json::array();
    for (const LevelOf::Tried& t : tried)
        out.push_back({{"level", t.level},
                       {"algorithm", t.algorithm},
                       {"error", json_of(t.error)},
                       {"error_unit", t.unit},
                       {"cost", json_of(t.cost)}});
    return out;
}

Json json_of(const LevelOf& level, const link::CatalogueContents& now, const link::InteractionMetrics* m)
{
    return {{"id", level.id},
            {"governor", level.governor},
            {"level", level.level},
            {"levels", level.levels},
            {"algorithm", level.algorithm},
            {"reason", level.reason},
            {"since", json_of(real(level.since))},
            {"measured_error", json_of(level.error)},
            {"measured_error_unit", level.unit},
            {"until_next_look", json_of(until_next_look(level, now))},
            {"tried", json_of(level.tried)},
            {"last_change", level.before.empty() ? Json()
                                                 : Json{{"from", level.before},
                                                        {"cost_before", json_of(level.cost_before)},
                                                        {"cost_after", json_of(level.cost_after)},
                                                        {"error_before", json_of(level.error_before)},
                                                        {"error_after", json_of(level.error_after)},
                                                        {"error_unit", level.change_unit}}},
            {"metrics", m != nullptr ? wire::json_of(*m) : Json()}};
}

/// How many components have each level, by governor.
void print_counts(const Console& console, const std::vector<LevelOf>& levels)
{
    std::map<std::pair<std::string, long>, std::pair<std::string, std::size_t>> counts;
    for (const LevelOf& l : levels)
    {
        auto& [algorithm, count] = counts[{l.governor, -l.level}];
        algorithm = l.level < 0 ? "not of its ladder" : l.algorithm, ++count;
    }
    Table table({{"governor", Align::Left, Shrink::Middle},
                 {"level", Align::Right},
                 {"algorithm", Align::Left, Shrink::Middle},
                 {"components", Align::Right}});
    for (const auto& [key, value] : counts)
        table.add({key.first, key.second > 0 ? "-" : std::to_string(1 - key.second), value.first, std::to_string(value.second)});
    table.print(console);
}

void print_levels(const Context& c, const link::CatalogueContents& now, const std::vector<LevelOf>& levels, bool all)
{
    if (levels.empty()) return c.console.say("no governor watches a component");
    print_counts(c.console, levels);
    Table table({{"component", Align::Left, Shrink::Middle},
                 {"level", Align::Right},
                 {"algorithm", Align::Left, Shrink::Middle},
                 {"cost/step", Align::Right, Shrink::Never, 2},
                 {"error", Align::Right, Shrink::Never, 3},
                 {"unit", Align::Left, Shrink::Never, 3},
                 {"next look", Align::Right, Shrink::Never, 2},
                 {"since", Align::Right, Shrink::Never, 1},
                 {"why", Align::Left, Shrink::End}});
    const std::size_t shown = all ? levels.size() : std::min(levels.size(), kMostOnTerminal);
    for (std::size_t k = 0; k < shown; ++k)
    {
        const LevelOf& l = levels[k];
        const link::InteractionMetrics* const m = link::find_metrics(now.metrics, l.id);
        const auto [error, unit] = error_of(l, m);
        const std::string change = change_text(l);
        table.add({l.id, place(l), l.algorithm, m ? cost_text(*m) : "", error, unit, seconds_text(until_next_look(l, now)),
                   seconds_text(real(l.since)), l.reason + (change.empty() ? "" : "; " + change)});
    }
    c.console.say("");
    table.print(c.console);
    if (shown < levels.size())
        c.console.say(std::to_string(levels.size() - shown) + " more: plabctl levels ID lists those whose ids contain ID");
}

Exit run_levels(Context& c, const LevelsOptions& o)
{
    if (const Exit e = c.connect(); e != Exit::Done) return e;
    auto catalogue =
        link::Catalogue::open(c.session(), link::Part::Interactions | link::Part::Objects | static_cast<link::Parts>(link::Part::Metrics));
    if (!catalogue) return c.fail(Exit::NoServer, catalogue.errors());
    if (auto fetched = catalogue->fetch(c.timeout(), c.stop()); !fetched) return c.fail(Exit::NoServer, fetched.errors());
    const auto print_now = [&](const link::CatalogueContents& now)
    {
        const std::vector<LevelOf> levels = levels_in(now, o.only);
        if (!c.settings.json) return print_levels(c, now, levels, !o.only.empty());
        Json list = Json::array();
        for (const LevelOf& l : levels) list.push_back(json_of(l, now, link::find_metrics(now.metrics, l.id)));
        print(c.console, {{"server", c.session().server()}, {"step", now.metrics ? Json(now.metrics->step) : Json()}, {"levels", list}});
    };
    return print_again(c, *catalogue, link::Seconds(1), o.live, print_now);
}

/// What trial steps showed of its level and of those beside it.
void add_neighbours(const LevelOf& level, Lines& lines)
{
    for (const LevelOf::Tried& t : level.tried)
    {
        if (level.level >= 0 && std::labs(t.level - level.level) > 1) continue;
        std::string text = t.algorithm + ": ";
        if (t.level + 1 == level.levels)
            text += "the most exact level";
        else
            text += std::isnan(t.error) ? "error not known" : "error " + number(t.error) + " " + t.unit + " against the next finer level";
        if (!std::isnan(t.cost)) text += ", " + duration_text(1e9 * t.cost) + " for a step of it alone";
        lines.add(t.level == level.level ? "this level" : t.level < level.level ? "cheaper" : "finer", text);
    }
}

Exit run_why(Context& c, const std::string& id)
{
    if (const Exit e = c.connect(); e != Exit::Done) return e;
    auto catalogue =
        link::Catalogue::open(c.session(), link::Part::Interactions | link::Part::Objects | static_cast<link::Parts>(link::Part::Metrics));
    if (!catalogue) return c.fail(Exit::NoServer, catalogue.errors());
    if (auto fetched = catalogue->fetch(c.timeout(), c.stop()); !fetched) return c.fail(Exit::NoServer, fetched.errors());
    const link::CatalogueContents& now = catalogue->now();
    std::optional<LevelOf> level;
    const auto interaction = now.interactions.find(id);
    const auto object = now.objects.find(id);
    if (interaction != now.interactions.end()) level = level_of(id, interaction->second.parameters);
    if (object != now.objects.end()) level = level_of(id, object->second.parameters);
    if (interaction == now.interactions.end() && object == now.objects.end())
        return c.fail(Exit::Failed, "no object or interaction has the id '" + id + "'");
    if (!level) return c.fail(Exit::Failed, "no governor watches '" + id + "': its algorithm is what the scene or a request chose");
    const link::InteractionMetrics* const m = link::find_metrics(now.metrics, id);
    if (c.settings.json)
    {
        print(c.console, json_of(*level, now, m));
        return Exit::Done;
    }
    Lines lines;
    lines.add("component", id), lines.add("algorithm", level->algorithm), lines.add("governor", level->governor);
    lines.add("level", place(*level) + ", counted from the cheapest");
    lines.add("why", level->reason.empty() ? "it has not been changed since the run began" : level->reason);
    if (!level->since.empty()) lines.add("since", seconds_text(real(level->since)));
    if (!level->before.empty()) lines.add("before", level->before + "; " + change_text(*level));
    if (!std::isnan(level->error)) lines.add("measured", number(level->error) + " " + level->unit + ", against the next finer level");
    if (const double next = until_next_look(*level, now); !std::isnan(next)) lines.add("next look", "in " + seconds_text(next));
    if (m != nullptr)
        lines.add("cost", cost_in_words(*m)), lines.add("error", error_text(*m) + " " + error_unit(*m) + "; " + error_meaning(*m));
    add_neighbours(*level, lines);
    lines.print(c.console);
    return Exit::Done;
}

}  // namespace

void add_level_commands(const Command& app, Context& context)
{
    auto o = std::make_shared<LevelsOptions>();
    const Command levels =
        add_command(app, context,
                    {"levels", "list which level of detail governors have given to components, and why",
                     "  plabctl levels\n  plabctl levels engine.12 --live -d 10\n  plabctl levels --json | jq '.levels[].level'\n"},
                    [o](Context& c) { return run_levels(c, *o); });
    levels.add_option("component", o->only, "components whose ids contain this").type_name("ID");
    levels.add_flag("--live", o->live, "print again each second, until Ctrl-C, -n or -d");
    auto id = std::make_shared<std::string>();
    const Command why = add_command(app, context, {"why", "tell why a component has its level of detail", "  plabctl why engine.12.7\n"},
                                    [id](Context& c) { return run_why(c, *id); });
    why.add_option("component", *id, "the component").required().type_name("ID");
}

}  // namespace plab::cli
