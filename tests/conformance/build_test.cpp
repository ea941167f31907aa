// What the build makes: a manifest for each plugin, and nothing else that could be one.
#include <filesystem>
#include <set>

#include "subjects.h"

using namespace plab::test;
namespace fs = std::filesystem;

TEST_CASE("each library of the build that is a plugin has a manifest, and all of them load")
{
    std::set<std::string> libraries, manifests;
    for (const auto& entry : fs::directory_iterator(PLAB_BINARY_DIR "/lib/plab"))
    {
        if (entry.path().extension() == ".so") libraries.insert(entry.path().stem().string());
        if (entry.path().extension() == ".manifest") manifests.insert(entry.path().stem().string());
    }
    // Parts of the server that are loaded when wanted; no plugins.
    CHECK(libraries.erase("bus") == 1);
    CHECK(libraries.erase("record") == 1);
    CHECK(libraries.erase("meshes") == 1);
    CHECK(!libraries.empty());
    CHECK(libraries == manifests);
    for (const std::string& path : tested_plugins()) CHECK(library().load_plugin(path).ok());
    CHECK(library().loaded().size() == libraries.size());
}
