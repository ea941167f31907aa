/// Whether triangles enclose a volume: every edge must be shared by two triangles that run along it in opposite directions.
#pragma once

#include <cstdint>
#include <span>

#include "plab/result.h"
#include "plab/vector.h"

namespace plab::shapes
{

/// Reports the first edge, in order of its vertex numbers, that violates the rule. Vertices at identical positions are merged if the mesh
/// is open by its numbers alone (files that repeat vertices for each face).
Result<void> check_closed(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles);

}  // namespace plab::shapes
