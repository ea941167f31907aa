/// plab-web: a page for browsers that shows and steers a running scene.
#include <cstdio>

#include "program/interruption.h"
#include "web/desk.h"
#include "web/options.h"
#include "web/page_service.h"
#include "websocket/address_file.h"

using namespace plab;

namespace
{

int fail(const Error& error)
{
    std::fprintf(stderr, "plab-web: %s\n", error.text().c_str());
    return 1;
}

int serve(const web::WebOptions& options)
{
    const auto files = web::PageFiles::load(options.page.empty() ? web::page_folder() : options.page);
    if (!files) return fail(files.error());
    std::optional<web::Recordings> recordings;
    if (!options.recordings.empty())
    {
        constexpr double kMegabyte = 1e6;
        auto folder = web::Recordings::open(options.recordings, static_cast<std::uint64_t>(options.recordings_limit * kMegabyte));
        if (!folder) return fail(folder.error());
        recordings.emplace(folder.take());
    }
    web::Pages pages;
    web::NewestFigures figures;
    web::PageService service(*files, pages, figures);
    const auto server =
        websocket::Server::listen(web::page_server(options.address, options.port, {options.hosts.begin(), options.hosts.end()}), service);
    if (!server) return fail(server.error());
    const std::string url = (*server)->url("http");
    const auto address = websocket::AddressFile::write(options.address_file, url);
    if (!address) return fail(address.error());
    std::printf("plab-web: %s\n", url.c_str());
    std::fflush(stdout);
    {
        const web::Desk desk(
            options.link, std::move(recordings), pages, figures, [&] { (*server)->wake(); }, &program::is_interrupted);
        while (!program::is_interrupted()) (*server)->step();
    }
    return program::code_of_interruption();
}

}  // namespace

int main(int argc, char** argv)
{
    program::catch_signals();
    web::WebOptions options;
    if (const auto end = web::parse_options(argc, argv, options))
    {
        std::fputs(end->text.c_str(), end->exit_code == 0 ? stdout : stderr);
        return end->exit_code;
    }
    return serve(options);
}
