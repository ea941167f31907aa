// diff: where two recordings first differ, for people and as JSON.
#include <algorithm>
#include <array>
#include <cinttypes>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "control/console/json.h"
#include "control/console/table.h"
#include "control/recording/analysis/curves.h"
#include "control/recording/analysis/diff.h"
#include "control/recording/commands.h"
#include "control/recording/work.h"
#include "figures/chart.h"
#include "link/text.h"

namespace plab::cli
{
namespace
{

using analysis::Difference;
using analysis::Growth;

constexpr std::size_t kMostListed = 30;

std::string hash_text(std::uint64_t hash)
{
    std::array<char, 24> text{};
    std::snprintf(text.data(), text.size(), "%016" PRIx64, hash);
    return text.data();
}

std::string in_run(std::size_t run) { return run == 1 ? "" : " of run " + std::to_string(run); }

std::string when(const std::optional<double>& time) { return time ? exact_number(*time) : ""; }
/// Exactly none is nothing.
std::string size(double value) { return value == 0 ? "0" : number(value); }

void print_first(const Console& console, const Difference& d)
{
    Lines lines;
    if (d.hashes_compared == 0)
        lines.add("hashes", "none to compare (" + std::to_string(d.hashes_a) + " and " + std::to_string(d.hashes_b) + ")");
    else if (d.first_hash)
        lines.add("hashes", "first differ at step " + std::to_string(d.first_hash->step) + in_run(d.first_hash->run) + ": " +
                                hash_text(d.first_hash->a) + " and " + hash_text(d.first_hash->b));
    else
        lines.add("hashes", "equal at all " + std::to_string(d.hashes_compared) + " steps that both have");
    lines.add("frames", std::to_string(d.frames_compared) + " steps in common, of " + std::to_string(d.frames_a) + " and " +
                            std::to_string(d.frames_b));
    if (d.first_state)
    {
        const analysis::StateDifference& s = *d.first_state;
        lines.add("states", "first differ at step " + std::to_string(s.step) + in_run(s.run) + " (" + exact_number(s.time) +
                                " s): " + s.object + " " + s.quantity);
        lines.add("", "A " + link::number_text(s.a));
        lines.add("", "B " + link::number_text(s.b) + "  (" + size(std::fabs(s.a - s.b)) + ")");
    }
    else if (d.frames_compared > 0)
        lines.add("states", "equal");
    const auto list = [](const std::vector<std::string>& ids)
    {
        std::string out;
        for (std::size_t i = 0; i < std::min<std::size_t>(ids.size(), 10); ++i) out += (i == 0 ? "" : " ") + ids[i];
        return out + (ids.size() > 10 ? " and " + std::to_string(ids.size() - 10) + " more" : "");
    };
    std::vector<std::string> single;
    for (const analysis::SingleRun& r : d.not_compared) single.push_back(std::to_string(r.run));
    if (!single.empty())
        lines.add("runs", std::to_string(d.runs_a) + " and " + std::to_string(d.runs_b) + ": not compared, as only " +
                              (d.not_compared.front().is_in_a ? "A" : "B") + " has them: " + list(single));
    lines.add("only in A", list(d.only_in_a));
    lines.add("only in B", list(d.only_in_b));
    lines.print(console);
}

void print_growth(const Console& console, const Difference& d)
{
    if (d.objects.empty() || d.objects.front().largest == 0) return;
    console.out("\n" + console.styled(Style::Bold, "Growth of the difference") + "  time in s when the difference first exceeded ..\n");
    Table table({{"object", Align::Left, Shrink::Middle},
                 {"1e-12", Align::Right, Shrink::Never, 4},
                 {"1e-9", Align::Right, Shrink::Never, 3},
                 {"1e-6", Align::Right, Shrink::Never, 2},
                 {"1e-3", Align::Right, Shrink::Never, 1},
                 {"largest", Align::Right},
                 {"at the end: position", Align::Right},
                 {"orientation", Align::Right, Shrink::Never, 6},
                 {"velocity", Align::Right, Shrink::Never, 5},
                 {"angular", Align::Right, Shrink::Never, 7}});
    std::size_t equal = 0, shown = 0;
    for (const Growth& g : d.objects)
    {
        if (g.largest == 0) ++equal;
        if (g.largest == 0 || ++shown > kMostListed) continue;
        const std::string length = g.is_shaft ? " rad" : " m", speed = g.is_shaft ? " rad/s" : " m/s";
        table.add({g.object, when(g.exceeded[0]), when(g.exceeded[1]), when(g.exceeded[2]), when(g.exceeded[3]), size(g.largest),
                   size(g.position) + length, g.is_shaft ? "" : size(g.orientation) + " rad", size(g.velocity) + speed,
                   g.is_shaft ? "" : size(g.angular_velocity) + " rad/s"});
    }
    table.print(console);
    if (shown > kMostListed) console.out("  ... and " + std::to_string(shown - kMostListed) + " more (--json has all)\n");
    if (equal > 0) console.out("  " + std::to_string(equal) + (equal == 1 ? " object is" : " objects are") + " equal throughout\n");
}

Json growth_of(const Growth& g)
{
    Json exceeded = Json::object();
    constexpr std::array kNames{"1e-12", "1e-9", "1e-6", "1e-3"};
    for (std::size_t i = 0; i < kNames.size(); ++i) exceeded[kNames.at(i)] = g.exceeded[i] ? Json(*g.exceeded[i]) : Json();
    return {{"object", g.object},     {"kind", g.is_shaft ? "shaft" : "body"},
            {"exceeded", exceeded},   {"largest", g.largest},
            {"position", g.position}, {"orientation", g.orientation},
            {"velocity", g.velocity}, {"angular_velocity", g.angular_velocity}};
}

void print_difference(const Console& console, const Difference& d)
{
    print_first(console, d);
    print_growth(console, d);
}

Json difference_json(const Difference& d)
{
    Json hash, state, objects = Json::array();
    if (d.first_hash)
        hash = {
            {"run", d.first_hash->run}, {"step", d.first_hash->step}, {"a", hash_text(d.first_hash->a)}, {"b", hash_text(d.first_hash->b)}};
    if (d.first_state)
        state = {{"run", d.first_state->run},
                 {"step", d.first_state->step},
                 {"time", d.first_state->time},
                 {"object", d.first_state->object},
                 {"quantity", d.first_state->quantity},
                 {"a", d.first_state->a},
                 {"b", d.first_state->b}};
    for (const Growth& g : d.objects) objects.push_back(growth_of(g));
    Json single = Json::array();
    for (const analysis::SingleRun& r : d.not_compared) single.push_back(r.run);
    return {{"same", d.is_none()},
            {"runs", {{"a", d.runs_a}, {"b", d.runs_b}, {"not_compared", single}}},
            {"hashes", {{"a", d.hashes_a}, {"b", d.hashes_b}, {"compared", d.hashes_compared}, {"first_difference", hash}}},
            {"states", {{"a", d.frames_a}, {"b", d.frames_b}, {"compared", d.frames_compared}, {"first_difference", state}}},
            {"only_in_a", d.only_in_a},
            {"only_in_b", d.only_in_b},
            {"objects", objects}};
}

constexpr std::size_t kMostInPlot = 12;  // objects of a difference

struct DiffArguments
{
    std::string a, b, plot;
};

Exit run_diff(Context& c, const DiffArguments& o)
{
    Work work(c, "diff " + o.a + " " + o.b);
    const std::string consequence = "it is not known whether they differ";
    auto a = analysis::Log::open(o.a, work.watch());
    if (c.stopped()) return work.interrupted(consequence);
    if (!a) return c.fail(Exit::Failed, a.errors());
    // The other recording is read in parallel, step by step, so the position in the first one measures the progress.
    auto b = analysis::Log::open(o.b, [&c](double) { return !c.stopped(); });
    if (c.stopped()) return work.interrupted(consequence);
    if (!b) return c.fail(Exit::Failed, b.errors());
    const Difference difference = analysis::difference_of(*a, *b);
    if (c.stopped()) return work.interrupted(consequence);
    work.end();
    if (difference.is_unknown())
        return c.fail(Exit::Failed,
                      "nothing to compare: " + o.a + " and " + o.b + " have no step in common, neither in hashes nor in states");
    if (c.settings.json)
        print(c.console, difference_json(difference));
    else
        print_difference(c.console, difference);
    if (!o.plot.empty())
    {
        std::vector<std::string> objects;
        for (const Growth& g : difference.objects)
            if (g.largest > 0 && objects.size() < kMostInPlot) objects.push_back(g.object);
        const auto chart = analysis::difference_chart(*a, *b, objects);
        if (c.stopped()) return work.interrupted(o.plot + " is not written");
        work.end();
        if (auto written = figures::write_picture(draw(chart), o.plot); !written) return c.fail(Exit::Failed, written.errors());
    }
    const Exit damaged = std::max(warn(c, difference.troubles_a), warn(c, difference.troubles_b));
    return difference.is_none() ? damaged : Exit::Failed;
}

}  // namespace

void add_diff_command(const Command& app, Context& context)
{
    auto o = std::make_shared<DiffArguments>();
    const Command command =
        add_command(app, context,
                    {"diff", "find where two recordings first differ, and how the difference grows",
                     "  plabctl diff a.mcap b.mcap\n  plabctl diff a.mcap b.mcap --plot growth.svg\n"
                     "Steps that both have are compared: state hashes, then states. Exit code 0: no difference; 1: a difference, or one\n"
                     "of them has more runs.\n"},
                    [o](Context& c) { return run_diff(c, *o); });
    command.add_option("a", o->a, "recording").required().type_name("FILE");
    command.add_option("b", o->b, "recording to compare with").required().type_name("FILE");
    command.add_option("--plot", o->plot, "draw the growth of the difference to this .svg or .png file").type_name("FILE");
}

}  // namespace plab::cli
