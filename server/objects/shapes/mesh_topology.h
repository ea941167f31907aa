/// Whether triangles close a volume: every edge is shared by two triangles that run along it in opposite directions.
#pragma once

#include <cstdint>
#include <span>

#include "plab/result.h"
#include "plab/vector.h"

namespace plab::shapes
{

/// The first edge, in order of its vertex numbers, that breaks the rule is named. Vertices at the very same place count
/// as one where the numbers alone leave the mesh open (files that repeat a vertex per face).
Result<void> check_closed(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles);

}  // namespace plab::shapes
