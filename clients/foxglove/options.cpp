#include "foxglove/options.h"

#include <CLI/CLI.hpp>

#include "completion/server_values.h"

namespace plab::foxglove
{
namespace
{

constexpr const char* kExamples = R"(Examples:
  plab-foxglove                              then, in Foxglove or Lichtblick: Open connection, Foxglove WebSocket, ws://localhost:8765
  plab-foxglove --file run.mcap              plays a recording, with the controls of the program that shows it
  plab-foxglove --read-only --origin https://studio.example
  plab-foxglove --listen 192.0.2.7           for other machines: the address gets a token, and whoever has it may do everything

Environment: PLAB_SERVER, PLAB_DOMAIN, PLAB_INTERFACE replace the options of these names.
Exit codes: 0 done, 1 cannot listen or read the recording, 2 wrong usage, 130 Ctrl-C, 143 SIGTERM.)";

void add_options(CLI::App& app, FoxgloveOptions& options)
{
    app.add_option("--port", options.port, "port to listen on; 0: any that is free")->check(CLI::Range(0, 65535))->capture_default_str();
    app.add_option("--listen", options.address, "address to listen on; the default is reached from this machine only")
        ->type_name("ADDRESS")
        ->capture_default_str();
    app.add_option("--host", options.hosts, "one more name by which clients reach it (may be repeated)")
        ->type_name("NAME")
        ->allow_extra_args(false);
    app.add_option("--origin", options.origins, "one more page that may connect, https://studio.example (may be repeated)")
        ->type_name("ORIGIN")
        ->allow_extra_args(false);
    app.add_flag("--token", options.token, "ask for a random token in the address, on this machine as well");
    app.add_flag("--read-only", options.read_only, "offer neither services nor the setting of parameters");
    app.add_option("--file", options.file, "play this recording instead of showing a server")->type_name("FILE")->check(CLI::ExistingFile);
    app.add_option("--write-address", options.address_file, "write the address to a file that only its owner can read")->type_name("FILE");
    app.add_option("--server", options.link.server, "name of the server; without it, the only one (PLAB_SERVER)")->type_name("NAME");
    app.add_option("--domain", options.link.domain.id, "DDS domain (PLAB_DOMAIN)")->check(CLI::Range(0, 232));
    app.add_option("--interface", options.link.domain.network_interface,
                   "network interface to find the server on, instead of loopback (PLAB_INTERFACE)")
        ->type_name("NAME");
}

}  // namespace

std::optional<program::ParseEnd> parse_options(int argc, const char* const* argv, FoxgloveOptions& options)
{
    auto environment = link::options_from_environment();
    if (!environment) return program::ParseEnd{2, "plab-foxglove: " + environment.error().text() + "\n"};
    options.link = environment.take();
    CLI::App app("plab-foxglove: shows and steers a running scene, or plays a recording, in Foxglove and Lichtblick", "plab-foxglove");
    app.footer(kExamples);
    app.set_version_flag("--version", std::string("plab-foxglove ") + PLAB_VERSION);
    add_options(app, options);
    const auto values = [&](const program::Wanted& wanted) { return completion::common_values(wanted, options.link); };
    return program::parse_command_line(app, argc, argv, PLAB_VERSION, values);
}

}  // namespace plab::foxglove
