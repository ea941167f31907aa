/// plabctl: queries and controls a running plabd.
#include <cstdio>

#include "control/completion_values.h"
#include "control/live/commands.h"
#include "control/recording/commands.h"
#include "control/topics/topics.h"
#include "link/numbers.h"
#include "program/interruption.h"

namespace
{

using namespace plab::cli;

constexpr const char* kExamples = R"(Examples:
  plabctl servers                                    list the servers
  plabctl interactions                               algorithm, cost and error of each
  plabctl swap contact.response --to Response/None   exchange an algorithm while it runs
  plabctl set red.mass=0.03 --at 600                 before step 600
  plabctl watch events -n 10 --json                  ten events, one JSON object per line
  plabctl show contact                               everything known about a component
)";

constexpr const char* kExitCodes = R"(
Exit codes: 0 done, 1 failed, 2 usage, 3 no server or time-out, 4 refused with the reason,
5 lost (recover, record), 130 Ctrl-C, 143 SIGTERM.
Environment: PLAB_SERVER, PLAB_DOMAIN, PLAB_INTERFACE, NO_COLOR; CYCLONEDDS_URI wins over --interface.
)";

void add_global_options(const Command& app, Settings& s)
{
    app.add_option("-s,--server", s.link.server, "name of the server; default: the only one in the domain").type_name("NAME");
    app.add_option("--domain", s.link.domain.id, "DDS domain, 0 to 232").between(0, 232).type_name("N");
    app.add_option("--interface", s.link.domain.network_interface, "network interface; default: this host only").type_name("NAME");
    app.add_option("--timeout", s.timeout, "how long to wait for a server and a reply; default 5 (wait: 30, servers: 0.5)")
        .check(plab::link::check_positive)
        .type_name("SECONDS");
    app.add_flag("--progress", s.progress,
                 "print the progress of long work every five seconds on standard error, even if that is not a terminal");
    app.add_flag("--json", s.json, "print one JSON object; for streams, one per line");
    app.add_option("--color", s.color, "auto, always or never").one_of({"auto", "always", "never"}).type_name("WHEN");
    app.add_option("-n,--count", s.count, "end a stream after this many samples").check(plab::link::check_count).type_name("N");
    app.add_option("-d,--duration", s.duration, "end a stream after this time").check(plab::link::check_positive).type_name("SECONDS");
}

}  // namespace

int main(int argc, char** argv)
{
    const CommandLine line({"plabctl", "plabctl: queries and controls a running plabd", PLAB_VERSION, kExamples, kExitCodes,
                            "\nGlobal options (--server, --json, --timeout ..): plabctl --help\n"});
    Context context;
    auto environment = plab::link::options_from_environment();
    if (environment) context.settings.link = *environment;
    add_global_options(line.root(), context.settings);
    for (const auto add : {add_list_commands, add_level_commands, add_top_command, add_show_command, add_watch_command, add_scene_commands,
                           add_people_commands, add_clock_commands, add_past_commands, add_wait_command, add_topics_command,
                           add_file_commands, add_diff_command, add_view_commands, add_record_command, add_play_command})
        add(line.root(), context);
    const auto values = [&](const plab::program::Wanted& wanted) { return completion_values(wanted, context.settings.link); };
    if (const auto end = line.parse(argc, argv, values))
    {
        const bool is_written = std::fputs(end->text.c_str(), end->exit_code == 0 ? stdout : stderr) >= 0;
        return is_written ? end->exit_code : static_cast<int>(Exit::Failed);
    }
    context.console = Console::make(context.settings.color);
    if (!environment) return static_cast<int>(context.fail(Exit::Usage, environment.errors()));
    if (!context.action) return static_cast<int>(context.fail(Exit::Usage, "needs a command; see plabctl --help"));
    const std::string& server = context.settings.link.server;
    if (!server.empty() && !plab::wire::is_server_name(server))
        return static_cast<int>(
            context.fail(Exit::Usage, "'" + server + "' is not a valid server name: use 1 to 64 letters, digits, '.', '_' or '-'"));
    plab::program::catch_signals();
    const Exit code = context.action(context);
    const bool is_flushed = context.console.flush();
    if (code == Exit::Interrupted) return plab::program::code_of_interruption();
    return is_flushed || code != Exit::Done ? static_cast<int>(code) : static_cast<int>(Exit::Failed);
}
