#include "plugins/manifest.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "plugins/manifest_text.h"

namespace plab::plugins
{
namespace
{

namespace fs = std::filesystem;

Error at_line(const std::string& path, std::size_t line, std::string why)
{
    return Error{{path, static_cast<std::uint32_t>(line), 1}, {}, std::move(why)};
}

}  // namespace

Result<Manifest> read_manifest(const std::string& path)
{
    std::ifstream in(path);
    std::string line;
    if (!in || !std::getline(in, line)) return Error{{path, 0, 0}, {}, "cannot be read"};
    if (line != kManifestHeader)
        return at_line(path, 1, "is not a manifest of this version: the first line must be '" + std::string(kManifestHeader) + "'");
    ManifestReader reader;
    for (std::size_t n = 2; std::getline(in, line); ++n)
        if (const auto added = reader.add(line); !added) return at_line(path, n, added.error().reason);
    auto types = reader.finish();
    if (!types) return Error{{path, 0, 0}, {}, types.error().reason};
    Manifest out;
    out.path = path, out.plugin = fs::path(path).replace_extension(".so").string();
    out.summaries = types.take();
    for (const model::TypeSummary& type : out.summaries) out.types.push_back(type.name);
    return out;
}

Result<void> write_manifest(const std::string& path, const std::string& plugin, std::vector<model::TypeSummary> types)
{
    std::sort(types.begin(), types.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    const std::string draft = path + ".tmp";
    {
        std::ofstream out(draft, std::ios::trunc);
        out << kManifestHeader << '\n' << manifest_lines(plugin, types);
        out.close();
        if (!out)
        {
            std::remove(draft.c_str());
            return Error{{draft, 0, 0}, {}, "cannot be written"};
        }
    }
    std::error_code failed;
    fs::rename(draft, path, failed);
    if (!failed) return {};
    std::remove(draft.c_str());
    return Error{{path, 0, 0}, {}, "cannot be written: " + failed.message()};
}

std::vector<Manifest> find_manifests(const std::string& directory, Errors& problems)
{
    std::error_code failed;
    std::vector<std::string> paths;
    for (fs::directory_iterator it(directory, failed), last; !failed && it != last; it.increment(failed))
        if (it->path().extension() == ".manifest") paths.push_back(it->path().string());
    if (failed) problems.push_back({{}, {}, "plugin folder " + directory + " cannot be read: " + failed.message()});
    std::sort(paths.begin(), paths.end());  // the order of directory entries is unspecified

    std::vector<Manifest> out;
    for (const std::string& path : paths)
        if (auto manifest = read_manifest(path); manifest.ok())
            out.push_back(manifest.take());
        else
            problems.push_back(manifest.error());
    return out;
}

}  // namespace plab::plugins
