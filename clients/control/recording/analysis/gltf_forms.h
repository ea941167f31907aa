/// Triangles with normals of the shapes in a recording, as glTF wants them.
#pragma once

#include <cstdint>
#include <vector>

#include "plab/vector.h"

struct plab_v2_Shape;

namespace plab::analysis
{

struct GltfSurface
{
    std::vector<Vec3> points, normals;  ///< m, in the shape's frame; one normal for each point
    std::vector<std::uint32_t> triangles;
};

/// Empty for forms that cannot be seen. Planes are squares of 20 m about their origin. Meshes have flat faces.
GltfSurface surface_of(const plab_v2_Shape& shape);

}  // namespace plab::analysis
