/// A shape as detection needs it: its geometry and hull.
#pragma once

#include <array>
#include <string>

#include "hull.h"
#include "ode_handles.h"
#include "plab/tables.h"
#include "triangle_surface.h"

namespace plab::detection
{

enum class ColliderKind : std::uint8_t
{
    None,  ///< for drawing only, a hull without volume, or a compound (its parts collide): never touches
    Sphere,
    Plane,
    Box,
    Hull,
    Capsule,
    Cylinder,
    Bowl,  ///< surfaces (plab/surface.h): they meet solids, but neither one another nor planes
    Bore,
    Triangles,
};
inline bool is_surface(ColliderKind kind) { return kind >= ColliderKind::Bowl; }

/// Built once per shape and shared by all bodies that name it. Keeps the geometry that it was built from, so that a
/// change of a shape's parameter is seen by comparison.
class Collider
{
public:
    explicit Collider(const Geometry& geometry);

    bool built_from(const Geometry& geometry) const;
    ColliderKind kind() const { return kind_; }
    const Pose& pose() const { return source_.pose; }  ///< X_BS
    const Vec3& size() const { return source_.size; }  ///< of bowls and bores: x radius, z reach
    const Hull& hull() const { return hull_; }         ///< of meshes
    const TriangleSurface& triangles() const { return triangles_; }
    /// Why a shape that should collide does not; empty if nothing is wrong.
    const std::string& complaint() const { return complaint_; }

    /// Half extents and centre in S of a box around the shape; not for planes.
    Vec3 bound_half() const;
    Vec3 bound_center() const;

private:
    void make_hull_of_mesh();
    void make_surface();

    Geometry source_;
    ColliderKind kind_ = ColliderKind::None;
    Hull hull_;
    TriangleSurface triangles_;
    std::string complaint_;
};

}  // namespace plab::detection
