#include "import/mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <filesystem>

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

void append(const aiMesh& part, const Vec3& scale, TriangleMesh& out)
{
    const auto first = static_cast<std::uint32_t>(out.vertices.size());
    for (unsigned i = 0; i < part.mNumVertices; ++i)
    {
        const aiVector3D& v = part.mVertices[i];
        out.vertices.push_back({scale.x * double(v.x), scale.y * double(v.y), scale.z * double(v.z)});
    }
    const bool mirrored = scale.x * scale.y * scale.z < 0;
    for (unsigned i = 0; i < part.mNumFaces; ++i)
    {
        const aiFace& face = part.mFaces[i];
        if (face.mNumIndices != 3) continue;  // points and lines
        const unsigned second = mirrored ? 2 : 1;
        for (const unsigned corner : {0U, second, 3 - second}) out.triangles.push_back(first + face.mIndices[corner]);
    }
}

}  // namespace

Result<std::shared_ptr<const TriangleMesh>> read_mesh_file(const std::string& path, const Vec3& scale)
{
    if (auto size = check_size(path); !size) return size.errors();
    Assimp::Importer importer;
    // Nothing but positions and triangles; vertices that formats repeat for each triangle become one.
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS |
                                                            aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                                            aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS);
    const aiScene* const scene = importer.ReadFile(
        path, aiProcess_RemoveComponent | aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_JoinIdenticalVertices);
    if (!scene) return reason("the mesh " + path + " cannot be read: " + importer.GetErrorString());
    auto mesh = std::make_shared<TriangleMesh>();
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) append(*scene->mMeshes[i], scale, *mesh);
    if (mesh->triangles.empty()) return reason("the mesh " + path + " has no triangles");
    if (mesh->vertices.size() > kMostMeshVertices || mesh->triangles.size() / 3 > kMostMeshTriangles)
        return reason("the mesh " + path + " has more than 100,000 vertices or 200,000 triangles");
    if (!std::ranges::all_of(mesh->vertices, [](const Vec3& v) { return is_finite(v); }))
        return reason("the mesh " + path + " has vertices that are not finite");
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
