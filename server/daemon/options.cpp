#include "daemon/options.h"

#include <CLI/CLI.hpp>
#include <charconv>

#include "completion/scene_values.h"
#include "control/operations.h"
#include "idl/values/ros_names.h"
#include "program/installation.h"

namespace plab::daemon
{
namespace
{

constexpr const char* kExamples = R"(Examples:
  plabd scenes/fan_and_balloons.xml --until 10 --out end.json
  plabd scenes/fan_and_balloons.xml --until 10 --trace run.csv --every 0.01
  plabd scenes/fan_and_balloons.xml --until 10 --swap "600:contact.response=Response/None"
  plabd scenes/fan_and_balloons.xml --until 10 --set "red.mass=0.02"
  plabd scenes/fan_and_balloons.xml --until 10 --no-bus --rate max
  plabd --explain scenes/fan_and_balloons.xml
  plabd scenes/fan_and_balloons.xml --until 10 --record run.mcap
  plabd --replay run.mcap --verify
  plabd --import scenes/imported/arm.urdf -o arm.xml
While it runs: plabctl interactions; plabctl swap contact.response --to Response/None; plab-view --png now.png

Exit codes: 0 done, 1 failed (message on standard error), 2 wrong usage.)";

/// Removes "123:" from the front and returns it.
std::optional<Tick> take_step(std::string_view& text)
{
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) return {};
    Tick step = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + colon, step);
    if (error != std::errc() || end != text.data() + colon) return {};
    text.remove_prefix(colon + 1);
    return step;
}

/// Seconds, 0 or more: CLI11's own check accepts NaN.
std::string not_seconds(const std::string& text)
{
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    const bool fine = error == std::errc() && stop == end && value >= 0 && value <= 1e12;
    return fine ? "" : "'" + text + "' is not a number of seconds from 0 to 1e12";
}

/// "", or why the text is no rate of messages.
std::string not_a_rate(const std::string& text)
{
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    const bool fine = error == std::errc() && stop == end && value >= 0.1 && value <= 1e4;
    return fine ? "" : "'" + text + "' is not a number of messages per second from 0.1 to 10000";
}

void add_ros_options(CLI::App& app, DaemonOptions& options)
{
    const std::string group = "ROS 2";
    app.add_flag("--ros", options.ros,
                 "be a node of ROS 2 as well, in the same DDS domain: clock, tf, joint_states, markers, contacts, services")
        ->group(group);
    app.add_option("--ros-namespace", options.ros_namespace, "namespace of all its topics and services, e.g. /sim (default: none)")
        ->type_name("NAME")
        ->group(group);
    app.add_option("--ros-rate", options.ros_rate,
                   "maximum number of messages of a topic per second of real time, up to --states (default: 60)")
        ->check(&not_a_rate, "")
        ->group(group);
}

/// The error in them, if there is one.
std::string take_ros_options(const CLI::App& app, DaemonOptions& options)
{
    for (const char* name : {"--ros-namespace", "--ros-rate"})
        if (app.count(name) > 0 && !options.ros) return std::string(name) + " requires --ros";
    if (options.ros && !options.bus) return "--ros needs the bus";
    if (!wire::ros::is_namespace(options.ros_namespace))
        return "--ros-namespace: '" + options.ros_namespace +
               "' is not a namespace: letters, digits and '_', with '/' between names, e.g. /lab/sim";
    options.ros_namespace = wire::ros::normal_namespace(options.ros_namespace);
    return {};
}

void add_bus_options(CLI::App& app, DaemonOptions& options, std::string& states, bool& no_bus)
{
    const std::string group = "The bus";
    app.add_option("--name", options.name, "name of this server on the bus; clients use --server NAME")
        ->envname("PLAB_SERVER")
        ->group(group);
    app.add_option("--domain", options.domain, "DDS domain")->envname("PLAB_DOMAIN")->check(CLI::Range(0, 232))->group(group);
    app.add_option("--interface", options.network_interface,
                   "network interface of the bus; without it, this host only (CYCLONEDDS_URI, if set, overrides both)")
        ->envname("PLAB_INTERFACE")
        ->group(group);
    app.add_option("--states", states, "maximum number of frames per second of real time, or all: every step (default: 60)")->group(group);
    app.add_flag("--no-bus", no_bus, "do not join the bus: no DDS library is loaded")->group(group);
}

/// The error in the options of the bus, if there is one.
std::string take_bus_options(const std::string& states, bool no_bus, DaemonOptions& options)
{
    options.bus = !no_bus;
    if (states.empty()) return {};
    options.states_per_second = 0;
    if (states == "all") return {};
    const char* const end = states.data() + states.size();
    const auto [stop, error] = std::from_chars(states.data(), end, options.states_per_second);
    if (error == std::errc() && stop == end && options.states_per_second > 0 && options.states_per_second <= 1e6) return {};
    return "--states must be a number of frames per second up to 1e6, or all, not '" + states + "'";
}

