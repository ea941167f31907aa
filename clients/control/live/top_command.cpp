// `top`: where the time of a step goes, and how that and the energy develop, again and again on one screen.
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>

#include "control/console/table.h"
#include "control/live/commands.h"
#include "control/live/metrics_text.h"
#include "control/live/refresh.h"
#include "link/names.h"
#include "link/numbers.h"

namespace plab::cli
{
namespace
{

const std::vector<std::string> kOrders{"cost", "error", "work", "name"};
/// As many past values as a curve shows.
constexpr std::size_t kCurve = 40;
/// Lines of the screen that are not rows of the table.
constexpr std::size_t kHead = 6;
/// Where no screen sets a limit.
constexpr std::size_t kMostRows = 20;

struct TopOptions
{
    std::string by = "cost";
    double every = 1;  ///< s
};

using Metrics = std::vector<const link::InteractionMetrics*>;

/// The last values of a quantity as a line of blocks: the lowest of them is the lowest block.
class Curve
{
public:
    void add(double value)
    {
        values_.push_back(value);
        if (values_.size() > kCurve) values_.pop_front();
    }

    std::string text() const
    {
        static constexpr std::array<const char*, 8> kBlocks{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
        const auto [low, high] = std::minmax_element(values_.begin(), values_.end());
        std::string out;
        for (const double v : values_)
        {
            // Values that differ by rounding only are drawn as equal.
            const double range = *high - *low;
            const bool differs = range > 1e-9 * std::max(std::fabs(*low), std::fabs(*high));
            const double share = differs ? (v - *low) / range : 0;
            out += std::isfinite(share) ? kBlocks[static_cast<std::size_t>(std::lround(7 * share))] : " ";
        }
        return out;
    }

private:
    std::deque<double> values_;
};

struct Curves
{
    std::uint64_t run = 0;
    Curve step, drift;
};

/// Those that come first by the quantity; equal ones by name.
Metrics sorted(const std::vector<link::InteractionMetrics>& all, const std::string& by)
{
    const auto key = [&](const link::InteractionMetrics& m)
    {
        const double value = by == "cost" ? m.cost_ns : by == "error" ? m.error : by == "work" ? m.work : 0;
        return std::isnan(value) ? -1 : std::fabs(value);
    };
    Metrics out;
    for (const link::InteractionMetrics& m : all) out.push_back(&m);
    std::stable_sort(out.begin(), out.end(),
                     [&](const auto* a, const auto* b)
                     { return key(*a) != key(*b) ? key(*a) > key(*b) : a->component_id < b->component_id; });
    return out;
}

std::string percent(double share)
{
    if (!std::isfinite(share) || share <= 0) return "";
    return share < 0.01 ? "<1 %" : std::to_string(std::lround(100 * share)) + " %";
}

void print_head(const Console& console, const link::CatalogueContents& now, const Curves& curves)
{
    if (!now.server) return;
    const link::ServerInfo& s = *now.server;
    console.out(console.styled(Style::Bold, printable(s.name)) + "  " + printable(state_text(s)) + "  step " + std::to_string(s.step) +
                "  " + number(s.time) + " s  " + number(s.rate_reached) + "x  " + printable(s.scene_file) + "\n");
    if (!now.metrics) return console.out("no figures yet\n");
    const link::Metrics& m = *now.metrics;
    console.out("step    " + (m.step_ns > 0 ? duration_text(m.step_ns) : "-") + "  " + std::to_string(m.contacts) + " contacts, deepest " +
                number(m.deepest) + " m  " + curves.step.text() + "\n");
    console.out("energy  kinetic " + number(m.ledger.kinetic) + " J, stored " + number(m.ledger.stored) + " J, unexplained " +
                number(m.ledger.unexplained) + " J  " + curves.drift.text() + "\n\n");
}

void print_screen(const Console& console, const link::CatalogueContents& now, const Curves& curves, const TopOptions& o)
{
    // From the upper left corner of an empty screen.
    if (console.is_terminal()) console.out("\x1b[H\x1b[2J");
    print_head(console, now, curves);
    if (!now.metrics) return;
    const Metrics all = sorted(now.metrics->interactions, o.by);
    const std::size_t most = console.height() > kHead ? console.height() - kHead : kMostRows;
    Table table({{"interaction", Align::Left, Shrink::Middle},
                 {"cost/step", Align::Right},
                 {"of the step", Align::Right, Shrink::Never, 1},
                 {"algorithm", Align::Left, Shrink::Middle},
                 {"error", Align::Right, Shrink::Never, 2},
                 {"unit", Align::Left, Shrink::Never, 2},
                 {"work", Align::Right, Shrink::Never, 3},
                 {"note", Align::Left, Shrink::End}});
    for (std::size_t k = 0; k < std::min(most, all.size()); ++k)
    {
        const link::InteractionMetrics& m = *all[k];
        table.add({m.component_id, cost_text(m), percent(m.cost_ns / now.metrics->step_ns), m.requested, error_text(m), error_unit(m),
                   number(m.work) + " J", note_text(m.requested, m)},
                  m.quarantined ? Style::Red : Style::Plain);
    }
    table.print(console);
    if (all.size() > most) console.out(std::to_string(all.size() - most) + " more: plabctl interactions lists all\n");
    if (!console.is_terminal()) console.out("\n");
}

Json json_of(const link::CatalogueContents& now, const TopOptions& o)
{
    if (!now.metrics) return Json{{"step", nullptr}};
    const link::Metrics& m = *now.metrics;
    Json list = Json::array();
    for (const link::InteractionMetrics* i : sorted(m.interactions, o.by))
    {
        list.push_back(Json{{"id", i->component_id}});
        list.back().update(link::json_of(*i));
    }
    return {{"step", m.step}, {"time", m.time}, {"step_ns", m.step_ns}, {"unexplained", m.ledger.unexplained}, {"interactions", list}};
}

Exit run_top(Context& c, const TopOptions& o)
{
    if (const Exit e = c.connect(); e != Exit::Done) return e;
    auto catalogue = link::Catalogue::open(c.session(), link::Part::Server | link::Part::Metrics);
    if (!catalogue) return c.fail(Exit::Failed, catalogue.errors());
    if (auto fetched = catalogue->fetch(c.timeout(), c.stop()); !fetched) return c.fail(Exit::NoServer, fetched.errors());
    Curves curves;
    const auto print_now = [&](const link::CatalogueContents& now)
    {
        if (now.metrics)
        {
            if (now.metrics->run != curves.run) curves = Curves{now.metrics->run, {}, {}};
            curves.step.add(now.metrics->step_ns), curves.drift.add(now.metrics->ledger.unexplained);
        }
        if (c.settings.json)
            print(c.console, json_of(now, o));
        else
            print_screen(c.console, now, curves, o);
    };
    return print_again(c, *catalogue, link::Seconds(o.every), true, print_now);
}

std::string check_order(const std::string& text)
{
    if (std::find(kOrders.begin(), kOrders.end(), text) != kOrders.end()) return {};
    return "no order '" + text + "'" + link::did_you_mean(text, kOrders) + " There are cost, error, work and name";
}

}  // namespace

void add_top_command(const Command& app, Context& context)
{
    auto o = std::make_shared<TopOptions>();
    const Command top = add_command(app, context,
                                    {"top", "show where the time of a step goes, refreshed each second",
                                     "  plabctl top\n  plabctl top --by error --every 0.5 -d 10\n  plabctl top --json -n 1\n"},
                                    [o](Context& c) { return run_top(c, *o); });
    top.add_option("--by", o->by, "what comes first: largest cost, error or work, or by name").check(check_order).type_name("ORDER");
    top.add_option("--every", o->every, "time between two pictures").check(link::check_positive).type_name("SECONDS");
}

}  // namespace plab::cli
