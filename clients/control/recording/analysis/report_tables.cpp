#include "control/recording/analysis/report_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

#include "figures/axes.h"

namespace plab::analysis
{
namespace
{

using figures::no_cell;
using figures::number_cell;
using figures::Page;
using figures::PageCell;
using figures::short_number;
using figures::text_cell;
using figures::text_cells;
using figures::whole_cell;
using Row = std::vector<PageCell>;

constexpr std::size_t kMostRows = 300;

std::string formatted(const char* format, double value)
{
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

/// A moment on the recording's time line: it needs more digits than other numbers.
PageCell moment(double value) { return {formatted("%.6g", value), formatted("%.9e", value), ""}; }
std::string microseconds(double ns) { return short_number(ns * 1e-3) + " µs"; }

/// Shortens a long table, with a note.
void add_table(Page& page, const Row& columns, const std::vector<Row>& rows, std::uint64_t all)
{
    page.table(columns, rows);
    if (all > rows.size()) page.paragraph("The first " + std::to_string(rows.size()) + " of " + std::to_string(all) + ".");
}

std::string joined(const plab_v2_Operation& o)
{
    std::string out;
    for (std::uint32_t i = 0; i < o.values._length; ++i)
        out += (i == 0 ? "" : ", ") + std::string(o.values._buffer[i].name) + " = " + o.values._buffer[i].text;
    return out;
}

Row row_of(const plab_v2_EventInfo& e, std::int64_t step, double log_time)
{
    const std::string participants =
        std::string(e.component_id) + (*e.a != 0 ? std::string(" ") + e.a : "") + (*e.b != 0 ? std::string(" ") + e.b : "");
    return {moment(log_time), whole_cell(step), text_cell(e.severity), text_cell(e.kind), text_cell(participants), text_cell(e.message)};
}

std::string with_unit(const Segment& s) { return short_number(s.largest_error) + (s.error_unit.empty() ? "" : " " + s.error_unit); }

}  // namespace

std::string sentence_of(const Swap& swap, const std::vector<Segment>& segments)
{
    const double at = seconds(swap.log_time);
    std::string out = "At " + formatted("%.6g", at) + " s (step " + std::to_string(swap.step) + ") " + swap.component + " was exchanged, " +
                      (swap.from.empty() ? "" : swap.from + " ") + "→ " + swap.to;
    const Segment* before = nullptr;
    const Segment* after = nullptr;
    for (const Segment& s : segments)
    {
        if (s.component != swap.component || s.run != swap.run) continue;
        if (s.end < at) before = &s;
        if (s.begin >= at && after == nullptr && s.algorithm == swap.to) after = &s;
    }
    if (before == nullptr || after == nullptr) return out + ".";
    std::vector<std::string> sentences;
    if (before->mean_cost > 0 || after->mean_cost > 0)
        sentences.push_back(microseconds(before->mean_cost) + " per step before, " + microseconds(after->mean_cost) + " after");
    if (before->largest_error > 0 || after->largest_error > 0)
        sentences.push_back("largest error " + with_unit(*before) + " before, " + with_unit(*after) + " after");
    for (std::size_t i = 0; i < sentences.size(); ++i) out += (i == 0 ? ": " : "; ") + sentences[i];
    return out + ".";
}

void add_segments(Page& page, const std::vector<Segment>& segments)
{
    std::vector<Row> rows;
    for (const Segment& s : segments)
        if (rows.size() < kMostRows)
            rows.push_back({text_cell(s.component),
                            {s.algorithm, "", s.resolved},
                            whole_cell(s.run),
                            moment(s.begin),
                            moment(s.end),
                            number_cell(s.mean_cost * 1e-3),
                            number_cell(s.largest_error),
                            text_cell(s.error_unit),
                            number_cell(s.work)});
    if (rows.empty()) return;
    page.paragraph("Each interaction with each algorithm that it used. Click a column header to sort by it.");
    add_table(page,
              text_cells({"interaction", "algorithm", "run", "from, s", "to, s", "cost, µs/step", "largest error", "unit", "work, J"}),
              rows, segments.size());
}

namespace
{

/// All changes from one level to another.
struct LevelChanges
{
    std::string what;  ///< "Solver/RungeKutta4 -> Solver/Exact"
    std::uint64_t count = 0;
    std::array<std::vector<double>, 4> figures;  ///< cost before and after, s; error before and after; those that are known