void add_record_options(CLI::App& app, DaemonOptions& o, std::string& states)
{
    const std::string group = "Recording";
    RecordChoice& r = o.record;
    app.add_option("--record", r.file, "write the run to FILE.mcap, for plabctl play, plab-view, --replay and other tools")
        ->type_name("FILE")
        ->group(group);
    app.add_flag("--overwrite", r.overwrite, "replace an existing recording")->group(group);
    app.add_option("--record-topics", r.topics,
                   "record only these topics, e.g. plab/states; default: all but plab/images and plab/contacts")
        ->delimiter(',')
        ->group(group);
    app.add_option("--record-states", states, "frames per simulated second, or all: every step (default)")->group(group);
    app.add_flag("--record-moved", r.moved_only, "frames contain only what moved since the previous one")->group(group);
    app.add_option("--record-snapshots", r.snapshot_interval, "simulated seconds between snapshots (default: 5)")
        ->check(&not_seconds, "")
        ->group(group);
    app.add_option("--record-compression", r.compression, "none, lz4 or zstd (default)")
        ->check(CLI::IsMember({"none", "lz4", "zstd"}))
        ->group(group);
}

void add_past_options(CLI::App& app, DaemonOptions& o)
{
    const std::string group = "Going back";
    app.add_option("--load", o.load, "continue from the snapshot in FILE instead of loading a scene")->type_name("FILE")->group(group);
    app.add_option("--save", o.save, "write a snapshot of the final state to FILE")->type_name("FILE")->group(group);
    app.add_option("--history", o.history,
                   "simulated seconds between snapshots kept in memory, which plabctl rewind needs; 0: none (default: 1 with a bus)")
        ->check(&not_seconds, "")
        ->group(group);
    app.add_option("--replay", o.replay.file, "replay the runs in the recording FILE")->type_name("FILE")->group(group);
    app.add_flag("--progress", o.progress,
                 "with --replay, --shadow: print the progress every five seconds, even if standard error is not a terminal")
        ->group(group);
    app.add_flag("--verify", o.replay.verify, "with --replay: compare the state's hash after each step")->group(group);
    app.add_option("--from", o.replay.from, "with --replay: start from the last snapshot at or before this step")->group(group);
    app.add_option("--run", o.replay.run, "with --replay: only this run of the recording")->group(group);
    app.add_option("--shadow", o.shadow.id, "with --load, ID=TYPE: continue with and without that swap, and compare")->group(group);
    app.add_option("--for", o.shadow.seconds, "with --shadow: simulated seconds (default: 1)")->check(&not_seconds, "")->group(group);
    app.add_flag("--json", o.shadow.json, "with --shadow: print JSON")->group(group);
}

/// The first of these options that the command line contains; "" if none.
std::string first_given(const CLI::App& app, std::initializer_list<const char*> names)
{
    for (const char* name : names)
        if (app.count(name) > 0) return name;
    return {};
}

/// Why the options cannot be combined: options that a replay or a shadow run does not use are errors.
std::string why_not_together(const CLI::App& app, bool replay, bool shadow)
{
    if (const std::string given = first_given(app, {"--for", "--json"}); !shadow && !given.empty())
        return given + " requires --shadow ID=TYPE";
    if (!replay && !shadow) return {};
    const std::string what = replay ? "--replay" : "--shadow";
    const std::string given = first_given(app, {"--swap", "--set", "--table", "--history", "--record", "--paused", "--check", "--expand",
                                                "--explain", "--export-mjcf", "--import", "--reference"});
    if (given.empty()) return {};
    if (given == "--swap" || given == "--set")
        return given + " cannot be combined with " + what +
               (replay ? ": the recording contains the requests" : ": name the swap as ID=TYPE");
    return given + " requires a scene or --load, and cannot be combined with " + what;
}

