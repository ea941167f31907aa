/// Geometry as triangles, for pictures of what has no form of its own there.
#pragma once

#include "built_mesh.h"

namespace plab::shapes
{

/// In the frame that geometry.pose is given in. Round parts have 64 sides. Nothing for planes and compounds.
BuiltMesh picture_of(const Geometry& geometry);

}  // namespace plab::shapes
