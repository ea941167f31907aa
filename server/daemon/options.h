/// The command line of plabd.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/compile.h"
#include "plab/result.h"
#include "program/command_line.h"
#include "simulation/requests/requests.h"

namespace plab::daemon
{

enum class Task
{
    Run,
    Check,      ///< load, build, and report errors
    Expand,     ///< print the long form
    Explain,    ///< print what is loaded, resolved and left out, and why
    Reference,  ///< print the manual of all types, or of some
    Replay,     ///< replay a recorded run
    Shadow,     ///< simulate from a snapshot with and without another algorithm
    Import,     ///< write the scene of another program as a blueprint
    Export,     ///< write the scene for another program
};

/// --record and its further options.
struct RecordChoice
{
    std::string file;  ///< "": nothing is recorded
    bool overwrite = false;
    std::vector<std::string> topics;  ///< none: all but images and contacts
    std::string compression = "zstd";
    double state_interval = 0;  ///< s, simulated; 0: each step
    bool moved_only = false;
    double snapshot_interval = 5;  ///< s, simulated
};

/// --replay and its further options.
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
    std::string blueprint;                    ///< of Task::Import: where to write it; "" and "-": standard output
    bool fixed_base = false;                  ///< of a scene of another program
    bool self_collide = false;                ///< likewise
    std::string exported;                     ///< file of Task::Export
    std::vector<std::string> import_folders;  ///< likewise
    std::string reference;                    ///< types to describe; "": all
    double until = -1;                        ///< s; < 0: until a signal
    std::string out;                          ///< JSON of the final state; "-" is standard output
    std::string trace;                        ///< CSV over time
    double every = 0;                         ///< s between trace rows; 0: each step
    double rate = -1;                         ///< 1: real time; 0: as fast as possible; < 0: not given
    int threads = 1;
    std::size_t max_components = model::CompileLimits().components;
    double error_share = 0.01;  ///< of real time for shadow steps
    bool table = false;
    bool maps = false;    ///< print the mapped libraries at the end
    bool hashes = false;  ///< print the state hash of every step
    std::string log_level = "info";
    std::vector<ScheduledOperation> operations;
    std::string load;     ///< snapshot to continue from, instead of a scene
    std::string save;     ///< snapshot of the final state
    double history = -1;  ///< s between snapshots that a rewind needs; 0: none; < 0: not given
    RecordChoice record;
    bool progress = false;  ///< of a replay: a line every few seconds, even if standard error is not a terminal
    ReplayChoice replay;
    ShadowChoice shadow;

    bool bus = true;
    std::string name = "plab";      ///< name of the server on the bus
    std::uint32_t domain = 0;       ///< DDS domain
    std::string network_interface;  ///< empty: this host only
    double states_per_second = 60;  ///< of real time; 0: each step
    bool ros = false;               ///< is a node of ROS 2, too
    std::string ros_namespace;      ///< "", or with '/' in front
    double ros_rate = 60;           ///< messages of a topic per second of real time, at most
    bool paused = false;            ///< waits at step 0
};

/// Limits for scenes and requests.
model::CompileLimits limits_of(const DaemonOptions& options);

/// Fills the options; otherwise sets what to print and the exit code (0 after --help and --version, 2 for wrong usage).
using program::ParseEnd;
std::optional<ParseEnd> parse_options(int argc, char** argv, DaemonOptions& options);

/// "120:contact.response=Response/None" or without the step.
Result<ScheduledOperation> parse_swap(const std::string& text);
/// "120:gear.velocity_factor=-0.25" or without the step.
Result<ScheduledOperation> parse_set(const std::string& text);

}  // namespace plab::daemon
