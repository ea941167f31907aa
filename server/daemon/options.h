/// The command line of plabd.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/compile.h"
#include "plab/result.h"
#include "simulation/requests/requests.h"

namespace plab::daemon
{

enum class Task
{
    Run,
    Check,      ///< load, build, and say whether it holds
    Expand,     ///< print the long form
    Explain,    ///< print what is loaded, resolved and left out, and why
    Reference,  ///< print the manual of all types, or of some
    Replay,     ///< make a recorded run again
    Shadow,     ///< a snapshot's future with another algorithm beside the one without
};

/// --record and what goes with it.
struct RecordChoice
{
    std::string file;  ///< "": nothing is recorded
    bool overwrite = false;
    std::vector<std::string> topics;  ///< none: all but images
    std::string compression = "zstd";
    double state_interval = 0;  ///< s, simulated; 0: each step
    bool moved_only = false;
    double snapshot_interval = 5;  ///< s, simulated
};

/// --replay and what goes with it.
struct ReplayChoice
{
    std::string file;
    bool verify = false;
    std::optional<Tick> from;
    std::optional<std::uint64_t> run;
};

/// --shadow.
struct ShadowChoice
{
    std::string id, type;
    double seconds = 1;  ///< simulated
    bool json = false;
};

/// --swap and --set: a request for a step.
struct ScheduledOperation
{
    std::optional<Tick> at;
    simulation::Operation operation;
};

struct DaemonOptions
{
    Task task = Task::Run;
    std::string scene;
    std::string reference;  ///< of which types; "": all
    double until = -1;      ///< s; < 0: until a signal
    std::string out;        ///< JSON of the end state; "-" is standard output
    std::string trace;      ///< CSV over time
    double every = 0;       ///< s between trace rows; 0: each step
    double rate = -1;       ///< 1: real time; 0: as fast as it goes; < 0: not given
    int threads = 1;
    std::size_t max_components = model::CompileLimits().components;
    double error_share = 0.01;  ///< of real time for shadow steps
    bool table = false;
    bool maps = false;    ///< print the mapped libraries at the end
    bool hashes = false;  ///< print the state hash of each step
    std::string log_level = "info";
    std::vector<ScheduledOperation> operations;
    std::string load;     ///< snapshot to go on from, instead of a scene
    std::string save;     ///< snapshot of the end state
    double history = -1;  ///< s between snapshots that a rewind needs; 0: none; < 0: not given
    RecordChoice record;
    bool progress = false;  ///< of a replay: a line every few seconds, also where standard error is no terminal
    ReplayChoice replay;
    ShadowChoice shadow;

    bool bus = true;
    std::string name = "plab";      ///< of the server on the bus
    std::uint32_t domain = 0;       ///< DDS domain
    std::string network_interface;  ///< empty: this host only
    double states_per_second = 60;  ///< of real time; 0: each step
    bool paused = false;            ///< waits at step 0
};

/// What scenes and requests may ask for.
model::CompileLimits limits_of(const DaemonOptions& options);

/// Fills options, or tells what to print and the exit code (0 after --help and --version, 2 for a wrong use).
struct ParseEnd
{
    int exit_code = 0;
    std::string text;
};
std::optional<ParseEnd> parse_options(int argc, char** argv, DaemonOptions& options);

/// "120:contact.response=Response/None" or without the step.
Result<ScheduledOperation> parse_swap(const std::string& text);
/// "120:gear.velocity_factor=-0.25" or without the step.
Result<ScheduledOperation> parse_set(const std::string& text);

}  // namespace plab::daemon
