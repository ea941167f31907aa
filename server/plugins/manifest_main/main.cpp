/// plab-manifest LIBRARY OUT: writes the manifest of a plugin. Runs at build time, right after the plugin is linked.

#include <cstdio>

#include "plugins/manifest.h"
#include "plugins/plugin_file.h"

int main(int argc, char** argv)
{
    if (argc != 3)
    {
        std::fprintf(
            stderr,
            "usage: plab-manifest LIBRARY OUT\nWrites to OUT which component types the plugin LIBRARY has, with their roles and fields.\n");
        return 2;
    }
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
