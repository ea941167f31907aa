#include "daemon/live_table.h"

#include <unistd.h>

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <limits>

#include "publish/error_probe.h"
#include "publish/figures.h"
#include "simulation/costs/component_costs.h"

namespace plab::daemon
{
namespace
{

constexpr std::size_t kLines = 6, kChanges = 4;
/// At most this many objects, and as many interactions, to fit on a terminal.
constexpr std::size_t kRows = 20, kRowsWithLevels = 6;

template <class... Values>
std::string line_of(const char* format, Values... values)
{
    char line[256];
    std::snprintf(line, sizeof line, format, values...);
    return line;
}

std::string more_text(std::size_t rows, std::size_t most) { return rows > most ? line_of("  and %zu more\n", rows - most) : std::string(); }

std::string objects_text(const world::World& world, std::size_t most)
{
    std::string out = "objects\n";
    std::size_t rows = 0;
    for (const std::uint32_t i : world.in_id_order())
    {
        const world::Component& c = world.component(i);
        const bool moves =
            c.facet == Facet::Shaft || (c.facet == Facet::Body && world.host().bodies.motion[c.host_index] != Motion::Static);
        if (!moves || ++rows > most) continue;
        if (c.facet == Facet::Shaft)
        {
            out += line_of("  %-24.24s %10.3f rad  %10.4f rad/s\n", c.id.c_str(), world.host().shafts.angle[c.host_index],
                           world.host().shafts.speed[c.host_index]);
            continue;
        }
        const Vec3 p = world.host().bodies.pose(c.host_index).p, v = world.host().bodies.velocity[c.host_index];
        out += line_of("  %-24.24s (%8.4f %8.4f %8.4f) m  (%8.4f %8.4f %8.4f) m/s\n", c.id.c_str(), p.x, p.y, p.z, v.x, v.y, v.z);
    }
    return out + more_text(rows, most);
}

std::string interactions_text(const simulation::Simulation& s, std::size_t most)
{
    std::string out = line_of("%-26s %-34s %16s  %-10s %s\n", "interactions", "algorithm", "cost per step", "error", "unit");
    const simulation::ComponentCosts costs(s.world(), s.stepper().cost());
    std::size_t rows = 0;
    for (const std::uint32_t i : s.world().in_id_order())
    {
        if (!publish::is_interaction(s.world().component(i)) || ++rows > most) continue;
        const world::Component& c = s.world().component(i);
        const publish::ErrorFigure error = publish::own_error(s, i);
        out += line_of("  %-24.24s %-34.34s %13.0f ns  %-10s %s%s\n", c.id.c_str(), s.world().type_of(i)->info.name.c_str(),
                       costs.of(i).last.median, std::isnan(error.value) ? "-" : line_of("%.2e", error.value).c_str(), error.unit.c_str(),
                       c.quarantined ? "  quarantined" : "");
    }
    return out + more_text(rows, most);
}

/// Of one governor: the components that have a level.
struct AtLevel
{
    std::uint32_t governor = kNoIndex;
    std::int32_t level = 0, levels = 0;
    std::string text;
    std::size_t count = 0;
    double cost = 0;                                          ///< ns, of all of them
    double error = std::numeric_limits<double>::quiet_NaN();  ///< the largest one
    std::string unit;
};

/// The error as the governor measured it, otherwise what the component itself reports.
void note_error(const simulation::Simulation& s, const simulation::LevelInfo& l, AtLevel& group)
{
    publish::ErrorFigure error{l.error, l.error_unit, ""};
    if (std::isnan(error.value)) error = publish::own_error(s, l.component);
    if (!std::isnan(error.value) && !(error.value <= group.error)) group.error = error.value, group.unit = error.unit;
}

/// Empty if no governor watches anything.
std::string levels_text(const simulation::Simulation& s)
{
    std::vector<AtLevel> groups;
    const simulation::ComponentCosts costs(s.world(), s.stepper().cost());
    for (const simulation::LevelInfo& l : s.levels().levels())
    {
        const auto is_it = [&](const AtLevel& g) { return g.governor == l.governor && g.level == l.level; };
        auto group = std::find_if(groups.begin(), groups.end(), is_it);
        if (group == groups.end())
        {
            group = groups.insert(groups.end(), AtLevel());
            group->governor = l.governor, group->level = l.level, group->levels = l.levels, group->text = l.text;
        }
        ++group->count, group->cost += costs.of(l.component).last.median;
        note_error(s, l, *group);
    }
    if (groups.empty()) return {};
    const auto key = [&](const AtLevel& g) { return std::pair(s.world().rank(g.governor), g.level); };
    std::sort(groups.begin(), groups.end(), [&](const AtLevel& a, const AtLevel& b) { return key(a) < key(b); });
    std::string out = line_of("%-18s %-7s %10s %14s  %-18s %s\n", "levels of detail", "level", "components", "cost per step",
                              "largest error", "algorithm");
    for (const AtLevel& g : groups)
    {
        const std::string level = g.level < 0 ? "-" : std::to_string(g.level + 1) + " of " + std::to_string(g.levels);
        const std::string error = std::isnan(g.error) ? "unknown" : line_of("%.2e ", g.error) + g.unit;
        out += line_of("  %-16.16s %-7s %10zu %11.1f us  %-18s %s\n", s.world().id_of(g.governor).c_str(), level.c_str(), g.count,
                       1e-3 * g.cost, error.c_str(), g.text.c_str());
    }
    return out;
}

std::string table_text(const simulation::Simulation& s, const std::string& levels)
{
    const simulation::Totals totals = s.totals();
    // A scene with governors is large: its levels say more than its first objects.
    const std::size_t rows = levels.empty() ? kRows : kRowsWithLevels;
    return line_of("t = %9.4f s   step %" PRId64 "   energy %.6g J%s\n", s.time(), s.tick(), totals.kinetic + totals.stored,
                   s.paused() ? "   paused" : "") +
           levels + objects_text(s.world(), rows) + interactions_text(s, rows);
}

std::string stamped(double time, const std::string& text)
{
    char stamp[32];
    std::snprintf(stamp, sizeof stamp, "%10.4f s  ", time);
    return stamp + text;
}

}  // namespace

std::string event_text(const simulation::Simulation& s, const Event& e)
{
    std::string text = e.kind;
    if (e.component != kNoIndex) text += " " + s.world().id_of(e.component);
    if (e.a.valid() && e.b.valid()) text += " (" + s.world().id_of(e.a) + ", " + s.world().id_of(e.b) + ")";
    if (!e.message.empty()) text += ": " + e.message;
    return text;
}

LiveTable::LiveTable(bool wanted, std::string footer) : wanted_(wanted), terminal_(isatty(STDOUT_FILENO) != 0), footer_(std::move(footer))
{
}

void LiveTable::note(const simulation::Simulation& s)
{
    if (!wanted_) return;
    for (const Event& e : s.events())
    {
        const bool apart = terminal_ && e.kind == "level.changed";  // other events would hide it
        if (!apart) note(stamped(e.time, event_text(s, e)));
        if (apart) keep(changes_, kChanges, stamped(e.time, event_text(s, e)));
    }
}

void LiveTable::note(std::string line)
{
    if (!wanted_) return;
    if (!terminal_)
    {
        std::printf("%s\n", line.c_str());
        return;
    }
    keep(lines_, kLines, std::move(line));
}

void LiveTable::keep(std::deque<std::string>& lines, std::size_t most, std::string line)
{
    lines.push_back(std::move(line));
    if (lines.size() > most) lines.pop_front();
}

void LiveTable::show(const simulation::Simulation& s, bool last)
{
    if (!wanted_) return;
    const auto now = std::chrono::steady_clock::now();
    if (s.tick() < shown_tick_) next_ = s.time();  // a new run
    const bool due = terminal_ ? now - shown_ > std::chrono::milliseconds(100) : s.time() >= next_;
    if (!due && !(last && s.tick() != shown_tick_)) return;
    shown_ = now, shown_tick_ = s.tick();
    while (next_ <= s.time()) next_ += 1.0;
    // Looking through thousands of components takes a part of a step.
    if (last || levels_until_ <= now || s.run() != levels_of_run_)
        levels_ = levels_text(s), levels_until_ = now + std::chrono::milliseconds(terminal_ ? 500 : 0), levels_of_run_ = s.run();
    std::string changes = levels_;
    for (const std::string& line : changes_) changes += "  " + line + "\n";
    std::string text = table_text(s, changes);
    if (!lines_.empty()) text += "latest events\n";
    for (const std::string& line : lines_) text += "  " + line + "\n";
    if (terminal_ && !footer_.empty()) text += footer_ + "\n";
    const std::lock_guard lock(output_);
    if (terminal_) std::fputs("\x1b[H\x1b[J", stdout);
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
}

void LiveTable::show_busy(const publish::Busy& busy)
{
    const auto now = std::chrono::steady_clock::now();
    constexpr std::chrono::seconds kEvery(1);  // output that is not a terminal keeps each line
    if (!wanted_ || (!terminal_ && now - busy_shown_ < kEvery)) return;
    busy_shown_ = now;
    const std::lock_guard lock(output_);
    std::printf(terminal_ ? "\r\x1b[K%s" : "%s\n", ("in progress: " + publish::text_of(busy)).c_str());
    std::fflush(stdout);
}

}  // namespace plab::daemon
