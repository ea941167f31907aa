// Recordings as JSON: times in s on the recording's own time line, unless the name says ns.
#include "control/recording_print.h"
#include "control/recordings/log.h"

namespace plab::cli
{
namespace
{

using recordings::seconds;

template <class T, class Convert>
Json list(const std::vector<T>& items, Convert convert)
{
    Json out = Json::array();
    for (const T& item : items) out.push_back(convert(item));
    return out;
}

Json run_of(const recordings::Run& r)
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

Json topic_of(const recordings::TopicSummary& t)
{
    return {{"topic", t.name},          {"type", t.schema},      {"messages", t.messages}, {"bytes", t.bytes}, {"rate", t.rate()},
            {"from", seconds(t.first)}, {"to", seconds(t.last)}, {"missing", t.missing},   {"gaps", t.gaps}};
}

Json swap_of(const recordings::Swap& w)
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

Json gap_of(const recordings::NotedGap& g)
{
    return {{"reason", g.reason}, {"messages", g.messages}, {"bytes", g.bytes}, {"from", seconds(g.from)}, {"to", seconds(g.to)}};
}

Json snapshot_of(const recordings::SnapshotSummary& p)
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

Json json_of(const recordings::Summary& s)
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

Json json_of(const recording::RecoveryReport& r, const std::string& out)
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
