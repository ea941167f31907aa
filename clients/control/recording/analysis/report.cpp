#include "control/recording/analysis/report.h"

#include <algorithm>
#include <cmath>

#include "control/recording/analysis/curves.h"
#include "control/recording/analysis/levels.h"
#include "control/recording/analysis/report_tables.h"
#include "control/recording/analysis/summary.h"
#include "figures/page.h"

namespace plab::analysis
{
namespace
{

using figures::Chart;
using figures::Curve;
using figures::Page;
using figures::Scale;
using figures::short_number;

constexpr std::size_t kMostInteractions = 10;  // in one diagram

/// "scenes/fan_and_balloons.xml" as "fan and balloons".
std::string title_of(const Summary& s)
{
    std::string name = text_at(s.head, "scene_file");
    if (name.empty()) name = s.path;
    name = name.substr(name.rfind('/') + 1);
    name = name.substr(0, name.rfind('.'));
    std::replace(name.begin(), name.end(), '_', ' ');
    return "Recording: " + name;
}

std::string lead_of(const Summary& s)
{
    const std::string server = text_at(s.head, "server"), host = text_at(s.head, "host");
    std::string out = short_number(s.duration()) + " simulated seconds in " + counted(s.runs.size(), "run");
    if (!server.empty()) out += " of server " + server + (host.empty() ? "" : " on " + host);
    if (s.messages > 0) out += ", recorded on " + date_text(s.first_written);
    return out + ".";
}

using NamedQuantity = std::pair<std::string, std::string>;  // a quantity, and what it is called

/// Those that the recording has.
std::vector<Curve> curves_of_scene(const Log& log, const std::vector<NamedQuantity>& named)
{
    std::vector<Signal> quantities;
    for (const auto& [quantity, name] : named)
        if (auto parsed = parse_signal(quantity, log.things())) quantities.push_back(parsed->front());
    std::vector<Curve> out;
    for (Curve& curve : curves_of(log, quantities, {}))
    {
        if (curve.points.empty()) continue;
        const auto called = std::find_if(named.begin(), named.end(), [&](const NamedQuantity& n) { return n.first == curve.name; });
        if (called != named.end()) curve.name = called->second;
        out.push_back(std::move(curve));
    }
    return out;
}

bool is_all_zero(const Curve& curve)
{
    return std::all_of(curve.points.begin(), curve.points.end(), [](const auto& p) { return !(std::fabs(p.second) > 0); });
}

/// What all charts of the report have in common.
struct TimeLine
{
    std::vector<figures::Moment> moments;
    std::pair<double, double> span;  ///< s, from the first moment of the recording to the last
};

Chart chart_of(std::string title, std::vector<Curve> curves, const TimeLine& line, Scale::Kind kind = Scale::Kind::Linear)
{
    Chart out;
    out.title = std::move(title), out.curves = std::move(curves), out.moments = line.moments, out.times = line.span, out.kind = kind;
    return out;
}

/// The most costly interactions first.
std::vector<std::string> costly_interactions(const std::vector<Segment>& segments)
{
    std::map<std::string, double> cost;
    for (const Segment& s : segments) cost[s.component] += s.mean_cost * static_cast<double>(s.samples);
    std::vector<std::string> out;
    for (const auto& [id, sum] : cost) out.push_back(id);
    std::stable_sort(out.begin(), out.end(), [&](const auto& x, const auto& y) { return cost[x] > cost[y]; });
    if (out.size() > kMostInteractions) out.resize(kMostInteractions);
    return out;
}

std::vector<Curve> curves_of_interactions(const Log& log, const std::vector<std::string>& ids, const std::string& what,
                                          const std::string& unit)
{
    std::vector<Signal> quantities;
    for (const std::string& id : ids) quantities.push_back({Signal::Source::Interaction, id, what, "", unit});
    std::vector<Curve> out = curves_of(log, quantities, {});
    for (std::size_t i = 0; i < out.size(); ++i) out[i].name = ids[i];
    std::erase_if(out, is_all_zero);
    return out;
}

void add_energy(Page& page, const Log& log, const TimeLine& line)
{
    std::vector<Curve> energy = curves_of_scene(
        log,
        {{"energy.total", "kinetic + stored"}, {"energy.kinetic", "kinetic"}, {"energy.stored", "stored"}, {"energy.work", "work done"}});
    if (energy.empty()) return;
    page.heading("Energy and momentum");
    page.figure(draw(chart_of("Energy", std::move(energy), line)),
                "Kinetic and stored energy, and the work that all interactions have done since the run began. Dashed lines are swaps, "
                "grey lines mark the start of a run.");
    std::vector<Curve> unexplained = curves_of_scene(log, {{"energy.unexplained", "unexplained"}});
    if (!unexplained.empty() && !is_all_zero(unexplained.front()))
        page.figure(
            draw(chart_of("Unexplained energy", std::move(unexplained), line, Scale::Kind::SymLog)),
            "Kinetic energy, less that at the start, less all work: energy that the numerical methods created (above 0) or lost (below).");
    std::vector<Curve> momentum = curves_of_scene(log, {{"momentum.x", "momentum x"},
                                                        {"momentum.y", "momentum y"},
                                                        {"momentum.z", "momentum z"},
                                                        {"angular_momentum.x", "angular momentum x"},
                                                        {"angular_momentum.y", "angular momentum y"},
                                                        {"angular_momentum.z", "angular momentum z"}});
    page.figure(draw(chart_of("Momentum", std::move(momentum), line)), "Of all moving objects; the angular one about the world's origin.");
}

void add_interactions(Page& page, const Log& log, const std::vector<Segment>& segments, const TimeLine& line)
{
    const std::vector<std::string> ids = costly_interactions(segments);
    if (ids.empty()) return;
    page.heading("Cost and error of the interactions");
    std::vector<Curve> cost = curves_of_interactions(log, ids, "cost", "µs per step");
    for (Curve& curve : cost)
        for (auto& [time, value] : curve.points) value *= 1e-3;
    if (!cost.empty())
        page.figure(
            draw(chart_of("Cost", std::move(cost), line, Scale::Kind::Log)),
            "CPU time per step of each interaction, the most costly ones; components of one type share it by their number of rows.");
    std::vector<Curve> error = curves_of_interactions(log, ids, "error", "error");
    if (!error.empty())
        page.figure(draw(chart_of("Error", std::move(error), line, Scale::Kind::Log)),
                    "The largest output that each type declares as its error, in that output's unit.");
    add_segments(page, segments);
}

void add_levels(Page& page, const Log& log, const TimeLine& line)
{
    std::vector<Curve> levels = levels_over_time(log);
    if (levels.empty()) return;
    page.heading("Levels of detail");
    page.figure(draw(chart_of("Levels of detail", std::move(levels), {{}, line.span})),
                "How many components each governor had at each level of its ladder. The reasons are in the events `level.changed`.");
    add_level_changes(page, log);
}

void add_pace(Page& page, const Log& log, const TimeLine& line)
{
    std::vector<Curve> pace = curves_of_scene(log, {{"real_time_factor", "real-time factor"}});
    std::erase_if(pace, is_all_zero);  // without the clock of a server nothing is known of real time
    for (Curve& curve : pace) curve.unit = "× real time";
    for (Curve& curve : curves_of_scene(log, {{"step_cost", "CPU time of a step"}}))
    {
        for (auto& [time, value] : curve.points) value *= 1e-3;
        curve.unit = "µs";
        pace.push_back(std::move(curve));
    }
    if (pace.empty()) return;
    page.heading("Pace");
    page.figure(draw(chart_of("Pace", std::move(pace), line)), "How many times faster than real time it ran, and what a step cost.");
}

std::vector<std::string> findings(const Summary& s, const std::vector<Segment>& segments)
{
    std::vector<std::string> out;
    for (const Swap& swap : s.swaps) out.push_back(sentence_of(swap, segments));
    std::uint64_t warnings = 0, failures = 0, missing = 0;
    for (const KindCount& k : s.events)
        if (k.severity != "info") (k.severity == "warning" ? warnings : failures) += k.count;
    out.push_back(warnings + failures == 0 ? "Neither a warning nor a failure."
                                           : counted(warnings, "warning") + " and " + counted(failures, "failure") + " (below).");
    for (const TopicSummary& t : s.topics) missing += t.missing;
    for (const NotedGap& gap : s.gaps) missing += gap.messages;
    if (s.is_whole() && missing == 0 && s.dropped.empty())
        out.push_back("The recording is complete, and nothing is missing.");
    else if (missing > 0)
        out.push_back(counted(missing, "entry") + " are missing from the file, by their sequence numbers (see below).");
    if (!s.recovered.empty())
    {
        const std::vector<std::string> losses = s.losses();
        out.push_back("It was recovered from a recording that had lost some data" +
                      (losses.empty() ? std::string(".") : ": " + losses.front() + (losses.size() > 1 ? ", and more (see below)." : ".")));
    }
    if (!s.is_closed) out.push_back("The file is truncated: it was not closed.");
    if (s.troubles.count > 0) out.push_back(counted(s.troubles.count, "place") + " of the file cannot be read.");
    return out;
}

void add_facts(Page& page, const Summary& s)
{
    const std::string version = text_at(s.head, "version");
    page.heading("The file");
    page.facts({{"file", s.path},
                {"scene", text_at(s.head, "scene_file")},
                {"server", text_at(s.head, "server") + (version.empty() ? "" : ", pLab " + version)},
                {"host", text_at(s.head, "host")},
                {"recorded", s.messages > 0 ? date_text(s.first_written) + " to " + date_text(s.last_written) : ""},
                {"size", short_number(static_cast<double>(s.file_bytes) * 1e-6) + " MB, " + counted(s.messages, "message")},
                {"moving objects", std::to_string(s.bodies) + " bodies, " + std::to_string(s.shafts) + " shafts"},
                {"states", s.state_bytes_per_object_second() > 0
                               ? short_number(s.state_bytes_per_object_second()) + " bytes per object and second, " +
                                     short_number(s.file_bytes_per_object_second()) + " in the file with all topics"
                               : ""}});
}

}  // namespace

std::string report_html(const Log& log, const Summary& summary)
{
    const std::vector<Segment> segments = segments_of(log);
    const TimeLine line{moments_of(log, {}, false), {seconds(summary.begin), seconds(summary.end)}};
    Page page(title_of(summary), lead_of(summary));
    page.list(findings(summary, segments));
    add_energy(page, log, line);
    add_interactions(page, log, segments, line);
    add_levels(page, log, line);
    add_pace(page, log, line);
    add_requests(page, log);
    add_events(page, log, summary);
    add_runs(page, summary);
    add_losses(page, summary);
    add_facts(page, summary);
    add_topics(page, summary);
    return page.html();
}

}  // namespace plab::analysis
