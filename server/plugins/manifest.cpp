#include "plugins/manifest.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace plab::plugins
{
namespace
{

namespace fs = std::filesystem;

constexpr std::size_t kMostTypes = 10'000;
constexpr std::size_t kLongestName = 200;

bool is_type_name(std::string_view name)
{
    const auto fits = [](char c)
    { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '/'; };
    return !name.empty() && name.size() <= kLongestName && name.front() != '/' && name.back() != '/' &&
           std::all_of(name.begin(), name.end(), fits);
}

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
        return at_line(path, 1, "is no manifest of this version: the first line must be '" + std::string(kManifestHeader) + "'");
    Manifest out;
    out.path = path, out.plugin = fs::path(path).replace_extension(".so").string();
    for (std::size_t n = 2; std::getline(in, line); ++n)
    {
        if (line.empty()) continue;
        if (!is_type_name(line)) return at_line(path, n, "is no type name; letters, digits, '_' and '/' are allowed");
        if (out.types.size() >= kMostTypes) return at_line(path, n, "more than " + std::to_string(kMostTypes) + " types");
        out.types.push_back(line);
    }
    std::sort(out.types.begin(), out.types.end());
    if (const auto twice = std::adjacent_find(out.types.begin(), out.types.end()); twice != out.types.end())
        return Error{{path, 0, 0}, {}, "names " + *twice + " twice"};
    return out;
}

Result<void> write_manifest(const std::string& path, std::vector<std::string> types)
{
    std::sort(types.begin(), types.end());
    const std::string draft = path + ".tmp";
    {
        std::ofstream out(draft, std::ios::trunc);
        out << kManifestHeader << '\n';
        for (const std::string& type : types) out << type << '\n';
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
    std::sort(paths.begin(), paths.end());  // the system's order is any order

    std::vector<Manifest> out;
    for (const std::string& path : paths)
        if (auto manifest = read_manifest(path); manifest.ok())
            out.push_back(manifest.take());
        else
            problems.push_back(manifest.error());
    return out;
}

}  // namespace plab::plugins
