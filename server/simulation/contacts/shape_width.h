/// Thickness of shapes, which decides whether one body could pass through another within a time step (tunnelling).
#pragma once

#include "plab/tables.h"

namespace plab::simulation
{

/// Half of the smallest width of a shape, m; 0 if it is not known (hulls, planes).
double least_half_width(const Geometry& shape);
/// Half of the longest chord through a shape along a direction (unit, in the shape's frame), m; for a hull the chord through its bounding
/// box; infinite for a plane.
double half_width_along(const Geometry& shape, const Vec3& direction);

}  // namespace plab::simulation
