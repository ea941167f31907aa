#include "completion/server_values.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

namespace plab::completion
{
namespace
{

using program::Candidate;
using program::Values;
using program::Wanted;

constexpr link::Seconds kForServer(0.4), kForCatalogue(0.4);
constexpr unsigned kAtMost = 2;  ///< s

std::vector<Candidate> servers(link::SessionOptions options)
{
    options.server.clear();
    const auto session = link::Session::join(options);
    std::vector<Candidate> out;
    if (!session) return out;
    for (const link::ServerInfo& s : session->servers(kForServer)) out.push_back({s.name, s.scene_file});
    return out;
}

std::vector<Candidate> interfaces()
{
    std::vector<Candidate> out;
    std::error_code failed;
    for (std::filesystem::directory_iterator it("/sys/class/net", failed), end; !failed && it != end; it.increment(failed))
        out.push_back({it->path().filename().string(), ""});
    return out;
}

std::vector<Candidate> cameras(const link::SessionOptions& options)
{
    std::vector<Candidate> out;
    const link::CatalogueContents now = snapshot_of(options, static_cast<link::Parts>(link::Part::Scene));
    if (now.scene)
        for (const link::Camera& camera : now.scene->cameras) out.push_back({camera.name, ""});
    return out;
}

}  // namespace

void limit_time() { alarm(kAtMost); }

link::SessionOptions options_on(const Wanted& wanted, link::SessionOptions options)
{
    if (const std::string given = wanted.first("--server"); !given.empty()) options.server = given;
    if (const std::string given = wanted.first("--interface"); !given.empty()) options.domain.network_interface = given;
    if (const std::string given = wanted.first("--domain"); !given.empty() && given.find_first_not_of("0123456789") == std::string::npos)
        options.domain.id = static_cast<std::uint32_t>(std::strtoul(given.c_str(), nullptr, 10));
    return options;
}

link::CatalogueContents snapshot_of(const link::SessionOptions& options, link::Parts parts)
{
    const auto session = link::Session::find(options, kForServer);
    if (!session) return {};
    auto catalogue = link::Catalogue::open(*session, parts | link::Part::Server);
    if (!catalogue) return {};
    (void)catalogue->fetch(kForCatalogue);  // what came in time is worth telling
    return catalogue->now();
}

std::vector<Candidate> ids_in(const link::CatalogueContents& now)
{
    std::vector<Candidate> out;
    for (const auto& [id, o] : now.objects) out.push_back({id, o.type_name});
    for (const auto& [id, i] : now.interactions) out.push_back({id, i.type_name});
    return out;
}

Values common_values(const Wanted& wanted, const link::SessionOptions& given)
{
    limit_time();
    const link::SessionOptions options = options_on(wanted, given);
    const std::string& option = wanted.option;
    Values out;
    if (option == "--server")
        out.candidates = servers(options);
    else if (option == "--interface")
        out.candidates = interfaces();
    else if (option == "--object" || option == "--track")
        out.candidates = ids_in(snapshot_of(options, link::Part::Objects | link::Part::Interactions));
    else if (option == "--camera")
        out.candidates = cameras(options);
    else
        out.are_files =
            wanted.value.find("FILE") != std::string::npos || wanted.value == "PATH" || wanted.value == "DIR" || option == "--out";
    return out;
}

}  // namespace plab::completion
