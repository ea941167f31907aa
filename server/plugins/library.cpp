#include "plugins/library.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "model/names.h"

namespace plab::plugins
{
namespace
{

namespace fs = std::filesystem;

/// One canonical name per file, however its path was written.
std::string canonical(const std::string& path)
{
    std::error_code failed;
    const fs::path out = fs::weakly_canonical(path, failed);
    return failed ? path : out.string();
}

}  // namespace

PluginLibrary::PluginLibrary(const std::vector<std::string>& directories)
{
    std::vector<std::string> seen;
    for (const std::string& directory : directories)
    {
        const std::string folder = canonical(directory);
        if (std::find(seen.begin(), seen.end(), folder) != seen.end()) continue;
        seen.push_back(folder);
        for (Manifest& m : find_manifests(folder, problems_)) manifests_.push_back(std::move(m));
    }
    for (const Manifest& m : manifests_)
        for (const std::string& type : m.types) homes_[type].push_back(&m);
}

std::vector<std::string> PluginLibrary::default_directories()
{
    std::vector<std::string> out;
    const char* const given = std::getenv("PLAB_PLUGIN_PATH");
    const std::string path = given ? given : "";
    for (std::size_t begin = 0; begin <= path.size();)
    {
        const std::size_t end = std::min(path.find(':', begin), path.size());
        if (end > begin) out.push_back(path.substr(begin, end - begin));
        begin = end + 1;
    }
    // The plugins that were built with the program are always available: scenes that need a user's own plugin need the others
    // as well.
    if (const std::string installed = installed_plugin_directory(); !installed.empty()) out.push_back(installed);
    return out;
}

std::vector<std::string> PluginLibrary::names() const
{
    const std::lock_guard lock(mutex_);
    std::vector<std::string> out;
    for (const auto& [type, homes] : homes_) out.push_back(type);
    for (const PluginInfo& plugin : loaded_) out.insert(out.end(), plugin.types.begin(), plugin.types.end());
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

std::vector<model::TypeSummary> PluginLibrary::summaries() const
{
    const std::lock_guard lock(mutex_);
    std::vector<model::TypeSummary> out;
    for (const std::string& name : names())
    {
        if (const model::ComponentType* type = registry_.find(name))
        {
            out.push_back(model::summary_of(*type));
            continue;
        }
        const std::vector<model::TypeSummary>& known = homes_.at(name).front()->summaries;
        out.push_back(*std::lower_bound(known.begin(), known.end(), name, [](const auto& t, const std::string& n) { return t.name < n; }));
    }
    return out;
}

Error PluginLibrary::unknown(const std::string& name) const
{
    const std::vector<std::string> known = names();
    std::string why = "unknown type '" + name + "'" + model::did_you_mean(name, known);
    if (known.empty()) why += "; no plugins were found";
    for (const Error& problem : problems_) why += "; " + problem.text();
    return reason(why);
}

Result<const model::ComponentType*> PluginLibrary::require(const std::string& name)
{
    const std::lock_guard lock(mutex_);
    if (const model::ComponentType* type = registry_.find(name)) return type;
    const auto at = homes_.find(name);
    if (at == homes_.end()) return unknown(name);
    const std::vector<const Manifest*>& homes = at->second;
    if (homes.size() > 1)
        return reason("type '" + name + "' is in two plugins, " + homes[0]->plugin + " and " + homes[1]->plugin + "; remove one of them");
    if (auto plugin = load_plugin(homes[0]->plugin); !plugin) return plugin.errors();
    if (const model::ComponentType* type = registry_.find(name)) return type;
    return reason("type '" + name + "' is in " + homes[0]->path + ", but its plugin does not declare it; build the plugin again");
}

Result<PluginInfo> PluginLibrary::load_plugin(const std::string& path)
{
    const std::lock_guard lock(mutex_);
    const std::string file = canonical(path);
    for (const PluginInfo& plugin : loaded_)
        if (plugin.path == file) return plugin;
    if (const auto earlier = failed_.find(file); earlier != failed_.end()) return earlier->second;
    Result<PluginInfo> plugin = open(file);
    if (!plugin)
        failed_[file] = plugin.errors();
    else
        loaded_.push_back(*plugin);
    return plugin;
}

Result<PluginInfo> PluginLibrary::open(const std::string& path)
{
    Result<OpenPlugin> plugin = open_plugin(path);
    if (!plugin) return plugin.errors();
    PluginInfo info{plugin->name, path, {}};
    for (const TypeInfo& type : plugin->registrar.types()) info.types.push_back(type.name);
    // Kept even if the registry refuses it: the errors may refer to the plugin's code.
    libraries_.push_back(std::move(plugin->library));
    if (auto added = registry_.add(std::move(plugin->registrar), info.name); !added)
    {
        Errors errors;
        for (const Error& e : added.errors()) errors.push_back(reason("plugin " + path + ": " + e.element + ": " + e.reason));
        return errors;
    }
    return info;
}

}  // namespace plab::plugins
