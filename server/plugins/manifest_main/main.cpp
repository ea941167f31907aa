/// plab-manifest LIBRARY OUT: writes the manifest of a plugin. Runs at build time, right after the plugin is linked.

#include <cstdio>

#include "plugins/manifest.h"
#include "plugins/plugin_file.h"

int main(int argc, char** argv)
{
    if (argc != 3)
    {
        std::fprintf(stderr, "usage: plab-manifest LIBRARY OUT\nWrites to OUT which component types the plugin LIBRARY has.\n");
        return 2;
    }
    auto plugin = plab::plugins::open_plugin(argv[1]);
    if (!plugin)
    {
        std::fprintf(stderr, "plab-manifest: %s\n", plugin.error().text().c_str());
        return 1;
    }
    std::vector<std::string> types;
    for (const plab::TypeInfo& type : plugin->registrar.types()) types.push_back(type.name);
    if (const auto written = plab::plugins::write_manifest(argv[2], types); !written)
    {
        std::fprintf(stderr, "plab-manifest: %s\n", written.error().text().c_str());
        return 1;
    }
    return 0;
}
