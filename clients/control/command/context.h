/// What every command of plabctl works with: settings, the session, the console, the exit code.
///
///   void add_pause_command(const Command& app, Context& context)
///   {
///       add_command(app, context, {"pause", "stop the clock", "plabctl pause"}, [](Context& c) { return run_pause(c); });
///   }
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "control/command/command_line.h"
#include "control/console/console.h"
#include "link/session.h"
#include "program/progress.h"

namespace plab::cli
{

enum class Exit : int
{
    Done = 0,
    Failed = 1,
    Usage = 2,
    NoServer = 3,  ///< or time-out
    Refused = 4,
    Lost = 5,           ///< of a recording: something could not be recovered, or could not be written to the disk
    Interrupted = 130,  ///< by a signal; main() gives 128 + its number
};

/// Global options.
struct Settings
{
    link::SessionOptions link;           ///< server, domain, interface
    std::optional<double> timeout;       ///< s; see Context::timeout()
    bool progress = false;               ///< lines of progress even if standard error is not a terminal
    bool json = false;                   ///< one object; for streams, one line per sample
    std::string color = "auto";          ///< "auto", "always", "never"
    std::optional<std::uint64_t> count;  ///< of a stream: end after this many samples
    std::optional<double> duration;      ///< s, of a stream: end after this time
};

class Context
{
public:
    using Action = std::function<Exit(Context&)>;
    static constexpr double kTimeout = 5.0;  ///< s, for commands without a time-out of their own

    Settings settings;
    Console console;
    Action action;  ///< of the selected command; main runs it after the command line is parsed
    /// Writes a scene ("": the server's) as MJCF; of the commands on servers, for `export`, which is one on recordings.
    std::function<Exit(Context&, const std::string& scene, const std::string& out)> export_mjcf;

    /// Joins and finds the server, within timeout(otherwise). Prints errors and returns the exit code; Done: session() is
    /// available.
    Exit connect(double otherwise = kTimeout);
    /// Joins the domain only: for commands that do not address a particular server.
    Exit join();
    bool is_connected() const { return session_.has_value(); }
    const link::Session& session() const { return *session_; }

    link::Seconds timeout(double otherwise = kTimeout) const { return link::Seconds(settings.timeout.value_or(otherwise)); }

    program::ProgressTo progress_to() const { return settings.progress ? program::ProgressTo::Lines : program::ProgressTo::Terminal; }

    /// Ctrl-C was pressed, or SIGTERM came: waiting, reading and streaming end soon.
    bool stopped() const;
    link::Stop stop() const
    {
        return [this] { return stopped(); };
    }
    /// Prints it on standard error, "plabctl: ..."; returns `code`, or Interrupted after Ctrl-C.
    Exit fail(Exit code, const std::string& message) const;
    Exit fail(Exit code, const Errors& errors) const;

private:
    std::optional<link::Session> session_;
};

struct CommandText
{
    std::string name, doc;
    std::string examples;  ///< lines, printed first in its help
};

/// A sub-command whose action is `run`.
Command add_command(const Command& app, Context& context, const CommandText& text, Context::Action run);

}  // namespace plab::cli
