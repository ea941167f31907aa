/// Follows one server, through its ends and restarts, and writes what happens in it.
#pragma once

#include <vector>

#include "link/sequence.h"
#include "logger/lines.h"
#include "logger/options.h"
#include "logger/order.h"
#include "logger/output.h"

namespace plab::logger
{

class Logger
{
public:
    static Result<Logger> make(const link::Session& session, const LoggerOptions& options, Output output);

    /// Waits up to `longest`, then writes and flushes the lines that are due (order.h). Good: continue.
    Output::State step(link::Seconds longest);
    /// Writes and flushes what is left.
    Output::State finish();
    /// As many entries as requested have been written.
    bool is_full() const { return options_.count && written_ >= *options_.count; }
    const Output& output() const { return output_; }

private:
    explicit Logger(Output output) : output_(std::move(output)) {}

    void take_all();
    void take_server();
    void take_events();
    void take_collisions();
    void take_metrics();
    template <class Sample>
    void note_gap(const Sample& sample, const dds_sample_info_t& info, link::Sequence& numbers, const char* topic);
    void add(std::uint64_t run, std::int64_t step, std::string text, bool counts = true);
    void write(const std::vector<Line>& lines);
    void say_server(ServerChange change, const link::ServerInfo& info);

    LoggerOptions options_;
    Output output_;
    std::unique_ptr<Lines> lines_;
    wire::DataReader<plab_v2_Server> server_;
    wire::DataReader<plab_v2_Events> events_;
    wire::DataReader<plab_v2_Collisions> collisions_;
    wire::DataReader<plab_v2_Metrics> metrics_;
    wire::Entity waitset_;

    link::Sequence event_numbers_, collision_numbers_;
    Order order_;
    link::ServerInfo last_;  ///< the server that was seen last
    bool is_there_ = false, was_there_ = false;
    std::uint64_t run_ = 0;  ///< run of the last line; 0: none yet
    std::uint64_t written_ = 0;
};

}  // namespace plab::logger
