/// How large bodies and their shapes are about the centre of mass, and how far they reach in a direction.
#pragma once

#include <vector>

#include "simulation/events/turning.h"

namespace plab::simulation
{

/// The extent of a shape on a body.
struct ShapeExtent
{
    double radius = 0;               ///< m, about C; infinite for planes
    double arm = 0;                  ///< m: how far turning about C can sweep; 0 for a ball around C
    bool convex = true;              ///< a plane is
    bool is_plane = false;           ///< a half-space: its own normal is the only direction that can separate
    std::uint32_t shape = kNoIndex;  ///< row of Shapes; kNoIndex: several, or none
    Pose in_body;                    ///< X_BS
};
/// The extent of a body: one shape, or all of them together.
struct BodyExtent : ShapeExtent
{
    std::vector<ShapeExtent> shapes;  ///< of a body of several, compounds as their parts
    PrincipalExtent principal;
};
BodyExtent extent_of(const Bodies& bodies, const Shapes& shapes, std::uint32_t b);

/// max over the points of body b, turned by q, of m . (p - C), m. Not for planes.
double support(const Bodies& bodies, const Shapes& shapes, std::uint32_t b, const Quat& q, const Vec3& m);

/// The same of a shape of it; of all of them where `extent` is the whole body's.
double support(const Bodies& bodies, const Shapes& shapes, std::uint32_t b, const ShapeExtent& extent, const Quat& q, const Vec3& m);
/// The point of a shape on body b, turned by q, that is furthest along m; from C, m. Not for planes.
Vec3 support_point(const Bodies& bodies, const Shapes& shapes, std::uint32_t b, const ShapeExtent& extent, const Quat& q, const Vec3& m);

}  // namespace plab::simulation
