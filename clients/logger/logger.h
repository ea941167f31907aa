/// Follows one server, and writes what happens in it, through its ends and beginnings.
#pragma once

#include <chrono>
#include <vector>

#include "logger/lines.h"
#include "logger/numbers.h"
#include "logger/options.h"
#include "logger/output.h"

namespace plab::logger
{

class Logger
{
public:
    static Result<Logger> make(const link::Session& session, const Options& options, Output output);

    /// Waits up to `longest`, then writes and flushes what has come and has stayed for kSettling. Good: go on.
    Output::State step(link::Seconds longest);
    /// Writes and flushes what is left.
    Output::State finish();
    /// As many entries as were asked for are written.
    bool is_full() const { return options_.count && written_ >= *options_.count; }
    const Output& output() const { return output_; }

private:
    using Clock = std::chrono::steady_clock;
    /// Topics arrive each for itself, and what was lost on the way arrives late: a line waits so long for those that
    /// happened before it.
    static constexpr link::Seconds kSettling{0.1};

    /// A line that waits for its place among those of the other topics.
    struct Entry
    {
        Clock::time_point came = Clock::now();
        std::uint64_t run = 0;
        std::int64_t step = 0;
        bool counts = true;  ///< towards -n
        std::string text;
    };

    explicit Logger(Output output) : output_(std::move(output)) {}

    void take_all();
    void take_server();
    void take_events();
    void take_collisions();
    void take_metrics();
    template <class Sample>
    void note_gap(const Sample& sample, const dds_sample_info_t& info, Numbers& numbers, const char* topic);
    void write_entries(bool all);
    void say_server(ServerChange change, const link::ServerInfo& info);
    bool is_wanted(const std::string& kind, Severity severity) const;

    Options options_;
    Output output_;
    std::unique_ptr<Lines> lines_;
    wire::Reader<plab_v1_Server> server_;
    wire::Reader<plab_v1_Events> events_;
    wire::Reader<plab_v1_Collisions> collisions_;
    wire::Reader<plab_v1_Metrics> metrics_;
    wire::Entity waitset_;

    Numbers event_numbers_, collision_numbers_;
    std::vector<Entry> entries_;
    link::ServerInfo last_;  ///< that was seen
    bool is_there_ = false, was_there_ = false;
    std::uint64_t run_ = 0;  ///< that the last line was about; 0: none yet
    std::uint64_t written_ = 0;
};

}  // namespace plab::logger
