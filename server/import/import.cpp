#include "import/import.h"

#include <algorithm>
#include <filesystem>

#include "import/collision_rules.h"
#include "import/document.h"
#include "import/mjcf.h"
#include "import/sdf.h"
#include "import/source.h"
#include "import/urdf.h"
#include "import/write_blueprint.h"

namespace plab::import
{
namespace
{

struct Format
{
    SceneFormat format;
    std::string_view name, root, extension, other_extension;
};

constexpr Format kFormats[] = {{SceneFormat::Urdf, "URDF", "robot", ".urdf", ".xacro"},
                               {SceneFormat::Sdf, "SDF", "sdf", ".sdf", ".world"},
                               {SceneFormat::Mjcf, "MJCF", "mujoco", ".mjcf", ".mjcf"}};

}  // namespace

std::string_view first_element(std::string_view text)
{
    text = text.substr(0, std::size_t{1} << 16);
    for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', at))
    {
        const std::string_view rest = text.substr(at);
        const std::string_view close = rest.starts_with("<!--") ? "-->" : rest.starts_with("<?") ? "?>" : "";
        if (close.empty()) return rest.substr(1, rest.find_first_of(" \t\r\n/>", 1) - 1);
        at = text.find(close, at);
        if (at == std::string_view::npos) break;
    }
    return {};
}

SceneFormat format_of_file(const std::string& path)
{
    const std::string extension = std::filesystem::path(path).extension().string();
    for (const Format& f : kFormats)
        if (extension == f.extension || extension == f.other_extension) return f.format;
    const auto start = read_bytes(path, std::size_t{1} << 16);
    const std::string_view root = start ? first_element(*start) : std::string_view();
    for (const Format& f : kFormats)
        if (root == f.root) return f.format;
    return SceneFormat::Blueprint;
}

Result<ImportedScene> import_text(std::string_view text, const std::string& file, SceneFormat format, const ImportOptions& options)
{
    Document document(file);
    XmlElement root = read_tree(text, 0, document);
    if (document.failed()) return document.errors();
    const auto wanted = std::ranges::find(kFormats, format, &Format::format);
    if (wanted == std::end(kFormats) || root.name != wanted->root)
        return Error{{file, root.where.line, root.where.column},
                     blueprint::in_tags(root.name),
                     "is not the root of " + std::string(wanted->name) + ", which is " + blueprint::in_tags(wanted->root)};
    Robot robot = format == SceneFormat::Urdf  ? read_urdf(root, options.fixed_base, options.self_collide, document)
                  : format == SceneFormat::Sdf ? read_sdf(root, options.folders, options.fixed_base, document)
                                               : read_mjcf(std::move(root), options.fixed_base, document);
    if (document.failed()) return document.errors();
    if (options.part)
        for (RobotBody& body : robot.bodies)
            if (body.parent == kWorld) body.pose = options.part->place * body.pose;
    Assembly assembly = assemble(robot, document);
    if (document.failed()) return document.errors();
    const std::vector<CollisionExclusion> exclusions = collision_rules(robot, assembly, document);
    if (document.failed()) return document.errors();
    WrittenScene written = write_blueprint(robot, assembly, exclusions, options.part ? options.part->name : "", document);
    if (document.failed()) return document.errors();
    return ImportedScene{std::move(written.blueprint), std::move(written.root), document.losses(), written.bodies, written.joints};
}

Result<ImportedScene> import_file(const std::string& path, const ImportOptions& options)
{
    const SceneFormat format = format_of_file(path);
    const auto text = read_bytes(path, kMostSourceBytes);
    if (!text) return text.errors();
    if (format == SceneFormat::Blueprint)
        return Error{{path, 0, 0}, {}, "is neither URDF (<robot>), SDF (<sdf>) nor MJCF (<mujoco>), by its name and its first element"};
    return import_text(*text, path, format, options);
}

}  // namespace plab::import
