/// A recording as a whole: its origin, its components, its messages.
///
///   auto log = Log::open("run.mcap");
///   Stream stream = log->stream({"plab/states"}, {.from = 3.0});
#pragma once

#include <memory>
#include <optional>

#include "control/recording/analysis/contents.h"
#include "control/recording/analysis/stream.h"

namespace plab::analysis
{

/// Nanoseconds as s, correctly rounded: 300000000 is 0.3.
constexpr double seconds(std::uint64_t nanoseconds) { return static_cast<double>(nanoseconds) / 1e9; }

/// A part of the recording's own time line: simulated seconds since its beginning, which continue across a reset.
struct Span
{
    std::optional<double> from = {}, to = {};
};

class Log
{
public:
    /// An error: it is not a recording, or cannot be read. `watch` is called while the log is read: after it returned false,
    /// everything made from the log is incomplete (is_interrupted()).
    static Result<Log> open(const std::string& path, const recording::Watch& watch = {});

    const recording::McapReader& reader() const { return *reader_; }
    const std::string& path() const { return reader_->name(); }
    /// The metadata record "plab": server, version, host, started ..; empty if there is none.
    const recording::Pairs& head() const { return head_; }
    /// All objects and interactions in the recording.
    const Things& things() const { return things_; }
    /// Runs found in the catalogue, the journal and the server's state; their lengths are not known yet.
    const Runs& runs() const { return runs_; }
    /// Damage in the parts that open() has read.
    const Troubles& troubles() const { return troubles_; }
    bool is_interrupted() const { return *interrupted_; }

    /// Messages of these topics (none: all).
    Stream stream(const std::vector<std::string>& topics = {}, const Span& span = {}) const;
    static recording::Query query(const std::vector<std::string>& topics, const Span& span);

private:
    explicit Log(std::unique_ptr<recording::McapReader> reader) : reader_(std::move(reader)) {}

    std::unique_ptr<recording::McapReader> reader_;  // its address stays the same for the streams
    recording::Pairs head_;
    Things things_;
    Runs runs_;
    Troubles troubles_;
    std::shared_ptr<bool> interrupted_ = std::make_shared<bool>(false);  // set by the source, which does not know the log
};

/// "plab/states" for "states": adds the prefix of our topics.
std::string full_topic(const std::string& name);

}  // namespace plab::analysis
