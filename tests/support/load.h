/// Turns blueprint text into a running scene with the plugins of this build. Independent of the test framework, so that
/// benchmark programs can use it too. Errors are those of the reader, the compiler and the loader.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "blueprint/reader.h"
#include "model/compile.h"
#include "plugins/library.h"
#include "simulation/simulation.h"

namespace plab::test
{

/// Where plugins are looked for: those of this build, unless a program says otherwise before it asks for the library.
inline std::vector<std::string>& plugin_folders()
{
    static std::vector<std::string> folders{PLAB_BINARY_DIR "/lib/plab"};
    return folders;
}

/// The plugins in those folders, shared by all scenes of a program.
inline plugins::PluginLibrary& library()
{
    static plugins::PluginLibrary instance(plugin_folders());
    return instance;
}

/// <plab> around `body`; dt and more go into `settings`, e.g. "dt='1/60'".
inline std::string whole_scene(const std::string& body, const std::string& settings = "")
{
    return "<plab version=\"1\">" + (settings.empty() ? "" : "<scene " + settings + "/>") + body + "</plab>";
}

/// `existing`: the scene that a fragment may refer to.
inline Result<model::SceneSpec> compile_read(const Result<model::Blueprint>& blueprint, const model::SceneSpec* existing = nullptr)
{
    if (!blueprint) return blueprint.errors();
    return model::compile(*blueprint, library(), existing);
}

/// `name` replaces the file name in error messages.
inline Result<model::SceneSpec> compile_text(const std::string& text, const std::string& name = "scene.xml",
                                             const model::SceneSpec* existing = nullptr)
{
    return compile_read(blueprint::read_blueprint(text, name), existing);
}

inline Result<std::unique_ptr<simulation::Simulation>> load_text(const std::string& text, const std::string& name = "scene.xml")
{
    const auto scene = compile_text(text, name);
    if (!scene) return scene.errors();
    auto simulation = std::make_unique<simulation::Simulation>(library());
    if (auto loaded = simulation->load(*scene); !loaded) return loaded.errors();
    return simulation;
}

}  // namespace plab::test
