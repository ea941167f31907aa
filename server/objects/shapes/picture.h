/// Triangle meshes for drawing shapes that have no mesh of their own.
#pragma once

#include "built_mesh.h"

namespace plab::shapes
{

/// In the frame in which geometry.pose is given. Round parts have 64 sides. Empty for planes and compounds.
BuiltMesh picture_of(const Geometry& geometry);

}  // namespace plab::shapes
