#include "import/import.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "import/document.h"
#include "import/mjcf.h"
#include "import/urdf.h"
#include "import/write_blueprint.h"

namespace plab::import
{
namespace
{

/// Keeps the whole document as a tree.
class TreeSink : public blueprint::XmlSink
{
public:
    bool begin(const XmlElement&) override { return false; }
    void child(XmlElement) override {}
    void end(XmlElement root) override { root_ = std::move(root); }
    const XmlElement& root() const { return root_; }

private:
    XmlElement root_;
};

constexpr std::size_t kMostBytes = std::size_t{16} << 20;

blueprint::XmlLimits limits()
{
    blueprint::XmlLimits out;
    out.bytes = kMostBytes, out.depth = 200, out.elements = 200'000, out.text = std::size_t{4} << 20;
    return out;
}

Result<std::string> read_bytes(const std::string& path, std::size_t most)
{
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) return Error{{path, 0, 0}, {}, "is a folder, not a file"};
    std::ifstream file(path, std::ios::binary);
    if (!file) return Error{{path, 0, 0}, {}, "cannot be opened"};
    // One byte more than allowed shows that there are too many.
    std::string bytes;
    char buffer[1 << 16];
    while (file && bytes.size() <= most)
    {
        file.read(buffer, sizeof buffer);
        bytes.append(buffer, static_cast<std::size_t>(file.gcount()));
    }
    return bytes;
}

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
    if (extension == ".urdf") return SceneFormat::Urdf;
    if (extension == ".mjcf") return SceneFormat::Mjcf;
    const auto start = read_bytes(path, std::size_t{1} << 16);
    const std::string_view root = start ? first_element(*start) : std::string_view();
    return root == "robot" ? SceneFormat::Urdf : root == "mujoco" ? SceneFormat::Mjcf : SceneFormat::Blueprint;
}

Result<ImportedScene> import_text(std::string_view text, const std::string& file, SceneFormat format, const ImportOptions& options)
{
    Document document(file);
    TreeSink tree;
    blueprint::parse_xml(text, limits(), tree, document.errors());
    for (Error& error : document.errors()) error.where.file = file;
    if (document.failed()) return document.errors();
    const char* const wanted = format == SceneFormat::Urdf ? "robot" : "mujoco";
    if (tree.root().name != wanted)
        return Error{{file, tree.root().where.line, tree.root().where.column},
                     blueprint::in_tags(tree.root().name),
                     "is not the root of " + std::string(format == SceneFormat::Urdf ? "URDF" : "MJCF") + ", which is " +
                         blueprint::in_tags(wanted)};
    Robot robot = format == SceneFormat::Urdf ? read_urdf(tree.root(), options.fixed_base, document)
                                              : read_mjcf(tree.root(), options.fixed_base, document);
    if (document.failed()) return document.errors();
    if (options.part)
        for (RobotBody& body : robot.bodies)
            if (body.parent == kWorld) body.pose = options.part->place * body.pose;
    const Assembly assembly = assemble(robot, document);
    if (document.failed()) return document.errors();
    WrittenScene written = write_blueprint(robot, assembly, options.part ? options.part->name : "", document);
    if (document.failed()) return document.errors();
    return ImportedScene{std::move(written.blueprint), std::move(written.root), document.losses(), written.bodies, written.joints};
}

Result<ImportedScene> import_file(const std::string& path, const ImportOptions& options)
{
    const SceneFormat format = format_of_file(path);
    const auto text = read_bytes(path, kMostBytes);
    if (!text) return text.errors();
    if (format == SceneFormat::Blueprint)
        return Error{{path, 0, 0}, {}, "is neither URDF (<robot>) nor MJCF (<mujoco>), by its name and its first element"};
    return import_text(*text, path, format, options);
}

}  // namespace plab::import
