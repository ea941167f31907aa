/// The contents of a recording: one pass over the file, numbers only.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "control/recording/analysis/contents.h"
#include "control/recording/analysis/log.h"
#include "idl/recording/records.h"

namespace plab::analysis
{

struct TopicSummary
{
    std::string name, schema;
    std::uint64_t messages = 0;
    std::uint64_t bytes = 0;  ///< of messages, before compression
    std::uint64_t first = 0;  ///< log_time
    std::uint64_t last = 0;
    std::uint64_t missing = 0;  ///< numbered entries that are not in the file
    std::uint64_t gaps = 0;     ///< number of gaps

    /// Per second of the recording; 0: it has no length.
    double rate() const;
};

/// Losses as reported by the writer of the file.
struct NotedGap
{
    std::string reason;
    std::uint64_t messages = 0, bytes = 0;
    std::uint64_t from = 0, to = 0;  ///< log_time
};

struct SnapshotSummary
{
    std::uint64_t run = 0;
    std::int64_t step = 0;
    double time = 0;  ///< s, simulated
    std::string name, cause;
    std::uint64_t bytes = 0;  ///< of its data; the blueprint is not counted
};

struct Attached
{
    std::string name, media_type;
    std::uint64_t bytes = 0;
};

/// Events of one kind and severity, or collisions of one kind.
struct KindCount
{
    std::string kind, severity;  ///< severity "": a collision
    std::uint64_t count = 0;
};

struct Summary
{
    std::string path;
    recording::Pairs head;
    std::string library;  ///< that wrote the file
    std::uint64_t file_bytes = 0;
    std::uint64_t chunks = 0, chunk_bytes = 0, raw_bytes = 0;  ///< of chunks: size in the file, and decompressed
    bool is_closed = false;                                    ///< ends as a file does that was closed
    std::string recovered;  ///< report that `plabctl recover` wrote into the file: what it kept and what is lost; "": not recovered
    Troubles troubles;

    std::uint64_t messages = 0;
    std::uint64_t begin = 0, end = 0;                   ///< log_time of the first and the last message
    std::uint64_t first_written = 0, last_written = 0;  ///< publish_time, ns since 1970
    std::vector<Run> runs;
    std::vector<TopicSummary> topics;      ///< those that have messages, by name
    std::uint64_t bodies = 0, shafts = 0;  ///< most that one frame has
    std::vector<Swap> swaps;
    std::uint64_t requests = 0;  ///< that took effect
    std::vector<KindCount> events, collisions;
    std::vector<NotedGap> gaps;
    std::map<std::string, std::uint64_t> dropped;  ///< by the server's rings, as last reported, by topic
    std::vector<SnapshotSummary> snapshots;
    std::vector<Attached> attachments;

    double duration() const { return seconds(end - begin); }  ///< s, simulated, all runs
    double wall_duration() const { return seconds(last_written - first_written); }
    /// Bytes per moving object and second of simulated time; 0 if there is no state or no time.
    double state_bytes_per_object_second() const;  ///< of plab/states, before compression
    double file_bytes_per_object_second() const;   ///< of all that is in the file
    /// Everything that was recorded is present and readable.
    bool is_whole() const { return is_closed && troubles.count == 0 && recovered.empty(); }
    /// "lost: ..." of what was recovered, a text each.
    std::vector<std::string> losses() const;
};

Result<Summary> summary_of(const Log& log);

// Short texts that both the report and plabctl use.

/// "" if there is no such key.
std::string text_at(const recording::Pairs& pairs, const std::string& key);
/// "1 run", "2 runs".
std::string counted(std::uint64_t n, const std::string& what);
/// "2026-11-22 14:05:09 UTC", of ns since 1970.
std::string date_text(std::uint64_t nanoseconds);

}  // namespace plab::analysis
