#include "import/mesh_file.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "import/meshes/mesh_module.h"
#include "plugins/library.h"

namespace plab::import
{
namespace
{

namespace fs = std::filesystem;

bool is_readable_format(const fs::path& path)
{
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return std::ranges::count(std::array<std::string_view, 4>{".stl", ".obj", ".gltf", ".glb"}, extension) > 0;
}

Result<void> check_size(const std::string& path)
{
    std::error_code error;
    const auto bytes = fs::file_size(path, error);
    if (error) return reason("the mesh " + path + " cannot be read");
    if (bytes > kMostMeshBytes) return reason("the mesh " + path + " has more than 64 MiB");
    if (!is_readable_format(path)) return reason("the mesh " + path + " is neither STL, OBJ nor glTF");
    return {};
}

/// meshes.so, loaded when the first mesh is read; a failure is reported for each of them.
Result<ReadMesh*> mesh_reader()
{
    static const auto module = plugins::open_module("meshes", kReadMeshEntry, plugins::PluginLibrary::default_directories());
    if (!module) return module.errors();
    return reinterpret_cast<ReadMesh*>(module->entry);
}

}  // namespace

Result<std::shared_ptr<const TriangleMesh>> read_mesh_file(const std::string& path, const Vec3& scale)
{
    if (auto size = check_size(path); !size) return size.errors();
    const auto reader = mesh_reader();
    if (!reader) return reason("the mesh " + path + " cannot be read: " + reader.error().reason);
    auto mesh = std::make_shared<TriangleMesh>();
    Error error;
    if (!(*reader)(path, scale, *mesh, error)) return reason("the mesh " + path + " " + error.reason);
    return std::shared_ptr<const TriangleMesh>(std::move(mesh));
}

std::string find_mesh_file(const std::string& document, const std::string& folder, const std::string& name)
{
    std::error_code ignored;
    const fs::path home = fs::absolute(document, ignored).parent_path();
    const auto if_there = [&](const fs::path& path) { return fs::is_regular_file(path, ignored) ? path.string() : std::string(); };
    constexpr std::string_view kPackage = "package://", kFile = "file://";
    if (name.starts_with(kFile)) return if_there(name.substr(kFile.size()));
    if (!name.starts_with(kPackage)) return if_there(home / folder / name);
    const fs::path inside = name.substr(kPackage.size());
    if (inside.empty()) return {};
    const fs::path package = *inside.begin();
    for (fs::path at = home; !at.empty(); at = at.parent_path())
    {
        if (const std::string found = if_there(at / inside); !found.empty()) return found;
        if (at.filename() == package)
            if (const std::string found = if_there(at / inside.lexically_relative(package)); !found.empty()) return found;
        if (at == at.root_path()) break;
    }
    return {};
}

}  // namespace plab::import
