#include <chrono>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "control/console/json.h"
#include "control/console/table.h"
#include "control/live/commands.h"
#include "control/live/local_server.h"
#include "control/live/request.h"
#include "link/catalogue.h"
#include "link/numbers.h"

namespace plab::cli
{
namespace
{

using Clock = std::chrono::steady_clock;

/// s: a branch has to load plugins and the state.
constexpr double kStart = 30;

/// A snapshot as received from the bus.
struct SnapshotSample
{
    std::int64_t step = 0;
    double time = 0;
    std::vector<std::uint8_t> data;
};

/// Waits for a snapshot for which `is_it` holds.
Result<SnapshotSample> await_snapshot(Context& c, wire::DataReader<plab_v2_Snapshot>& reader,
                                      const std::function<bool(const plab_v2_Snapshot&)>& is_it)
{
    std::optional<SnapshotSample> out;
    const auto end = link::moment_after(c.timeout());
    while (!out)
    {
        if (c.stopped()) return reason("interrupted");
        if (Clock::now() >= end)
            return reason("server '" + c.session().server() + "' does not send snapshots: it plays a recording, or its version is too old");
        (void)c.session().wait(reader, link::Seconds(0.1));
        reader.take(
            [&](const plab_v2_Snapshot& s, const dds_sample_info_t& info)
            {
                if (!info.valid_data || out || !is_it(s)) return;
                out.emplace(SnapshotSample{s.step, s.time, {s.data._buffer, s.data._buffer + s.data._length}});
            });
    }
    return *std::move(out);
}

/// The current state: a new reader of the topic gets one.
Result<SnapshotSample> present(Context& c)
{
    auto reader = c.session().reader<plab_v2_Snapshot>();
    if (!reader) return reader.errors();
    return await_snapshot(c, *reader, [](const plab_v2_Snapshot&) { return true; });
}

Exit write_file(Context& c, const SnapshotSample& snapshot, const std::string& file)
{
    std::ofstream out(file, std::ios::binary | std::ios::trunc);
    out.write(reinterpret_cast<const char*>(snapshot.data.data()), static_cast<std::streamsize>(snapshot.data.size()));
    out.close();
    if (!out) return c.fail(Exit::Failed, "cannot write " + file);
    if (!c.settings.json)
        c.console.out("step " + std::to_string(snapshot.step) + ", " + std::to_string(snapshot.data.size()) + " bytes: " + file + "\n");
    return Exit::Done;
}

// ---- snapshot -------------------------------------------------------------------------------------------------------

struct SnapshotOptions
{
    std::string name, file;
    Timing timing;
};

Exit run_snapshot(Context& c, const SnapshotOptions& o)
{
    if (!wire::is_server_name(o.name))
        return c.fail(Exit::Usage, "'" + o.name + "' is not a valid snapshot name: use 1 to 64 letters, digits, '.', '_' or '-'");
    if (o.file.empty()) return send(c, {{"snapshot", o.name}}, o.timing);
    if (const Exit e = c.connect(); e != Exit::Done) return e;
    auto reader = c.session().reader<plab_v2_Snapshot>();
    if (!reader) return c.fail(Exit::Failed, reader.errors());
    // The first one shows that the server knows this reader, so that the requested one will arrive too.
    if (auto first = await_snapshot(c, *reader, [](const plab_v2_Snapshot&) { return true; }); !first)
        return c.fail(Exit::NoServer, first.errors());
    if (const Exit e = send(c, {{"snapshot", o.name}}, o.timing); e != Exit::Done) return e;
    auto snapshot = await_snapshot(c, *reader, [&](const plab_v2_Snapshot& s) { return o.name == s.name; });
    if (!snapshot) return c.fail(Exit::NoServer, snapshot.errors());
    return write_file(c, *snapshot, o.file);
}

void add_snapshot(const Command& app, Context& context)
{
    auto o = std::make_shared<SnapshotOptions>();
    const Command command = add_command(app, context,
                                        {"snapshot", "keep the current state on the server under a name",
                                         "  plabctl snapshot before\n  plabctl snapshot s600 --at 600\n"
                                         "  plabctl snapshot before -o before.snapshot && plabd --load before.snapshot\n"},
                                        [o](Context& c) { return run_snapshot(c, *o); });
    command.add_option("name", o->name, "name of the snapshot; an existing one of that name is replaced").required().type_name("NAME");
    command.add_option("-o,--out", o->file, "also write it to a file").type_name("FILE");
    add_timing(command, o->timing);
}

// ---- snapshots ------------------------------------------------------------------------------------------------------

Exit run_snapshots(Context& c)
{
    if (const Exit e = c.connect(); e != Exit::Done) return e;
    auto catalogue = link::Catalogue::open(c.session(), 0);
    if (!catalogue) return c.fail(Exit::Failed, catalogue.errors());
    if (auto fetched = catalogue->fetch(c.timeout(), c.stop()); !fetched) return c.fail(Exit::NoServer, fetched.errors());
    const link::ServerInfo& server = *catalogue->now().server;
    if (c.settings.json)
    {
        const Json all = json_of(server);
        print(c.console, Json{{"server", server.name}, {"snapshots", all["snapshots"]}, {"rewind_from", all["rewind_from"]}});
        return Exit::Done;
    }
    Table table({{"NAME", Align::Left, Shrink::Middle},
                 {"RUN", Align::Right},
                 {"STEP", Align::Right},
                 {"TIME", Align::Right},
                 {"KB", Align::Right}});
    for (const auto& s : server.snapshots)
        table.add({s.name, std::to_string(s.run), std::to_string(s.step), exact_number(s.time) + " s",
                   number(static_cast<double>(s.bytes) / 1024)});
    if (!table.empty()) table.print(c.console);
    c.console.out(server.rewind_from < 0 ? "cannot be rewound: it keeps no history\n"
                                         : "can be rewound to " + exact_number(server.rewind_from) + " s and later\n");
    return Exit::Done;
}

// ---- rewind ---------------------------------------------------------------------------------------------------------

/// The server parses units ("500 ms"); only texts that cannot be a time or duration are refused here.
std::string not_a_time(const std::string& text)
{
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string::npos) return "a time is missing: give seconds, 0 or more";
    if (text[first] != '-') return {};
    return "'" + text + "' is negative: --to takes a time of the run, --by a duration to go back; both in s, 0 or more";
}

void add_rewind(const Command& app, Context& context)
{
    struct RewindOptions
    {
        std::string to, by;
    };
    auto o = std::make_shared<RewindOptions>();
    const Command command = add_command(app, context,
                                        {"rewind", "go back to an earlier time of this run; everything later is discarded",
                                         "  plabctl rewind --to 3\n  plabctl rewind --by 0.5\n"},
                                        [o](Context& c)
                                        {
                                            if (o->to.empty() == o->by.empty())
                                                return c.fail(Exit::Usage, "rewind needs --to TIME or --by TIME");
                                            return send(c, {{"rewind", "", o->to.empty() ? "back " + o->by : o->to}});
                                        });
    command.add_option("--to", o->to, "simulated time, s").check(&not_a_time).type_name("TIME");
    command.add_option("--by", o->by, "how far back, s").check(&not_a_time).type_name("TIME");
}

void add_named(const Command& app, Context& context, const CommandText& text)
{
    struct NameOptions
    {
        std::string name;
        Timing timing;
    };
    auto o = std::make_shared<NameOptions>();
    const Command command = add_command(app, context, text,
                                        [o, verb = text.name](Context& c) {
                                            return send(c, {{verb, o->name}}, o->timing);
                                        });
    command.add_option("name", o->name, "the snapshot").required().type_name("NAME");
    add_timing(command, o->timing);
}

// ---- branch ---------------------------------------------------------------------------------------------------------

struct BranchOptions
{
    std::string name, log;
    std::vector<std::string> arguments;
    bool paused = false, attached = false;
};

/// Until the new server appears on the bus, or has ended with a code.
Exit await_server(Context& c, int process, const BranchOptions& o, const std::function<std::optional<int>()>& ended)
{
    const std::string see = o.log.empty() ? "" : "; see " + o.log;
    const auto end = link::moment_after(c.timeout(kStart));
    for (;;)
    {
        for (const link::ServerInfo& s : c.session().all_servers(link::Seconds(0.2)))
            if (s.name == o.name && s.process == process)
            {
                if (c.settings.json)
                    print(c.console, Json{{"server", s.name}, {"process", s.process}, {"step", s.step}, {"time", s.time}, {"log", o.log}});
                else
                    c.console.out("server '" + s.name + "' continues from step " + std::to_string(s.step) +
                                  ", t = " + exact_number(s.time) + " s; process " + std::to_string(process) +
                                  (o.log.empty() ? "; Ctrl-C ends it" : ", log " + o.log) + "\n");
                return Exit::Done;
            }
        if (const auto code = ended()) return c.fail(Exit::Failed, "the branch ended with code " + std::to_string(*code) + see);
        if (c.stopped()) return Exit::Interrupted;
        if (Clock::now() >= end) return c.fail(Exit::NoServer, "the branch did not appear on the bus" + see);
    }
}

Exit run_detached(Context& c, const BranchOptions& o, const std::vector<std::string>& arguments)
{
    auto process = start_server(arguments, o.log);
    if (!process) return c.fail(Exit::Failed, process.errors());
    const auto ended = [&]() -> std::optional<int>
    {
        const Life life = life_of(*process);
        return life.runs ? std::nullopt : std::optional(life.code);
    };
    return await_server(c, *process, o, ended);
}

/// Until the branch has ended, or this program is to end: then the branch does so too. `snapshot` is not needed once it is there.
Exit run_attached(Context& c, const BranchOptions& o, const std::vector<std::string>& arguments, std::optional<TemporaryFile> snapshot)
{
    constexpr std::chrono::milliseconds kNap(50);
    auto server = start_attached_server(arguments);
    if (!server) return c.fail(Exit::Failed, server.errors());
    if (const Exit e = await_server(c, server->process(), o, [&] { return server->exit_code(); }); e != Exit::Done) return e;
    (void)c.console.flush();
    snapshot.reset();
    while (!server->exit_code())
    {
        if (c.stopped()) return Exit::Interrupted;
        std::this_thread::sleep_for(kNap);
    }
    return *server->exit_code() == 0 ? Exit::Done
                                     : c.fail(Exit::Failed, "the branch ended with code " + std::to_string(*server->exit_code()));
}

Exit run_branch(Context& c, BranchOptions o)
{
    if (!wire::is_server_name(o.name))
        return c.fail(Exit::Usage, "'" + o.name + "' is not a valid server name: use 1 to 64 letters, digits, '.', '_' or '-'");
    if (o.attached && !o.log.empty()) return c.fail(Exit::Usage, "--attached logs to standard error: leave out --log");
    if (const Exit e = c.connect(); e != Exit::Done) return e;
    auto snapshot = present(c);
    if (!snapshot) return c.fail(Exit::NoServer, snapshot.errors());
    auto file = TemporaryFile::write(snapshot->data.data(), snapshot->data.size());
    if (!file) return c.fail(Exit::Failed, file.errors());
    if (o.log.empty() && !o.attached) o.log = "plabd-" + o.name + ".log";
    std::vector<std::string> arguments{"--load", file->path(), "--name", o.name};
    arguments.insert(arguments.end(), {"--domain", std::to_string(c.settings.link.domain.id)});
    if (const std::string& network = c.settings.link.domain.network_interface; !network.empty())
        arguments.insert(arguments.end(), {"--interface", network});
    if (o.paused) arguments.emplace_back("--paused");
    arguments.insert(arguments.end(), o.arguments.begin(), o.arguments.end());
    // The snapshot's file is removed when the branch has appeared, or has ended.
    return o.attached ? run_attached(c, o, arguments, file.take()) : run_detached(c, o, arguments);
}

void add_branch(const Command& app, Context& context)
{
    auto o = std::make_shared<BranchOptions>();
    const Command command = add_command(app, context,
                                        {"branch", "start a second server, with its own name, that continues from the current state",
                                         "  plabctl branch b && plabctl --server b swap contact.response --to Response/None\n"
                                         "  plabctl branch slow --paused\n  plabctl --server b shutdown\n"},
                                        [o](Context& c) { return run_branch(c, *o); });
    command.add_option("name", o->name, "of the new server").required().type_name("NAME");
    command.add_flag("--paused", o->paused, "pause it before its first step");
    command.add_flag("--attached", o->attached, "stay, and end it with this command: at Ctrl-C, or if this command is killed");
    command.add_option("--log", o->log, "where its log goes; default: plabd-NAME.log").type_name("FILE");
    command.add_option("--plabd", o->arguments, "one more argument for plabd (may be repeated)").repeated().type_name("ARGUMENT");
}

// ---- shadow ---------------------------------------------------------------------------------------------------------

void add_shadow(const Command& app, Context& context)
{
    struct ShadowOptions
    {
        std::string id, type;
        std::string seconds = "1";
    };
    auto o = std::make_shared<ShadowOptions>();
    const auto run = [o](Context& c)
    {
        if (const Exit e = c.connect(); e != Exit::Done) return e;
        auto snapshot = present(c);
        if (!snapshot) return c.fail(Exit::NoServer, snapshot.errors());
        auto file = TemporaryFile::write(snapshot->data.data(), snapshot->data.size());
        if (!file) return c.fail(Exit::Failed, file.errors());
        std::vector<std::string> arguments{"--load", file->path(), "--shadow", o->id + "=" + o->type, "--for", o->seconds};
        if (c.settings.json) arguments.emplace_back("--json");
        if (c.settings.progress) arguments.emplace_back("--progress");
        auto code = run_plabd(arguments, c.stop());
        if (!code) return c.fail(Exit::Failed, code.errors());
        if (c.stopped()) return Exit::Interrupted;
        return *code == 0 ? Exit::Done : Exit::Failed;
    };
    const Command command = add_command(app, context,
                                        {"shadow", "preview a swap: simulate the scene with and without it on this machine, and compare",
                                         "  plabctl shadow contact.response --with Response/None --for 2\n"},
                                        run);
    command.add_option("id", o->id, "the component").required().type_name("ID");
    command.add_option("--with", o->type, "the other type").required().type_name("TYPE");
    command.add_option("--for", o->seconds, "simulated seconds, default 1").check(link::check_positive).type_name("SECONDS");
}

/// plabctl export --mjcf: plabd, which knows the types, writes the file.
Exit export_mjcf(Context& c, const std::string& scene, const std::string& out)
{
    std::vector<std::string> arguments{"--export-mjcf", out};
    std::optional<TemporaryFile> file;
    if (!scene.empty())
        arguments.push_back(scene);
    else
    {
        if (const Exit e = c.connect(); e != Exit::Done) return e;
        auto snapshot = present(c);
        if (!snapshot) return c.fail(Exit::NoServer, snapshot.errors());
        auto written = TemporaryFile::write(snapshot->data.data(), snapshot->data.size());
        if (!written) return c.fail(Exit::Failed, written.errors());
        file.emplace(written.take());
        arguments.insert(arguments.end(), {"--load", file->path()});
    }
    auto code = run_plabd(arguments, c.stop());
    if (!code) return c.fail(Exit::Failed, code.errors());
    if (c.stopped()) return Exit::Interrupted;
    return *code == 0 ? Exit::Done : Exit::Failed;
}

}  // namespace

void add_past_commands(const Command& app, Context& context)
{
    context.export_mjcf = &export_mjcf;
    add_snapshot(app, context);
    add_command(app, context,
                {"snapshots", "list the snapshots that the server keeps, and how far it can be rewound", "  plabctl snapshots\n"},
                &run_snapshots);
    add_named(app, context, {"restore", "continue from a kept snapshot; a new run begins", "  plabctl restore before\n"});
    add_named(app, context, {"forget", "delete a kept snapshot", "  plabctl forget before\n"});
    add_rewind(app, context);
    add_branch(app, context);
    add_shadow(app, context);
}

}  // namespace plab::cli