    /// The median; unknown if there is none.
    PageCell cell(std::size_t k, double scale)
    {
        std::vector<double>& known = figures[k];
        if (known.empty()) return text_cell("unknown");
        const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
        std::nth_element(known.begin(), middle, known.end());
        return number_cell(scale * *middle);
    }
};

}  // namespace

void add_level_changes(Page& page, const Log& log)
{
    std::vector<LevelChanges> all;
    Stream stream = log.stream({"plab/events"});
    while (const Entry* entry = stream.next())
    {
        const auto* events = entry->as<plab_v2_Events>();
        for (std::uint32_t i = 0; events != nullptr && i < events->entries._length; ++i)
        {
            const plab_v2_EventInfo& e = events->entries._buffer[i];
            if (std::string_view(e.kind) != "level.changed") continue;
            const std::string_view message = e.message;
            const std::string what(message.substr(0, message.find(": ")));
            auto found = std::find_if(all.begin(), all.end(), [&](const LevelChanges& c) { return c.what == what; });
            if (found == all.end()) found = all.insert(all.end(), LevelChanges{what, 0, {}});
            ++found->count;
            for (std::uint32_t k = 0; k < std::min<std::uint32_t>(4, e.values._length); ++k)
                if (std::isfinite(e.values._buffer[k])) found->figures[k].push_back(e.values._buffer[k]);
        }
    }
    if (all.empty()) return;
    std::vector<Row> rows;
    for (LevelChanges& c : all)
        rows.push_back({text_cell(c.what), whole_cell(static_cast<std::int64_t>(c.count)), c.cell(0, 1e6), c.cell(1, 1e6), c.cell(2, 1),
                        c.cell(3, 1)});
    page.paragraph(
        "What was exchanged for what. Costs and errors are medians of those that were known at the exchange; the unit of an error is in "
        "the event.");
    add_table(page, text_cells({"levels", "changes", "cost before, µs/step", "after", "error before", "after"}), rows, rows.size());
}

void add_requests(Page& page, const Log& log)
{
    std::vector<Row> rows;
    std::uint64_t all = 0;
    Stream stream = log.stream({"plab/journal"});
    while (const Entry* entry = stream.next())
    {
        const auto* journal = entry->as<plab_v2_Journal>();
        for (std::uint32_t i = 0; journal != nullptr && i < journal->operations._length; ++i)
        {
            const plab_v2_Operation& o = journal->operations._buffer[i];
            if (++all <= kMostRows)
                rows.push_back({moment(seconds(entry->log_time)), whole_cell(journal->step), text_cell(o.verb), text_cell(o.target),
                                text_cell(o.argument), text_cell(joined(o)), text_cell(journal->origin)});
        }
    }
    if (rows.empty()) return;
    page.heading("Requests");
    page.paragraph("The requests that were carried out, in the order in which they took effect.");
    add_table(page, text_cells({"at, s", "before step", "request", "target", "argument", "values", "from"}), rows, all);
}

void add_events(Page& page, const Log& log, const Summary& summary)
{
    if (summary.events.empty() && summary.collisions.empty()) return;
    page.heading("Events");
    std::vector<Row> kinds;
    for (const KindCount& k : summary.events) kinds.push_back({text_cell(k.kind), text_cell(k.severity), whole_cell(k.count)});
    for (const KindCount& k : summary.collisions)
        kinds.push_back({text_cell("collision." + k.kind), text_cell("info"), whole_cell(k.count)});
    page.table(text_cells({"kind", "severity", "number"}), kinds);
    std::vector<Row> rows;
    std::uint64_t all = 0;
    Stream stream = log.stream({"plab/events"});
    while (const Entry* entry = stream.next())
    {
        const auto* events = entry->as<plab_v2_Events>();
        for (std::uint32_t i = 0; events != nullptr && i < events->entries._length; ++i)
            if (const plab_v2_EventInfo& e = events->entries._buffer[i]; std::string_view(e.severity) != "info" && ++all <= kMostRows)
                rows.push_back(row_of(e, events->step, seconds(entry->log_time)));
    }
    if (rows.empty()) return;
    page.heading("Warnings and failures");
    add_table(page, text_cells({"at, s", "step", "severity", "kind", "objects", "message"}), rows, all);
}

void add_runs(Page& page, const Summary& summary)
{
    std::vector<Row> rows;
    for (const Run& r : summary.runs)
        if (rows.size() < kMostRows)
            rows.push_back({whole_cell(r.number), text_cell(r.cause), moment(seconds(r.begin)), moment(seconds(r.end)),
                            whole_cell(r.first_step), whole_cell(r.last_step), moment(r.first_time), moment(r.last_time)});
    if (summary.runs.size() < 2) return;
    page.heading("Runs");
    page.paragraph(
        "A load, a reset or a restored snapshot begins a run. The time of the recording continues, while each run has its own simulated "
        "time.");
    add_table(page, text_cells({"run", "began with", "from, s", "to, s", "first step", "last step", "simulated from, s", "to, s"}), rows,
              summary.runs.size());
}

void add_losses(Page& page, const Summary& summary)
{
    std::vector<Row> rows;
    for (const TopicSummary& t : summary.topics)
        if (t.missing > 0)
            rows.push_back({text_cell(t.name), whole_cell(t.missing), text_cell("in " + std::to_string(t.gaps) + " gaps of its numbers"),
                            text_cell("")});
    for (const auto& [topic, samples] : summary.dropped)
        rows.push_back({text_cell(topic), whole_cell(samples), text_cell("dropped by the server"), text_cell("")});
    for (const NotedGap& g : summary.gaps)
        rows.push_back({text_cell("all topics"), whole_cell(g.messages), text_cell(g.reason),
                        text_cell(formatted("%.6g", seconds(g.from)) + " to " + formatted("%.6g", seconds(g.to)))});
    for (const std::string& loss : summary.losses())
        rows.push_back({text_cell("the file"), no_cell(), text_cell("lost, and not recovered: " + loss), text_cell("")});
    for (const std::string& trouble : summary.troubles.texts)
        rows.push_back({text_cell("the file"), no_cell(), text_cell(trouble), text_cell("")});
    if (rows.empty()) return;
    page.heading("What is missing");
    page.table(text_cells({"of", "messages", "why", "when, s"}), rows);
}

void add_topics(Page& page, const Summary& summary)
{
    std::vector<Row> rows;
    for (const TopicSummary& t : summary.topics)
        rows.push_back({text_cell(t.name), text_cell(t.schema), whole_cell(t.messages), number_cell(t.rate()),
                        number_cell(static_cast<double>(t.bytes) * 1e-3)});
    page.table(text_cells({"topic", "type", "messages", "per second", "kB"}), rows);
    if (summary.snapshots.empty()) return;
    std::vector<Row> snapshots;
    for (const SnapshotSummary& s : summary.snapshots)
        if (snapshots.size() < kMostRows)
            snapshots.push_back({whole_cell(s.run), whole_cell(s.step), moment(s.time), text_cell(s.cause), text_cell(s.name),
                                 number_cell(static_cast<double>(s.bytes) * 1e-3)});
    page.paragraph("Snapshots, from which a run can be continued:");
    add_table(page, text_cells({"run", "step", "time, s", "cause", "name", "kB"}), snapshots, summary.snapshots.size());
}

namespace
{

std::string unit_of_error(const plab_v2_InteractionMetrics& m)
{
    for (std::uint32_t i = 0; i < m.outputs._length; ++i)
        if (const plab_v2_Parameter& p = m.outputs._buffer[i]; std::string_view(p.kind) == "account" && std::string_view(p.name) == "error")
            return p.unit;
    return {};
}

class SegmentCollector
{
public:
    void note(const plab_v2_Metrics& metrics, double time)
    {
        for (std::uint32_t i = 0; i < metrics.interactions._length; ++i) note(metrics.interactions._buffer[i], metrics, time);
    }
    std::vector<Segment> take()
    {
        std::vector<Segment> out;
        for (auto& [component, series] : series_)
            for (Segment& segment : series.segments) out.push_back(std::move(segment));
        return out;
    }

private:
    struct TimeSeries
    {
        std::vector<Segment> segments;
        double last_work = 0;        ///< J since the run began
        std::uint64_t measured = 0;  ///< samples of the last segment that have a cost
    };

