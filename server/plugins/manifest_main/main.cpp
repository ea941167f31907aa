/// plab-manifest LIBRARY OUT: writes the manifest of a plugin. Runs at build time, right after the plugin is linked.

#include <cstdio>

#include "plugins/manifest.h"
#include "plugins/plugin_file.h"
#include "program/plain_help.h"

namespace
{

plab::program::CommandOutline outline()
{
    plab::program::CommandOutline out;
    out.name = "plab-manifest", out.help = "plab-manifest: writes the manifest of a plugin, without which plabd does not find it";
    out.places = {plab::program::place_of_file("LIBRARY", "the plugin, a .so"),
                  plab::program::place_of_file("OUT", "the manifest: which component types LIBRARY has, with their roles and fields")};
    out.footer =
        "The CMake function plab_add_plugin runs it after the plugin is linked; without CMake, call it yourself.\n"
        "Exit codes: 0 written, 1 the plugin cannot be loaded or the manifest not be written, 2 wrong use";
    return out;
}

}  // namespace

int main(int argc, char** argv)
{
    if (const auto answer = plab::program::answer_about(outline(), PLAB_VERSION, argc, argv))
        return std::fputs(answer->c_str(), stdout) < 0 ? 1 : 0;
    if (argc != 3) return std::fputs(plab::program::help_text(outline()).c_str(), stderr), 2;
    auto plugin = plab::plugins::open_plugin(argv[1]);
    if (!plugin)
    {
        std::fprintf(stderr, "plab-manifest: %s\n", plugin.error().text().c_str());
        return 1;
    }
    plab::model::TypeRegistry registry;  // goes before the plugin, whose tables it holds
    if (const auto added = registry.add(std::move(plugin->registrar), plugin->name); !added)
    {
        for (const plab::Error& e : added.errors()) std::fprintf(stderr, "plab-manifest: %s: %s\n", argv[1], e.text().c_str());
        return 1;
    }
    std::vector<plab::model::TypeSummary> types;
    for (const plab::model::ComponentType& type : registry.types()) types.push_back(plab::model::summary_of(type));
    if (const auto written = plab::plugins::write_manifest(argv[2], plugin->name, std::move(types)); !written)
    {
        std::fprintf(stderr, "plab-manifest: %s\n", written.error().text().c_str());
        return 1;
    }
    return 0;
}
