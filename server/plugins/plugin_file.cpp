#include "plugins/plugin_file.h"

#include <dlfcn.h>

#include <filesystem>

namespace plab::plugins
{
namespace
{

using RegisterFunction = void (*)(Registrar&);

Error refused(const std::string& path, const std::string& why) { return reason("plugin " + path + ": " + why); }

std::string compiler_of(const PluginStamp& stamp) { return stamp.compiler ? std::string(" (compiler ") + stamp.compiler + ")" : ""; }

/// No exception may cross the boundary; if a plugin throws nevertheless, the exception is caught here.
Result<void> register_types(RegisterFunction entry, OpenPlugin& plugin)
{
    try
    {
        entry(plugin.registrar);
    }
    catch (...)
    {
        return refused(plugin.path, "threw an exception while registering its types");
    }
    if (plugin.registrar.types().empty()) return refused(plugin.path, "declares no types");
    return {};
}

}  // namespace

void LibraryCloser::operator()(void* library) const { dlclose(library); }

std::string why_not_usable(const PluginStamp& stamp)
{
    // Version and size come first in every version of the stamp; the rest is meaningful only if they match.
    const std::string rebuild = "; build it again with this SDK";
    if (stamp.sdk_version != kSdkVersion)
        return "was built for version " + std::to_string(stamp.sdk_version) + " of the SDK, version " + std::to_string(kSdkVersion) +
               " is needed" + rebuild;
    if (stamp.size != sizeof(PluginStamp))
        return "its stamp has " + std::to_string(stamp.size) + " bytes, " + std::to_string(sizeof(PluginStamp)) + " are needed" + rebuild;
    if (stamp.layout != layout_stamp())
        return "its structures are laid out differently: layout " + std::to_string(stamp.layout) + compiler_of(stamp) + ", " +
               std::to_string(layout_stamp()) + " (compiler " __VERSION__ ") is needed" + rebuild;
    if (!stamp.name || !*stamp.name) return "its stamp has no name";
    return {};
}

Result<OpenPlugin> open_plugin(const std::string& path)
{
    std::error_code ignored;  // an absolute path, because a bare name would be searched for in the system's folders
    const std::string file = std::filesystem::absolute(path, ignored).lexically_normal().string();
    OpenPlugin plugin;
    plugin.path = file;
    plugin.library.reset(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL));
    if (!plugin.library)
    {
        const char* why = dlerror();
        return refused(file, std::string("cannot be loaded: ") + (why ? why : "unknown reason"));
    }
    const auto* stamp = static_cast<const PluginStamp*>(dlsym(plugin.library.get(), kStampSymbol));
    if (!stamp) return refused(file, std::string("is not a pLab plugin: it has no symbol ") + kStampSymbol);
    if (const std::string why = why_not_usable(*stamp); !why.empty()) return refused(file, why);
    const auto entry = reinterpret_cast<RegisterFunction>(dlsym(plugin.library.get(), kRegisterSymbol));
    if (!entry) return refused(file, std::string("has no symbol ") + kRegisterSymbol);
    plugin.name = stamp->name;
    if (auto done = register_types(entry, plugin); !done) return done.errors();
    return plugin;
}

Result<Module> open_module(const std::string& name, const std::string& entry, const std::vector<std::string>& folders)
{
    for (const std::string& folder : folders)
    {
        const std::filesystem::path path = std::filesystem::path(folder) / (name + ".so");
        std::error_code ignored;
        if (!std::filesystem::exists(path, ignored)) continue;
        Module module;
        module.library.reset(dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE));
        const char* const why = module.library ? nullptr : dlerror();
        if (!module.library) return reason(path.string() + " cannot be loaded: " + (why ? why : "unknown reason"));
        module.entry = dlsym(module.library.get(), entry.c_str());
        if (!module.entry) return reason(path.string() + " has no symbol " + entry);
        return module;
    }
    return reason("there is no " + name + ".so among the plugins");
}

std::string installed_plugin_directory()
{
    std::error_code failed;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failed);
    if (failed) return {};
    return (program.parent_path().parent_path() / "lib" / "plab").string();
}

}  // namespace plab::plugins
