/// The plugin library: knows from manifests which plugin has which type, and loads a plugin when one of its types is
/// asked for, not before.
#pragma once

#include <deque>
#include <map>
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

/// Plugins stay loaded for as long as the library lives; whatever uses their types must be gone before it.
/// Not thread-safe: to be asked while a scene is built, not in the step.
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
    /// All types that can be had, sorted by name, each as its plugin (if it is loaded) or its manifest tells it.
    std::vector<model::TypeSummary> summaries() const;

    /// Loads a plugin by its file, whatever the manifests say.
    Result<PluginInfo> load_plugin(const std::string& path);

    const std::vector<PluginInfo>& loaded() const { return loaded_; }
    /// Folders and manifests that could not be read. Not fatal: a scene may do without them.
    const Errors& problems() const { return problems_; }

private:
    Result<PluginInfo> open(const std::string& path);
    Error unknown(const std::string& name) const;

    // Members go in reverse order: the registry, which holds tables and declarations made by plugins, before their
    // code.
    std::vector<LibraryHandle> libraries_;
    model::TypeRegistry registry_;
    std::vector<PluginInfo> loaded_;
    std::vector<Manifest> manifests_;
    std::map<std::string, std::vector<const Manifest*>> homes_;  ///< by type; more than one is an error when asked for
    std::map<std::string, Errors> failed_;                       ///< by path: told again each time, not tried again
    Errors problems_;
};

}  // namespace plab::plugins