/// The error in these options, if there is one.
std::string take_past_options(const CLI::App& app, const std::string& states, DaemonOptions& o)
{
    const bool replay = !o.replay.file.empty(), shadow = !o.shadow.id.empty();
    if (const std::string why = why_not_together(app, replay, shadow); !why.empty()) return why;
    if (o.replay.from && *o.replay.from < 0) return "--from must be a step, 0 or later, not " + std::to_string(*o.replay.from);
    if (!replay && (o.replay.verify || o.replay.from || o.replay.run)) return "--verify, --from and --run require --replay FILE";
    if (int(replay) + int(!o.load.empty()) + int(!o.scene.empty()) > 1) return "a scene, --load and --replay exclude one another";
    if (shadow && o.load.empty()) return "--shadow requires --load FILE";
    if (shadow)
    {
        const std::size_t equal = o.shadow.id.rfind('=');
        if (equal == std::string::npos || equal == 0 || equal + 1 == o.shadow.id.size())
            return "--shadow needs ID=TYPE, not '" + o.shadow.id + "'";
        o.shadow.type = o.shadow.id.substr(equal + 1), o.shadow.id.resize(equal);
        o.task = Task::Shadow, o.bus = false;
    }
    if (replay) o.task = Task::Replay, o.bus = false;
    if (o.record.file.empty())
        if (const std::string given = first_given(
                app, {"--overwrite", "--record-topics", "--record-states", "--record-moved", "--record-snapshots", "--record-compression"});
            !given.empty())
            return given + " requires --record FILE";
    if (states.empty() || states == "all") return {};
    double rate = 0;
    const char* const end = states.data() + states.size();
    const auto [stop, error] = std::from_chars(states.data(), end, rate);
    if (error != std::errc() || stop != end || !(rate > 0 && rate <= 1e9))
        return "--record-states must be a number of frames per simulated second, or all, not '" + states + "'";
    o.record.state_interval = 1 / rate;
    return {};
}

}  // namespace

model::CompileLimits limits_of(const DaemonOptions& options)
{
    model::CompileLimits limits;
    limits.components = options.max_components, limits.raised_by = "--max-components N";
    return limits;
}

Result<ScheduledOperation> parse_swap(const std::string& text)
{
    std::string_view rest = text;
    ScheduledOperation out;
    out.at = take_step(rest);
    const std::size_t equal = rest.rfind('=');
    if (equal == std::string_view::npos || equal == 0 || equal + 1 == rest.size())
        return reason("--swap needs [STEP:]ID=TYPE, not '" + text + "'");
    out.operation = simulation::SwapOperation{std::string(rest.substr(0, equal)), std::string(rest.substr(equal + 1)), {}};
    return out;
}

Result<ScheduledOperation> parse_set(const std::string& text)
{
    std::string_view rest = text;
    ScheduledOperation out;
    out.at = take_step(rest);
    const std::size_t equal = rest.find('=');
    if (equal == std::string_view::npos) return reason("--set needs [STEP:]ID.name=value, not '" + text + "'");
    const std::string_view target = rest.substr(0, equal);
    const std::size_t dot = target.rfind('.');
    if (dot == std::string_view::npos || dot == 0 || dot + 1 == target.size())
        return reason("--set needs [STEP:]ID.name=value, not '" + text + "'");
    out.operation = simulation::SetOperation{std::string(target.substr(0, dot)), std::string(target.substr(dot + 1)),
                                             std::string(rest.substr(equal + 1))};
    return out;
}