    void note(const plab_v2_InteractionMetrics& m, const plab_v2_Metrics& all, double time)
    {
        TimeSeries& series = series_[m.component_id];
        const bool is_new_run = series.segments.empty() || series.segments.back().run != all.run;
        if (is_new_run || series.segments.back().algorithm != m.requested)
        {
            Segment& segment = series.segments.emplace_back();
            series.measured = 0;
            segment.component = m.component_id, segment.algorithm = m.requested, segment.run = all.run, segment.begin = time;
        }
        if (is_new_run) series.last_work = m.work;
        Segment& now = series.segments.back();
        now.resolved = m.resolved, now.end = time;
        ++now.samples;
        // The first sample of a run measures what was before it (is_measured in quantity.h).
        if (all.step_ns > 0 && !is_new_run) now.mean_cost += (m.cost_ns - now.mean_cost) / static_cast<double>(++series.measured);
        // A residual until the first shadow step, then the measured error: values of two units have no common maximum.
        if (const std::string unit = unit_of_error(m); std::exchange(now.error_unit, unit) != unit) now.largest_error = 0;
        // A comparison with NaN is false.
        if (!(std::fabs(m.error) <= now.largest_error)) now.largest_error = std::fabs(m.error);
        now.work += m.work - series.last_work;
        series.last_work = m.work;
    }

    std::map<std::string, TimeSeries> series_;
};

}  // namespace

std::vector<Segment> segments_of(const Log& log)
{
    SegmentCollector collector;
    Stream stream = log.stream({"plab/metrics"});
    while (const Entry* entry = stream.next())
        if (const auto* metrics = entry->as<plab_v2_Metrics>()) collector.note(*metrics, seconds(entry->log_time));
    return collector.take();
}

}  // namespace plab::analysis
