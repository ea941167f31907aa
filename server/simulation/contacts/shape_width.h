/// How thick shapes are: what could pass through what unseen.
#pragma once

#include "plab/tables.h"

namespace plab::simulation
{

/// Half the least width of a shape, m; 0 where it is not known (hulls, planes).
double least_half_width(const Geometry& shape);
/// Half of the longest way through a shape along a direction (unit, in the shape's frame), m: of a hull that through the box around it;
/// infinite for a plane.
double half_width_along(const Geometry& shape, const Vec3& direction);

}  // namespace plab::simulation
