/// plab-web: a page for browsers that shows and steers a running scene.
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>

#include "program/interruption.h"
#include "web/desk.h"
#include "web/http_server.h"
#include "web/options.h"

using namespace plab;

namespace
{

int fail(const Error& error)
{
    std::fprintf(stderr, "plab-web: %s\n", error.text().c_str());
    return 1;
}

/// Only its owner may read it: the address is the right to do everything.
Result<void> write_address(const std::string& file, const std::string& url)
{
    (void)unlink(file.c_str());
    constexpr int kMode = 0600;
    const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kMode);
    const std::string line = url + "\n";
    const bool is_written = fd >= 0 && write(fd, line.data(), line.size()) == static_cast<ssize_t>(line.size());
    if (fd >= 0) (void)close(fd);
    if (!is_written) return reason("cannot write '" + file + "'");
    return {};
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
    const auto server = web::HttpServer::listen(options.address, options.port, {options.hosts.begin(), options.hosts.end()}, *files, pages);
    if (!server) return fail(server.error());
    if (!options.address_file.empty())
        if (const auto written = write_address(options.address_file, (*server)->url()); !written) return fail(written.error());
    std::printf("plab-web: %s\n", (*server)->url().c_str());
    std::fflush(stdout);
    {
        const web::Desk desk(
            options.link, std::move(recordings), pages, [&] { (*server)->wake(); }, &program::is_interrupted);
        while (!program::is_interrupted()) (*server)->step();
    }
    if (!options.address_file.empty()) (void)unlink(options.address_file.c_str());
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
