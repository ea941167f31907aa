#include "logger/options.h"

#include <CLI/CLI.hpp>

#include "completion/server_values.h"
#include "link/numbers.h"
#include "program/command_line.h"

namespace plab::logger
{
namespace
{

constexpr const char* kExamples =
    "Examples:\n"
    "  plab-log                                print everything that happens, line by line, until Ctrl-C\n"
    "  plab-log --json --out run.jsonl         as lines of JSON, appended to a file\n"
    "  plab-log --kind collision.impact -n 10  the next ten impacts\n"
    "  plab-log --severity warning             trouble only\n"
    "  plab-log --metrics --status             cost, error and energy, and the server's state, as well\n"
    "\n"
    "Kinds are \"collision.begin\", \".impact\", \".rest\", \".end\", and those of events: \"script.print\", \"request.swap\", ...\n"
    "If the server ends, plab-log waits for it to come back; a separate line reports missed entries. Exit codes: 0 done, 1 cannot write,\n"
    "2 wrong usage, 3 no server, 130 Ctrl-C, 143 SIGTERM.";

void add_options(CLI::App& app, LoggerOptions& options, std::string& severity)
{
    app.add_option("--server", options.link.server, "name of the server; without it, the only one (PLAB_SERVER)");
    app.add_option("--domain", options.link.domain.id, "DDS domain, 0 to 232 (PLAB_DOMAIN)")->check(CLI::Range(0, 232));
    app.add_option("--interface", options.link.domain.network_interface, "network interface instead of loopback (PLAB_INTERFACE)");
    app.add_option("--timeout", options.timeout, "seconds to wait for the server; 0: wait without limit")
        ->check(link::check_not_negative)
        ->capture_default_str();
    app.add_flag("--json", options.json, "one JSON object per line");
    app.add_option("--out", options.out, "file to append to instead of standard output");
    app.add_flag("--metrics", options.metrics, "also log metrics");
    app.add_flag("--status", options.status, "also log the server's state");
    app.add_option("--kind", options.filter.kinds, "only kinds with this prefix; \"collision\" for all collisions")
        ->allow_extra_args(false);
    app.add_option("--object", options.filter.objects, "only entries that refer to this component")->allow_extra_args(false);
    app.add_option("--severity", severity, "minimum severity: info, warning, failure; collisions are info")
        ->check(CLI::IsMember({"info", "warning", "failure"}));
    app.add_option("-n,--count", options.count, "end after this many entries")->check(link::check_count);
    app.add_option("-d,--duration", options.duration, "end after this many seconds")->check(link::check_positive);
}

}  // namespace

std::optional<program::ParseEnd> parse_options(int argc, const char* const* argv, LoggerOptions& options)
{
    if (auto from_environment = link::options_from_environment(); from_environment)
        options.link = from_environment.take();
    else
        return program::ParseEnd{2, "plab-log: " + from_environment.error().text() + "\n"};
    std::string severity = "info";
    CLI::App app("Logs what happens in a pLab server: events and collisions, as lines.", "plab-log");
    app.footer(kExamples);
    app.set_version_flag("--version", std::string("plab-log ") + PLAB_VERSION);
    add_options(app, options, severity);
    const auto values = [&](const program::Wanted& wanted) { return completion::common_values(wanted, options.link); };
    if (auto end = program::parse_command_line(app, argc, argv, PLAB_VERSION, values)) return end;
    options.filter.severity = severity_of(severity);
    return {};
}

}  // namespace plab::logger
