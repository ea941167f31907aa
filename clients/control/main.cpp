/// plabctl: queries and controls a running plabd.
#include <CLI/CLI.hpp>
#include <sstream>

#include "control/commands.h"
#include "control/completion_values.h"
#include "control/topics.h"
#include "link/names.h"
#include "link/numbers.h"
#include "program/completion.h"
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

/// Help with the examples first: most readers need no more.
class Format : public CLI::Formatter
{
public:
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override
    {
        if (mode == CLI::AppFormatMode::Sub) return make_expanded(app);
        std::ostringstream out;
        out << make_description(app) << '\n'
            << make_usage(app, name) << app->get_footer() << make_positionals(app) << make_groups(app, mode);
        out << make_subcommands(app, mode);
        out << (app->get_parent() != nullptr ? "\nGlobal options (--server, --json, --timeout ..): plabctl --help\n" : kExitCodes);
        return out.str();
    }
};

void add_global_options(CLI::App& app, Settings& s)
{
    app.set_version_flag("--version", std::string("plabctl ") + PLAB_VERSION);
    app.add_option("-s,--server", s.link.server, "name of the server; default: the only one in the domain")->type_name("NAME");
    app.add_option("--domain", s.link.domain.id, "DDS domain, 0 to 232")->check(CLI::Range(0, 232))->type_name("N");
    app.add_option("--interface", s.link.domain.network_interface, "network interface; default: this host only")->type_name("NAME");
    app.add_option("--timeout", s.timeout, "how long to wait for a server and a reply; default 5 (wait: 30, servers: 0.5)")
        ->check(plab::link::check_positive)
        ->type_name("SECONDS");
    app.add_flag("--progress", s.progress,
                 "print the progress of long work every five seconds on standard error, even if that is not a terminal");
    app.add_flag("--json", s.json, "print one JSON object; for streams, one per line");
    app.add_option("--color", s.color, "auto, always or never")->check(CLI::IsMember({"auto", "always", "never"}))->type_name("WHEN");
    app.add_option("-n,--count", s.count, "end a stream after this many samples")->check(plab::link::check_count)->type_name("N");
    app.add_option("-d,--duration", s.duration, "end a stream after this time")->check(plab::link::check_positive)->type_name("SECONDS");
}

/// What CLI11 says, and which command or option was probably meant.
std::string usage_message(const CLI::App& app, const CLI::ParseError& error)
{
    const std::vector<std::string> rest = app.remaining();
    if (rest.empty() || dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr) return error.what();
    std::vector<std::string> known;
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    const bool is_option = rest.front().starts_with("-");
    if (is_option)
    {
        for (const CLI::App* a : {&app, chosen.empty() ? &app : static_cast<const CLI::App*>(chosen.front())})
            for (const CLI::Option* option : a->get_options())
                for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    }
    else if (chosen.empty())
        for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) known.push_back(command->get_name());
    const std::string what = is_option ? "no option '" : chosen.empty() ? "no command '" : "too many arguments: '";
    return what + rest.front() + "'" + plab::link::did_you_mean(rest.front(), known);
}

int parse_error(const CLI::App& app, const CLI::ParseError& error)
{
    if (error.get_exit_code() == 0)
    {
        std::ostringstream out;
        (void)app.exit(error, out, out);
        std::cout << out.str();
        return 0;
    }
    std::cerr << "plabctl: " << printable(usage_message(app, error)) << "; see plabctl --help\n";
    return static_cast<int>(Exit::Usage);
}

}  // namespace

int main(int argc, char** argv)
{
    CLI::App app{"plabctl: queries and controls a running plabd", "plabctl"};
    app.formatter(std::make_shared<Format>());
    app.footer(kExamples);
    app.require_subcommand(0, 1);
    Context context;
    auto environment = plab::link::options_from_environment();
    if (environment) context.settings.link = *environment;
    add_global_options(app, context.settings);
    const Command commands(app);
    add_list_commands(commands, context);
    add_show_command(commands, context);
    add_watch_command(commands, context);
    add_scene_commands(commands, context);
    add_clock_commands(commands, context);
    add_past_commands(commands, context);
    add_wait_command(commands, context);
    add_topics_command(commands, context);
    add_recording_commands(commands, context);
    add_recording_views(commands, context);
    add_record_command(commands, context);
    add_play_command(commands, context);
    const auto values = [&](const plab::program::Wanted& wanted) { return completion_values(wanted, context.settings.link); };
    if (const auto answer = plab::program::answer_for_shell(app, argc, argv, PLAB_VERSION, values, kExitCodes))
        return std::fputs(answer->c_str(), stdout) < 0 ? static_cast<int>(Exit::Failed) : 0;
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& error)
    {
        return parse_error(app, error);
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
