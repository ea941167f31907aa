/// A shape in the form that collision detection needs: its geometry, and a hull or surface built from it.
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
    None,  ///< for drawing only, a hull without volume, or a compound (whose parts collide instead): never collides
    Sphere,
    Plane,
    Box,
    Hull,
    Capsule,
    Cylinder,
    Bowl,  ///< from here on surfaces (plab/surface.h): they collide with solids, but neither with one another nor with planes
    Bore,
    Triangles,
};
inline bool is_surface(ColliderKind kind) { return kind >= ColliderKind::Bowl; }

/// Built once per shape and shared by all bodies that use it. Keeps the geometry that it was built from, so that a changed
/// parameter of the shape is detected by comparison.
class Collider
{
public:
    explicit Collider(const Geometry& geometry);

    bool built_from(const Geometry& geometry) const;
    ColliderKind kind() const { return kind_; }
    const Pose& pose() const { return source_.pose; }  ///< X_BS
    const Vec3& size() const { return source_.size; }  ///< of bowls and bores: x is the radius, z the rim_height (plab/surface.h)
    const Hull& hull() const { return hull_; }         ///< of meshes
    const TriangleSurface& triangles() const { return triangles_; }
    /// Whether its hull covers hollows or openings of the mesh.
    bool fills_hollows() const { return fills_hollows_; }
    /// Why a shape that should collide does not; empty if nothing is wrong.
    const std::string& complaint() const { return complaint_; }

    /// Half extents and centre, in S, of a box around the shape; undefined for planes.
    Vec3 bound_half() const;
    Vec3 bound_center() const;

private:
    void make_hull_of_mesh();
    void make_surface();

    Geometry source_;
    ColliderKind kind_ = ColliderKind::None;
    Hull hull_;
    TriangleSurface triangles_;
    bool fills_hollows_ = false;
    std::string complaint_;
};

}  // namespace plab::detection
