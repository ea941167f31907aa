/// Records what a server publishes, by listening: for the server it is only one more reader.
#pragma once

#include <map>
#include <variant>

#include "control/recording/recorder/pending_disposals.h"
#include "idl/recording/async_writer.h"
#include "idl/recording/cdr.h"
#include "idl/recording/sample_header.h"
#include "idl/recording/timeline.h"
#include "link/discovery.h"
#include "link/sequence.h"

namespace plab::recorder
{

struct RecorderOptions
{
    recording::AsyncWriterOptions writer;
    std::vector<std::string> topics;   ///< none: all but images and contacts
    std::optional<double> until;       ///< s, simulated: the recording ends there
    std::optional<double> state_rate;  ///< maximum number of frames per simulated second; empty: all
};

enum class State : std::uint8_t
{
    Running,
    Done,       ///< `until` is reached
    Gone,       ///< the server has gone
    Restarted,  ///< another server of that name has taken its place
};

/// What waits to be written: a sample, a gap that the bus left, an attachment.
struct Message
{
    const wire::Topic* topic = nullptr;
    std::uint64_t publish_time = 0;
    recording::Bytes data;
};
struct Gap
{
    recording::Losses losses;
    std::string why;
};
struct Blueprint
{
    std::string text;
};
struct Waiting
{
    std::uint64_t log_time = 0;
    std::variant<Message, Gap, Blueprint> what;
};

struct Progress : recording::WriteProgress
{
    std::uint64_t missing = 0;  ///< messages that never arrived
};

/// The topics to record. An error names a topic that does not exist.
Result<std::vector<const wire::Topic*>> choose_topics(const std::vector<std::string>& names);

class Recorder
{
public:
    /// Opens the file and subscribes to everything. The session must outlive it.
    static Result<std::unique_ptr<Recorder>> open(const link::Session& session, const link::ServerInfo& server,
                                                  const RecorderOptions& options);

    /// Waits for samples up to `longest`, and takes those that have arrived.
    State step(link::Seconds longest);
    /// Completes the file. An error: not everything could be written.
    Result<void> close();

    Progress progress() const { return {writer_.progress(), missing_}; }
    /// s, of the recording's time line.
    double length() const { return static_cast<double>(timeline_.now()) * 1e-9; }
    /// Samples that did not match the type of their topic.
    std::uint64_t broken() const { return broken_; }

private:
    using Clock = std::chrono::steady_clock;

    /// A topic that is read.
    struct Track
    {
        const wire::Topic* topic = nullptr;
        link::RawReader reader;
        std::unique_ptr<recording::Peek> peek;
        link::Sequence numbers;
        recording::Losses missing;  ///< not yet noted in the file
        std::uint64_t last_log_time = 0;
    };

    Recorder(const RecorderOptions& options, const link::ServerInfo& server, recording::McapWriter writer);
    Result<void> subscribe(const link::Session& session, const std::vector<const wire::Topic*>& topics);
    /// A sample that has arrived and is not processed yet.
    struct Arrived
    {
        Track* track = nullptr;
        recording::Bytes data;
        bool has_value = true, is_gone = false;
        std::int64_t written_ns = 0;
        std::uint64_t writer = 0;
    };

    void take_all();
    void take(Track& track);
    void process(Arrived& sample);
    void keep(const Track& track, const recording::SampleHeader& header, std::uint64_t log_time, Message&& message);
    void put(std::uint64_t log_time, Message&& message);
    void process_gone(const Arrived& sample);
    void note_server(const recording::SampleHeader& header);
    void note_gap(Track& track, const recording::SampleHeader& header, std::uint64_t writer, std::uint64_t log_time);
    bool is_left_out(const Track& track, const recording::SampleHeader& header);
    void write(const std::vector<Disposal>& disposals);
    void report_gaps();

    RecorderOptions options_;
    std::int64_t started_ns_ = 0;  ///< of the server that is recorded
    std::vector<Track> tracks_;    ///< all of them, from subscribe() on
    std::vector<Arrived> arrived_;
    wire::Entity waitset_;
    recording::Timeline timeline_;
    PendingDisposals disposals_;
    recording::Encoder encoder_;
    State state_ = State::Running;
    std::uint64_t run_ = 0;
    std::optional<std::pair<std::uint64_t, double>> next_frame_;  ///< run, s: for state_rate
    bool has_blueprint_ = false;
    std::uint64_t broken_ = 0, missing_ = 0;
    Clock::time_point reported_at_{};

    recording::AsyncWriter<Waiting> writer_;
};

}  // namespace plab::recorder
