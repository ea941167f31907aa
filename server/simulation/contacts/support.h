/// Support functions of shapes and bodies: how far they reach in a direction.
#pragma once

#include <cstdint>

#include "plab/tables.h"

namespace plab::simulation
{

/// m: max over the points p of a shape of m . p, with the frame of the shape at X; -inf for planes. A surface of triangles counts as the box
/// around it, so what this separates is apart.
double support_of_shape(const Geometry& g, const Shapes& shapes, const Pose& X, const Vec3& m);

/// m: max over the points p of body b, in orientation q, of m . (p - C), as above.
double support(const Bodies& bodies, const Shapes& shapes, std::uint32_t b, const Quat& q, const Vec3& m);

}  // namespace plab::simulation
