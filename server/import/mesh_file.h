/// Triangles from files: STL, OBJ, glTF.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "import/robot.h"
#include "plab/result.h"

namespace plab::import
{

inline constexpr std::size_t kMostMeshBytes = std::size_t{64} << 20;

/// Limits are in meshes/mesh_module.h. All triangles of the file as one mesh, in the file's axes and lengths, each length times `scale` (a
/// mirror image keeps its outside).
Result<std::shared_ptr<const TriangleMesh>> read_mesh_file(const std::string& path, const Vec3& scale);

/// Where a mesh that `document` names is: relative to the document's folder and `folder`; package://NAME/REST in the folder itself or the
/// nearest folder above it that holds NAME or is called NAME. "" if there is none.
std::string find_mesh_file(const std::string& document, const std::string& folder, const std::string& name);

}  // namespace plab::import
