/// One plugin file: opening it, checking its stamp, letting it register its types. plugin_file.cpp is the only file
/// that sees dlfcn.h.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "plab/plugin.h"

namespace plab::plugins
{

/// Unloads the library. Everything that uses its code or data (types, tables, declarations) must be destroyed before.
struct LibraryCloser
{
    void operator()(void* library) const;
};
using LibraryHandle = std::unique_ptr<void, LibraryCloser>;

struct OpenPlugin
{
    LibraryHandle library;  ///< declared first, destroyed last
    std::string path;
    std::string name;
    Registrar registrar;  ///< the types that it declared
};

/// Loads the plugin at `path`. It is refused, with a reason that names the file, unless it was built against this SDK: the
/// stamp is read before anything else in it is used.
Result<OpenPlugin> open_plugin(const std::string& path);

/// A library that is not a plugin but a part of pLab that is loaded on demand (the bus, the recorder).
struct Module
{
    LibraryHandle library;
    void* entry = nullptr;  ///< the function with the requested name
};
/// `name` without folder and ".so"; searched for in `folders`, the first match counts. It stays mapped until the process ends:
/// its libraries may have threads and thread-local data of their own.
Result<Module> open_module(const std::string& name, const std::string& entry, const std::vector<std::string>& folders);

/// Why a plugin with this stamp cannot be used; empty if it can.
std::string why_not_usable(const PluginStamp& stamp);

/// The folder "lib/plab" beside the folder of this program; empty if the system does not provide the path.
std::string installed_plugin_directory();

}  // namespace plab::plugins
