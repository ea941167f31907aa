#include "control/recording/summary_text.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "control/console/table.h"
#include "control/recording/analysis/log.h"
#include "control/recording/analysis/summary.h"

namespace plab::cli
{
namespace
{

using analysis::counted;
using analysis::date_text;
using analysis::seconds;
using analysis::Summary;
using analysis::text_at;

constexpr std::size_t kMostPrinted = 20;

std::string seconds_text(std::uint64_t nanoseconds) { return exact_number(seconds(nanoseconds)) + " s"; }

/// Three digits say enough.
std::string rate_text(double rate)
{
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), rate < 1000 ? "%.3g" : "%.0f", rate);
    return text.data();
}

void heading(const Console& console, const std::string& text) { console.out("\n" + console.styled(Style::Bold, text) + "\n"); }

/// Says how many of a long list are not printed.
template <class T, class Add>
void add_some(const Console& console, const std::vector<T>& items, Table& table, Add add)
{
    for (std::size_t i = 0; i < std::min(items.size(), kMostPrinted); ++i) add(items[i]);
    table.print(console);
    if (items.size() > kMostPrinted) console.out("  ... and " + std::to_string(items.size() - kMostPrinted) + " more (--json has all)\n");
}

std::string state_of(const Summary& s)
{
    if (s.is_whole()) return "whole";
    if (!s.is_closed) return "truncated: it was not closed; plabctl recover FILE makes a complete file of what is left";
    if (s.troubles.count == 0) return "recovered: something is lost (see below)";
    return "damaged: " + counted(s.troubles.count, "place") + " cannot be read; plabctl recover FILE reports what is lost";
}

void print_head(const Console& console, const Summary& s)
{
    console.out(console.styled(Style::Bold, printable(s.path)) + "  " +
                console.styled(s.is_whole() ? Style::Green : Style::Yellow, state_of(s)) + "\n");
    Lines lines;
    const std::string host = text_at(s.head, "host"), version = text_at(s.head, "version");
    if (const std::string server = text_at(s.head, "server"); !server.empty())
        lines.add("server", server + (host.empty() ? "" : " on " + host) + (version.empty() ? "" : ", pLab " + version));
    lines.add("scene", text_at(s.head, "scene_file"));
    for (const analysis::Attached& a : s.attachments) lines.add("attached", a.name + ", " + bytes_text(a.bytes));
    if (s.messages > 0)
    {
        lines.add("recorded", date_text(s.first_written) + " to " + date_text(s.last_written));
        lines.add("length", number(s.duration()) + " s simulated in " + counted(s.runs.size(), "run") + ", " + number(s.wall_duration()) +
                                " s of wall time");
    }
    std::string size = bytes_text(s.file_bytes) + ", " + counted(s.messages, "message");
    if (s.chunk_bytes > 0)
        size += ", compressed " + number(std::round(10.0 * static_cast<double>(s.raw_bytes) / static_cast<double>(s.chunk_bytes)) / 10) +
                " to 1 in " + counted(s.chunks, "chunk");
    lines.add("size", size);
    if (s.bodies + s.shafts > 0)
        lines.add("moving objects", (s.bodies == 1 ? "1 body" : std::to_string(s.bodies) + " bodies") + ", " + counted(s.shafts, "shaft") +
                                        ": " + number(std::round(s.state_bytes_per_object_second())) +
                                        " bytes of states per object and second, " + number(std::round(s.file_bytes_per_object_second())) +
                                        " in the file, all topics");
    lines.add("requests", s.requests > 0 ? std::to_string(s.requests) + " took effect" : "");
    lines.print(console);
}

void print_runs(const Console& console, const Summary& s)
{
    if (s.runs.size() < 2 && (s.runs.empty() || s.runs.front().cause.empty())) return;
    heading(console, "Runs");
    Table table({{"run", Align::Right},
                 {"from", Align::Right},
                 {"to", Align::Right},
                 {"steps", Align::Right},
                 {"simulated", Align::Right},
                 {"began with", Align::Left, Shrink::End}});
    add_some(console, s.runs, table,
             [&](const analysis::Run& r)
             {
                 table.add({std::to_string(r.number), seconds_text(r.begin), seconds_text(r.end),
                            r.has_steps ? std::to_string(r.first_step) + " to " + std::to_string(r.last_step) : "",
                            r.has_steps ? number(r.first_time) + " to " + number(r.last_time) + " s" : "", r.cause});
             });
}

