#include "web/options.h"

#include <CLI/CLI.hpp>

#include "completion/server_values.h"

namespace plab::web
{
namespace
{

constexpr const char* kExamples = R"(Examples:
  plab-web                                    print an address; open it in a browser on this machine
  plab-web --server lab --port 8080
  plab-web --recordings runs                  pages may record, and play what is in the folder
  plab-web --listen 192.0.2.7 --host lab.example    for other machines: whoever has the address may do everything

The address has a random token, which is new with each start. It stays valid when the server ends: the page waits for it to come back.

Environment: PLAB_SERVER, PLAB_DOMAIN, PLAB_INTERFACE replace the options of these names.
Exit codes: 0 done, 1 cannot listen or the page is missing, 2 wrong usage, 130 Ctrl-C, 143 SIGTERM.)";

void add_options(CLI::App& app, WebOptions& options)
{
    app.add_option("--port", options.port, "port to listen on; 0: any that is free")->check(CLI::Range(0, 65535))->capture_default_str();
    app.add_option("--listen", options.address, "address to listen on; the default is reached from this machine only")
        ->type_name("ADDRESS")
        ->capture_default_str();
    app.add_option("--host", options.hosts, "one more name by which browsers reach it (may be repeated)")
        ->type_name("NAME")
        ->allow_extra_args(false);
    app.add_option("--page", options.page, "folder of the page; default: the one that was built with this program")->type_name("DIR");
    app.add_option("--write-address", options.address_file, "write the page's address to a file that only its owner can read")
        ->type_name("FILE");
    app.add_option("--recordings", options.recordings, "folder to which pages may record, and from which they play; default: they may not")
        ->type_name("DIR");
    app.add_option("--recordings-limit", options.recordings_limit, "MB that all recordings there may have; a recording ends at it")
        ->check(CLI::Range(1.0, 1e9))
        ->type_name("MB")
        ->capture_default_str();
    app.add_option("--server", options.link.server, "name of the server; without it, the only one (PLAB_SERVER)")->type_name("NAME");
    app.add_option("--domain", options.link.domain.id, "DDS domain (PLAB_DOMAIN)")->check(CLI::Range(0, 232));
    app.add_option("--interface", options.link.domain.network_interface,
                   "network interface to find the server on, instead of loopback (PLAB_INTERFACE)")
        ->type_name("NAME");
}

}  // namespace

std::optional<program::ParseEnd> parse_options(int argc, const char* const* argv, WebOptions& options)
{
    auto environment = link::options_from_environment();
    if (!environment) return program::ParseEnd{2, "plab-web: " + environment.error().text() + "\n"};
    options.link = environment.take();
    CLI::App app("plab-web: shows and steers a running scene in a browser", "plab-web");
    app.footer(kExamples);
    app.set_version_flag("--version", std::string("plab-web ") + PLAB_VERSION);
    add_options(app, options);
    const auto values = [&](const program::Wanted& wanted) { return completion::common_values(wanted, options.link); };
    return program::parse_command_line(app, argc, argv, PLAB_VERSION, values);
}

}  // namespace plab::web