namespace
{

/// Options as they were written; they are read once all of them are known.
struct WrittenOptions
{
    std::string rate, states, recorded_states;
    std::vector<std::string> swaps, sets;
    bool check = false, expand = false, explain = false, no_bus = false;
    std::string imported;
};

void add_run_options(CLI::App& app, DaemonOptions& options, WrittenOptions& written)
{
    app.add_option("scene", options.scene, "blueprint (XML), or a scene in URDF, SDF or MJCF");
    app.add_flag("--fixed-base", options.fixed_base, "of a scene in URDF, SDF or MJCF: what hangs on nothing is fixed to the world");
    app.add_flag("--self-collide", options.self_collide,
                 "of a scene in URDF: links collide with one another, but for those that a joint joins");
    app.add_option("--import-path", options.import_folders, "folder in which model://NAME of SDF is looked for (may be repeated)")
        ->take_all()
        ->allow_extra_args(false)
        ->type_name("FOLDER");
    app.add_option("--until", options.until, "simulated seconds to run; without it, until SIGINT or SIGTERM")->check(&not_seconds, "");
    app.add_option("--out", options.out, "write the final state as JSON to FILE (- is standard output)")->type_name("FILE");
    app.add_option("--trace", options.trace, "write the trajectories as CSV to FILE")->type_name("FILE");
    app.add_option("--every", options.every, "simulated seconds between rows of --trace; default: every step")->check(&not_seconds, "");
    app.add_option("--threads", options.threads, "number of threads that compute the step; the result does not depend on it")
        ->check(CLI::Range(1, 256));
    app.add_option("--max-components", options.max_components, "maximum number of components in a scene, including generated ones")
        ->check(CLI::Range(1, 100'000'000))
        ->capture_default_str();
    app.add_option("--errors", options.error_share,
                   "maximum share of the time for shadow steps, which measure errors while a client reads metrics; 0: none")
        ->check(CLI::Range(0.0, 0.5))
        ->capture_default_str();
    app.add_option("--log-level", options.log_level, "least severity of messages on standard error")
        ->check(CLI::IsMember({"debug", "info", "warning", "error", "off"}));
    app.add_flag("--table", options.table, "show a live table of the scene's state");
    app.add_flag("--hashes", options.hashes, "print the state hash of every step");
    app.add_flag("--maps", options.maps, "print the libraries that are mapped at the end of the run");
    app.add_option("--rate", written.rate, "real, max, or a factor of real time; default: max with --until, else real");
    app.add_option("--swap", written.swaps, "[STEP:]ID=TYPE: exchange a component at a step boundary (may be repeated)")
        ->take_all()
        ->allow_extra_args(false);
    app.add_option("--set", written.sets, "[STEP:]ID.name=value: set a parameter or state (may be repeated)")
        ->take_all()
        ->allow_extra_args(false);
}

/// Options that print something instead of running the scene.
void add_task_options(CLI::App& app, DaemonOptions& options, WrittenOptions& written)
{
    app.add_flag("--check", written.check, "check the blueprint and exit");
    app.add_flag("--expand", written.expand,
                 "print the long form of the blueprint; with --until, of the scene as it is then, without rules");
    app.add_flag("--explain", written.explain, "print what is loaded, resolved and left out, and why; with --until, then");
    app.add_option("--import", written.imported, "write the URDF, SDF or MJCF file FILE as a blueprint, and list what is not carried over")
        ->type_name("FILE");
    app.add_option("-o", options.blueprint, "with --import: the blueprint to write; without it, standard output")->type_name("SCENE");
    app.add_option("--export-mjcf", options.exported, "write the scene as MJCF to FILE, and list what that cannot say; with --until, then")
        ->type_name("FILE");
    app.add_option("--reference", options.reference,
                   "print the reference of all component types, of one (Response/Rows, Rows) or of a kind")
        ->expected(0, 1)
        ->type_name("[TYPE]");
}

/// Reads which task, scene and rate are wanted; a reason if they contradict one another.
std::string take_task(bool reference, const WrittenOptions& written, DaemonOptions& options)
{
    const bool import = !written.imported.empty();
    const bool exports = !options.exported.empty();
    if (int(written.check) + int(written.expand) + int(written.explain) + int(reference) + int(import) + int(exports) > 1)
        return "--check, --expand, --explain, --export-mjcf, --import and --reference exclude one another";
    if (import && !options.scene.empty()) return "--import FILE and a scene exclude one another";
    if (!import && !options.blueprint.empty()) return "-o requires --import FILE";
    if (import) options.scene = written.imported;
    options.task = written.check     ? Task::Check
                   : written.expand  ? Task::Expand
                   : written.explain ? Task::Explain
                   : reference       ? Task::Reference
                   : import          ? Task::Import
                   : exports         ? Task::Export
                                     : Task::Run;
    if (options.scene.empty() && options.load.empty() && options.replay.file.empty() && options.task != Task::Reference)
        return "needs a scene; see plabd --help";
    if (written.rate.empty()) return {};
    const auto factor = control::parse_rate(written.rate);
    if (!factor) return "--rate: " + factor.error().reason;
    options.rate = *factor;
    return {};
}

std::string take_operations(const WrittenOptions& written, DaemonOptions& options)
{
    for (const auto& [texts, parse] : {std::pair(&written.swaps, &parse_swap), std::pair(&written.sets, &parse_set)})
        for (const std::string& text : *texts)
        {
            auto parsed = parse(text);
            if (!parsed) return parsed.error().reason;
            options.operations.push_back(*parsed);
        }
    return {};
}

}  // namespace

std::optional<ParseEnd> parse_options(int argc, char** argv, DaemonOptions& options)
{
    CLI::App app{"plabd: a simulation server for interacting objects", "plabd"};
    app.footer(kExamples);
    app.set_version_flag("--version", std::string("plabd ") + PLAB_VERSION);
    WrittenOptions written;
    add_run_options(app, options, written);
    add_task_options(app, options, written);
    app.add_flag("--paused", options.paused, "wait before the first step until a client sends resume or step");
    add_bus_options(app, options, written.states, written.no_bus);
    add_ros_options(app, options);
    add_record_options(app, options, written.recorded_states);
    add_past_options(app, options);
    if (auto end = program::parse_command_line(app, argc, argv, PLAB_VERSION, &completion::scene_values)) return end;
    options.scene = program::file_or_installed(options.scene);
    std::string why = take_task(app.count("--reference") > 0, written, options);
    if (why.empty()) why = take_bus_options(written.states, written.no_bus, options);
    if (why.empty()) why = take_past_options(app, written.recorded_states, options);
    if (why.empty()) why = take_ros_options(app, options);
    if (why.empty() && options.paused && !options.bus) why = "--paused needs the bus: without it, no client could resume the run";
    if (why.empty()) why = take_operations(written, options);
    if (!why.empty()) return ParseEnd{2, "plabd: " + why + "\n"};
    return {};
}

}  // namespace plab::daemon
