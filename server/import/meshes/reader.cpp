// What meshes.so exports: the only file that sees Assimp. No exception may cross the module's boundary.

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <exception>

#include "import/meshes/mesh_module.h"

namespace plab::import
{
namespace
{

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

bool read(const std::string& path, const Vec3& scale, TriangleMesh& mesh, Error& error)
{
    const auto fail = [&](const std::string& why) { return error = reason(why), false; };
    Assimp::Importer importer;
    // Nothing but positions and triangles; vertices that formats repeat for each triangle become one.
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS |
                                                            aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                                            aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS);
    const aiScene* const scene = importer.ReadFile(
        path, aiProcess_RemoveComponent | aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_JoinIdenticalVertices);
    if (!scene) return fail(std::string("cannot be read: ") + importer.GetErrorString());
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) append(*scene->mMeshes[i], scale, mesh);
    if (mesh.triangles.empty()) return fail("has no triangles");
    if (mesh.vertices.size() > kMostMeshVertices || mesh.triangles.size() / 3 > kMostMeshTriangles)
        return fail("has more than 100,000 vertices or 200,000 triangles");
    if (!std::ranges::all_of(mesh.vertices, [](const Vec3& v) { return is_finite(v); })) return fail("has vertices that are not finite");
    return true;
}

}  // namespace
}  // namespace plab::import

extern "C" __attribute__((visibility("default"))) bool plab_mesh_read(const std::string& path, const plab::Vec3& scale,
                                                                      plab::import::TriangleMesh& mesh, plab::Error& error)
{
    try
    {
        return plab::import::read(path, scale, mesh, error);
    }
    catch (const std::exception& e)
    {
        error = plab::reason(std::string("cannot be read: ") + e.what());
        return false;
    }
}
static_assert(std::is_same_v<plab::import::ReadMesh, decltype(plab_mesh_read)>);