void print_topics(const Console& console, const Summary& s)
{
    heading(console, "Topics");
    Table table({{"topic"},
                 {"messages", Align::Right},
                 {"per s", Align::Right, Shrink::Never, 2},
                 {"size", Align::Right},
                 {"per message", Align::Right, Shrink::Never, 3},
                 {"missing", Align::Right, Shrink::Never, 1},
                 {"type", Align::Left, Shrink::Middle, 4}});
    for (const analysis::TopicSummary& t : s.topics)
        table.add({t.name, std::to_string(t.messages), t.rate() > 0 ? rate_text(t.rate()) : "", bytes_text(t.bytes),
                   bytes_text(t.messages > 0 ? t.bytes / t.messages : 0),
                   t.missing > 0 ? std::to_string(t.missing) + " in " + counted(t.gaps, "gap") : "", t.schema},
                  t.missing > 0 ? Style::Yellow : Style::Plain);
    table.print(console);
}

void print_swaps(const Console& console, const Summary& s)
{
    if (s.swaps.empty()) return;
    heading(console, "Swaps");
    Table table({{"time", Align::Right},
                 {"run", Align::Right},
                 {"step", Align::Right},
                 {"component", Align::Left, Shrink::Middle},
                 {"from", Align::Left, Shrink::Middle},
                 {"to", Align::Left, Shrink::Middle}});
    add_some(console, s.swaps, table,
             [&](const analysis::Swap& w) {
                 table.add({seconds_text(w.log_time), std::to_string(w.run), std::to_string(w.step), w.component, w.from, w.to});
             });
}

void print_kinds(const Console& console, const Summary& s)
{
    if (s.events.empty() && s.collisions.empty()) return;
    heading(console, "Events");
    Table table({{"kind"}, {"severity"}, {"count", Align::Right}});
    for (const analysis::KindCount& k : s.events)
        table.add({k.kind, k.severity, std::to_string(k.count)},
                  k.severity == "info" ? Style::Plain : (k.severity == "warning" ? Style::Yellow : Style::Red));
    for (const analysis::KindCount& k : s.collisions) table.add({"collision." + k.kind, "", std::to_string(k.count)});
    table.print(console);
}

void print_losses(const Console& console, const Summary& s)
{
    if (s.gaps.empty() && s.dropped.empty() && s.troubles.count == 0 && s.recovered.empty()) return;
    heading(console, "Lost");
    Table table({{"what"}, {"from", Align::Right}, {"to", Align::Right}, {"why", Align::Left, Shrink::Wrap}});
    for (const auto& [topic, samples] : s.dropped)
        table.add({counted(samples, "sample") + " of " + topic, "", "", "dropped by the server"});
    for (const std::string& text : s.losses()) table.add({"not recovered", "", "", text});
    for (const std::string& text : s.troubles.texts) table.add({"damaged", "", "", text});
    add_some(
        console, s.gaps, table,
        [&](const analysis::NotedGap& g) {
            table.add({counted(g.messages, "message") + ", " + bytes_text(g.bytes), seconds_text(g.from), seconds_text(g.to), g.reason});
        });
}

void print_snapshots(const Console& console, const Summary& s)
{
    if (s.snapshots.empty()) return;
    heading(console, "Snapshots");
    Table table({{"run", Align::Right}, {"step", Align::Right}, {"time", Align::Right}, {"cause"}, {"name"}, {"size", Align::Right}});
    add_some(
        console, s.snapshots, table,
        [&](const analysis::SnapshotSummary& p) {
            table.add({std::to_string(p.run), std::to_string(p.step), exact_number(p.time) + " s", p.cause, p.name, bytes_text(p.bytes)});
        });
}

// JSON: times in s on the recording's own time line, unless the name says ns.
template <class T, class Convert>
Json list(const std::vector<T>& items, Convert convert)
{
    Json out = Json::array();
    for (const T& item : items) out.push_back(convert(item));
    return out;
}

Json run_of(const analysis::Run& r)
{
    return {{"run", r.number},
            {"cause", r.cause},
            {"from", seconds(r.begin)},
            {"to", seconds(r.end)},
            {"first_step", r.has_steps ? Json(r.first_step) : Json()},
            {"last_step", r.has_steps ? Json(r.last_step) : Json()},
            {"first_time", r.has_steps ? Json(r.first_time) : Json()},
            {"last_time", r.has_steps ? Json(r.last_time) : Json()}};
}

Json topic_of(const analysis::TopicSummary& t)
{
    return {{"topic", t.name},          {"type", t.schema},      {"messages", t.messages}, {"bytes", t.bytes}, {"rate", t.rate()},
            {"from", seconds(t.first)}, {"to", seconds(t.last)}, {"missing", t.missing},   {"gaps", t.gaps}};
}

