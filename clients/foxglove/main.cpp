/// plab-foxglove: a running scene, or a recording, for Foxglove, Lichtblick and other clients of Foxglove's web socket.
#include <unistd.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "foxglove/feed.h"
#include "foxglove/options.h"
#include "foxglove/services.h"
#include "program/interruption.h"
#include "websocket/address_file.h"

using namespace plab;

namespace
{

int fail(const Error& error)
{
    std::fprintf(stderr, "plab-foxglove: %s\n", error.text().c_str());
    return 1;
}

/// What a client hears first.
std::vector<websocket::MessagePtr> greeting_of(const foxglove::FoxgloveOptions& options, const foxglove::Playback* playback)
{
    foxglove::Offer offer;
    offer.name = "pLab " PLAB_VERSION;
    offer.session = websocket::make_token();  // another process is another session
    offer.writes = !options.read_only && playback == nullptr;
    if (playback != nullptr) offer.playback = playback->range();
    std::vector<websocket::MessagePtr> out{foxglove::text_message(foxglove::server_info(offer)),
                                           foxglove::text_message(foxglove::advertise_channels())};
    if (offer.writes) out.push_back(foxglove::text_message(foxglove::advertise_services()));
    return out;
}

websocket::ServerOptions server_options(const foxglove::FoxgloveOptions& options)
{
    websocket::ServerOptions out;
    out.address = options.address, out.port = options.port;
    out.access.program = "plab-foxglove";
    if (options.token || !websocket::is_loopback(options.address)) out.access.token = websocket::make_token();
    out.access.hosts = {options.hosts.begin(), options.hosts.end()};
    // The applications on the web, and pages that a program on this machine serves.
    out.access.origins = {"https://app.foxglove.dev", "https://studio.foxglove.dev", "http://localhost:*", "http://127.0.0.1:*"};
    out.access.origins.insert(options.origins.begin(), options.origins.end());
    out.access.programs = true;
    out.protocols = {"foxglove.sdk.v1", "foxglove.websocket.v1"};
    out.most_received = foxglove::kMostReceived;
    return out;
}

int serve(foxglove::FoxgloveOptions options)
{
    std::unique_ptr<foxglove::Playback> playback;
    if (!options.file.empty())
    {
        options.link.server = "playback-" + std::to_string(getpid());
        auto opened = foxglove::Playback::open(options.file, options.link.server, options.link.domain, &program::is_interrupted);
        if (!opened) return fail(opened.error());
        playback = opened.take();
    }
    foxglove::Clients clients;
    clients.set_greeting(greeting_of(options, playback.get()));
    const auto server = websocket::Server::listen(server_options(options), clients);
    if (!server) return fail(server.error());
    const std::string url = (*server)->url("ws");
    const auto address = websocket::AddressFile::write(options.address_file, url);
    if (!address) return fail(address.error());
    std::printf("plab-foxglove: %s\n", url.c_str());
    std::fflush(stdout);
    {
        const foxglove::Feed feed(
            {options.link, !options.read_only && playback == nullptr}, clients, playback.get(), [&] { (*server)->wake(); },
            &program::is_interrupted);
        while (!program::is_interrupted()) (*server)->step();
    }
    return program::code_of_interruption();
}

}  // namespace

int main(int argc, char** argv)
{
    program::catch_signals();
    foxglove::FoxgloveOptions options;
    if (const auto end = foxglove::parse_options(argc, argv, options))
    {
        std::fputs(end->text.c_str(), end->exit_code == 0 ? stdout : stderr);
        return end->exit_code;
    }
    return serve(std::move(options));
}
