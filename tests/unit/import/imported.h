/// A robot's text in a test: imported, compiled and loaded.
#pragma once

#include "import/import.h"
#include "support/scene.h"

namespace plab::test
{

inline const char* const kArmFile = "robot.urdf";

inline Result<import::ImportedScene> import_robot(const std::string& text, import::SceneFormat format, const std::string& file = "robot")
{
    return import::import_text(text, file, format, {});
}

/// Its content, for Scene: without <plab>, and the settings of its <scene> in `settings`.
inline std::string content_of(const import::ImportedScene& imported, std::string& settings)
{
    const std::string& text = imported.blueprint;
    const std::size_t begin = text.find("<scene"), end = text.find(">", begin), after = text.find("</scene>"), last = text.rfind("</plab>");
    settings = text.substr(begin + 6, end - begin - 6);
    return text.substr(after + 8, last - after - 8);
}

/// `more`: components that are added.
inline Scene imported_scene(const import::ImportedScene& imported, const std::string& more = "")
{
    std::string settings;
    const std::string body = content_of(imported, settings);
    return Scene(body + more, settings);
}

inline import::ImportedScene imported_file(const std::string& name)
{
    auto imported = import::import_file(std::string(PLAB_SOURCE_DIR) + "/scenes/imported/" + name, {});
    REQUIRE_MESSAGE(imported.ok(), reasons(imported));
    return imported.take();
}

inline import::ImportedScene imported_text(const std::string& text, import::SceneFormat format)
{
    auto imported = import_robot(text, format);
    REQUIRE_MESSAGE(imported.ok(), reasons(imported));
    return imported.take();
}

inline bool lists(const import::ImportedScene& imported, const std::string& text)
{
    for (const Error& loss : imported.losses)
        if (loss.text().find(text) != std::string::npos) return true;
    return false;
}

}  // namespace plab::test