Json swap_of(const analysis::Swap& w)
{
    return {{"run", w.run},
            {"step", w.step},
            {"time", w.time ? Json(*w.time) : Json()},
            {"at", seconds(w.log_time)},
            {"component", w.component},
            {"from", w.from},
            {"to", w.to},
            {"origin", w.origin}};
}

Json gap_of(const analysis::NotedGap& g)
{
    return {{"reason", g.reason}, {"messages", g.messages}, {"bytes", g.bytes}, {"from", seconds(g.from)}, {"to", seconds(g.to)}};
}

Json snapshot_of(const analysis::SnapshotSummary& p)
{
    return {{"run", p.run}, {"step", p.step}, {"time", p.time}, {"name", p.name}, {"cause", p.cause}, {"bytes", p.bytes}};
}

Json lost_of(const recording::LostPart& p)
{
    return {{"begin", p.begin},
            {"end", p.end},
            {"reason", p.reason},
            {"after", p.after ? Json(seconds(*p.after)) : Json()},
            {"before", p.before ? Json(seconds(*p.before)) : Json()}};
}

const char* word_for(recording::Verdict verdict)
{
    if (verdict == recording::Verdict::Whole) return "whole";
    return verdict == recording::Verdict::SomethingLost ? "something lost" : "nothing usable";
}

}  // namespace

void print_summary(const Console& console, const Summary& s)
{
    print_head(console, s);
    print_runs(console, s);
    print_topics(console, s);
    print_swaps(console, s);
    print_kinds(console, s);
    print_losses(console, s);
    print_snapshots(console, s);
}

void print_recovery(const Console& console, const recording::RecoveryReport& report, const std::string& out)
{
    std::string text = report.text();
    while (text.ends_with('\n')) text.pop_back();
    for (std::size_t begin = 0; begin < text.size();)
    {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        console.out(printable(std::string_view(text).substr(begin, end - begin)) + "\n");
        begin = end + 1;
    }
    if (report.verdict != recording::Verdict::NothingUsable) console.out("written to " + printable(out) + "\n");
}

Json summary_json(const analysis::Summary& s)
{
    Json out{{"format", 1},
             {"file", s.path},
             {"whole", s.is_whole()},
             {"closed", s.is_closed},
             {"recovered", s.recovered.empty() ? Json() : Json(s.recovered)},
             {"not_recovered", s.losses()},
             {"head", s.head},
             {"library", s.library},
             {"bytes", s.file_bytes},
             {"chunks", s.chunks},
             {"chunk_bytes", s.chunk_bytes},
             {"raw_bytes", s.raw_bytes},
             {"messages", s.messages},
             {"from", seconds(s.begin)},
             {"to", seconds(s.end)},
             {"duration", s.duration()},
             {"wall_duration", s.wall_duration()},
             {"first_written_ns", s.first_written},
             {"last_written_ns", s.last_written},
             {"bodies", s.bodies},
             {"shafts", s.shafts},
             {"state_bytes_per_object_second", s.state_bytes_per_object_second()},
             {"file_bytes_per_object_second", s.file_bytes_per_object_second()},
             {"requests", s.requests}};
    out["runs"] = list(s.runs, run_of);
    out["topics"] = list(s.topics, topic_of);
    out["swaps"] = list(s.swaps, swap_of);
    out["events"] = list(s.events, [](const auto& k) { return Json{{"kind", k.kind}, {"severity", k.severity}, {"count", k.count}}; });
    out["collisions"] = list(s.collisions, [](const auto& k) { return Json{{"kind", k.kind}, {"count", k.count}}; });
    out["gaps"] = list(s.gaps, gap_of);
    out["dropped"] = s.dropped;
    out["snapshots"] = list(s.snapshots, snapshot_of);
    out["attachments"] = list(s.attachments,
                              [](const auto& a) {
                                  return Json{{"name", a.name}, {"media_type", a.media_type}, {"bytes", a.bytes}};
                              });
    out["troubles"] = s.troubles.texts;
    return out;
}

Json recovery_json(const recording::RecoveryReport& r, const std::string& out)
{
    return {{"verdict", word_for(r.verdict)},
            {"file", r.verdict == recording::Verdict::NothingUsable ? Json() : Json(out)},
            {"chunks", r.chunks},
            {"messages", r.messages},
            {"kept", r.kept},
            {"missing", r.knows_missing ? Json(r.missing) : Json()},
            {"from", r.from ? Json(seconds(*r.from)) : Json()},
            {"to", r.to ? Json(seconds(*r.to)) : Json()},
            {"lost", list(r.lost, lost_of)},
            {"lost_after", r.knows_no_end() && r.to ? Json(seconds(*r.to)) : Json()},
            {"mended", r.mended},
            {"closed", r.was_closed}};
}

}  // namespace plab::cli
