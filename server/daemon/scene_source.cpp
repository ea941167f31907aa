#include "daemon/scene_source.h"

#include <spdlog/spdlog.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "blueprint/reader.h"
#include "daemon/ending.h"
#include "export/mjcf.h"
#include "import/import.h"
#include "simulation/simulation.h"

namespace plab::daemon
{
namespace
{

Result<void> write_whole(const std::string& path, const std::string& text)
{
    const std::string part = path + ".part";
    {
        std::ofstream file(part, std::ios::binary);
        file << text;
        file.flush();
        if (!file) return Error{{path, 0, 0}, {}, "cannot be written"};
    }
    std::error_code error;
    std::filesystem::rename(part, path, error);
    if (!error) return {};
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    return Error{{path, 0, 0}, {}, "cannot be written: " + error.message()};
}

/// Errors in an imported blueprint have no place in the file that people wrote.
std::string name_of_import(const std::string& scene) { return scene + " (as a blueprint)"; }

import::ImportOptions import_options(const DaemonOptions& options){
    return {options.fixed_base, options.import_folders, {}, options.self_collide};
}  // namespace

}  // namespace plab::daemon

Result<model::Blueprint> read_scene(const DaemonOptions& options)
{
    if (import::format_of_file(options.scene) == import::SceneFormat::Blueprint)
    {
        if (options.fixed_base) return Error{{options.scene, 0, 0}, {}, "--fixed-base is for scenes in URDF, SDF and MJCF"};
        if (options.self_collide) return Error{{options.scene, 0, 0}, {}, "--self-collide is for scenes in URDF"};
        if (!options.import_folders.empty()) return Error{{options.scene, 0, 0}, {}, "--import-path is for scenes in SDF"};
        return blueprint::read_blueprint_file(options.scene);
    }
    auto imported = import::import_file(options.scene, import_options(options));
    if (!imported) return imported.errors();
    for (const Error& loss : imported->losses) spdlog::warn("{}", loss.text());
    return blueprint::read_blueprint(imported->blueprint, name_of_import(options.scene));
}

int import_scene(plugins::PluginLibrary& library, const DaemonOptions& options)
{
    auto imported = import::import_file(options.scene, import_options(options));
    if (!imported) return fail(imported.errors());
    auto tree = blueprint::read_blueprint(imported->blueprint, name_of_import(options.scene));
    if (!tree) return fail(tree.errors());
    auto scene = model::compile(*tree, library, nullptr, limits_of(options));
    if (!scene) return fail(scene.errors());
    simulation::Simulation simulation(library, options.threads);
    simulation.limit(limits_of(options));
    if (auto loaded = simulation.load(*scene); !loaded) return fail(loaded.errors());
    if (options.blueprint.empty() || options.blueprint == "-")
        std::fputs(imported->blueprint.c_str(), stdout);
    else if (auto written = write_whole(options.blueprint, imported->blueprint); !written)
        return fail(written.errors());
    for (const Error& loss : imported->losses) std::fprintf(stderr, "%s\n", loss.text().c_str());
    std::fprintf(stderr, "%s: %zu bodies, %zu joints; %zu not carried over as they are\n", options.scene.c_str(), imported->bodies,
                 imported->joints, imported->losses.size());
    return 0;
}

int export_scene(const simulation::Simulation& simulation, const DaemonOptions& options)
{
    const exported::ExportedScene scene = exported::write_mjcf(simulation.world(), simulation.dt());
    if (auto written = write_whole(options.exported, scene.text); !written) return fail(written.errors());
    for (const Error& loss : scene.losses) std::fprintf(stderr, "%s\n", loss.text().c_str());
    std::fprintf(stderr, "%s: %zu bodies, %zu joints; %zu not carried over as they are\n", options.exported.c_str(), scene.bodies,
                 scene.joints, scene.losses.size());
    return 0;
}

}  // namespace plab::daemon
