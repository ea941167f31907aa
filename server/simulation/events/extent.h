/// Sizes of bodies and their shapes about the centre of mass C, and their support functions.
#pragma once

#include <vector>

#include "simulation/contacts/support.h"
#include "simulation/events/turning.h"

namespace plab::simulation
{

/// The extent of a shape on a body.
struct ShapeExtent
{
    double radius = 0;               ///< m, bounding sphere about C; infinite for planes
    double arm = 0;                  ///< m: radius that rotation about C can move; 0 for a ball centred at C
    bool convex = true;              ///< a plane counts as convex
    bool is_plane = false;           ///< a half-space: its own normal is the only possible separating axis
    std::uint32_t shape = kNoIndex;  ///< row of Shapes; kNoIndex: several shapes, or none
    Pose in_body;                    ///< X_BS
};
/// The extent of a body: one shape, or all of them together.
struct BodyExtent : ShapeExtent
{
    std::vector<ShapeExtent> shapes;  ///< all shapes of the body, compounds as their parts
    PrincipalExtent principal;
};
BodyExtent extent_of(const Bodies& bodies, const Shapes& shapes, std::uint32_t b);

/// m: support() of one of a body's shapes, or of all of them if `extent` is that of the whole body. Not for planes.
double support(const Bodies& bodies, const Shapes& shapes, std::uint32_t b, const ShapeExtent& extent, const Quat& q, const Vec3& m);
/// The point of a shape on body b, in orientation q, that is furthest along m; relative to C, in m. Not for planes.
Vec3 support_point(const Bodies& bodies, const Shapes& shapes, std::uint32_t b, const ShapeExtent& extent, const Quat& q, const Vec3& m);

}  // namespace plab::simulation
