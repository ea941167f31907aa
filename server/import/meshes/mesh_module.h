/// Triangles from files, read by a module of their own, meshes.so, that is loaded when the first mesh is asked for: the library behind it
/// (Assimp) is large, and most scenes have no such file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plab/result.h"
#include "plab/vector.h"

namespace plab::import
{

struct TriangleMesh
{
    std::vector<Vec3> vertices;  ///< m
    std::vector<std::uint32_t> triangles;
};

/// Limits of a file of triangles.
inline constexpr std::size_t kMostMeshVertices = 100'000;
inline constexpr std::size_t kMostMeshTriangles = 200'000;

/// What meshes.so exports under this name: all triangles of the file as one mesh, in the file's axes and lengths, each length times `scale`
/// (a mirror image keeps its outside). False with a reason that follows "the mesh FILE".
inline constexpr const char* kReadMeshEntry = "plab_mesh_read";
using ReadMesh = bool(const std::string& path, const Vec3& scale, TriangleMesh& mesh, Error& error);

}  // namespace plab::import
