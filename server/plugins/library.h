/// The plugin library: knows from manifests which plugin has which type, and loads a plugin only when one of its types is
/// requested.
#pragma once

#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "model/type_registry.h"
#include "plugins/manifest.h"
#include "plugins/plugin_file.h"

namespace plab::plugins
{

struct PluginInfo
{
    std::string name;
    std::string path;
    std::vector<std::string> types;  ///< in the order of their declaration
};

/// Plugins stay loaded as long as the library exists; everything that uses their types must be destroyed before it. Types may be
/// requested from any thread; a caller of loaded() must know that no other thread loads meanwhile.
class PluginLibrary final : public model::TypeSource
{
public:
    explicit PluginLibrary(const std::vector<std::string>& directories = default_directories());
    PluginLibrary(const PluginLibrary&) = delete;
    PluginLibrary& operator=(const PluginLibrary&) = delete;
    PluginLibrary(PluginLibrary&&) = delete;
    PluginLibrary& operator=(PluginLibrary&&) = delete;
    ~PluginLibrary() override = default;

    /// The folders of PLAB_PLUGIN_PATH (separated by colons), then the one that belongs to this program.
    static std::vector<std::string> default_directories();

    Result<const model::ComponentType*> require(const std::string& name) override;
    std::vector<std::string> names() const override;
    /// All available types, sorted by name, each as described by its plugin (if it is loaded) or by its manifest.
    std::vector<model::TypeSummary> summaries() const;

    /// Loads a plugin by its file name, independent of the manifests.
    Result<PluginInfo> load_plugin(const std::string& path);

    const std::vector<PluginInfo>& loaded() const { return loaded_; }
    /// Folders and manifests that could not be read. Not fatal: a scene may not need them.
    const Errors& problems() const { return problems_; }

private:
    Result<PluginInfo> open(const std::string& path);
    Error unknown(const std::string& name) const;

    mutable std::recursive_mutex mutex_;
    // Members are destroyed in reverse order: the registry, which holds tables and declarations made by plugins, before their
    // code.
    std::vector<LibraryHandle> libraries_;
    model::TypeRegistry registry_;
    std::vector<PluginInfo> loaded_;
    std::vector<Manifest> manifests_;
    std::map<std::string, std::vector<const Manifest*>> homes_;  ///< by type; more than one is an error when the type is requested
    std::map<std::string, Errors> failed_;                       ///< by path: the same errors are reported again, without another attempt
    Errors problems_;
};

}  // namespace plab::plugins
