/// plab-log without its command line.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "link/sequence.h"
#include "logger/lines.h"
#include "logger/options.h"
#include "logger/order.h"
#include "plab/result.h"

namespace plab::logger
{

/// Where lines go: standard output or a file.
class Output
{
public:
    enum class State : unsigned char
    {
        Good,
        Closed,  ///< the reader of the pipe has gone: a normal end
        Broken,
    };

    /// Appends to `file`; empty: standard output.
    static Result<Output> open(const std::string& file);

    void write(const std::string& line);
    State flush();
    /// Why it is broken.
    const std::string& why() const { return why_; }

private:
    struct Closer
    {
        void operator()(std::FILE* f) const { (void)std::fclose(f); }
    };
    void note_error();

    std::unique_ptr<std::FILE, Closer> file_;  ///< empty: standard output
    State state_ = State::Good;
    std::string name_, why_;
};

/// Follows one server, through its ends and restarts, and writes what happens in it.
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

/// How it ended: 0, 1 (cannot write, no bus), 3 (no server), and why.
struct End
{
    int code = 0;
    Errors errors;
};

/// plab-log without its command line; `plabctl log` uses it too. Joins, finds the server and writes its lines until `interrupted`, or until
/// the number of entries or the time of `options` is reached.
End follow(const LoggerOptions& options, const link::Stop& interrupted);

}  // namespace plab::logger
