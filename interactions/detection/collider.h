/// A shape as detection needs it: its geometry and hull.
#pragma once

#include <array>
#include <string>

#include "hull.h"
#include "ode_handles.h"
#include "plab/tables.h"

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
};

/// Built once per shape and shared by all bodies that name it. Keeps the geometry that it was built from, so that a
/// change of a shape's parameter is seen by comparison.
class Collider
{
public:
    explicit Collider(const Geometry& geometry);

    bool built_from(const Geometry& geometry) const;
    ColliderKind kind() const { return kind_; }
    const Pose& pose() const { return source_.pose; }  ///< X_BS
    const Vec3& size() const { return source_.size; }
    const Hull& hull() const { return hull_; }  ///< of meshes
    /// Why a shape that should collide does not; empty if nothing is wrong.
    const std::string& complaint() const { return complaint_; }

    /// Half extents and centre in S of a box around the shape; not for planes.
    Vec3 bound_half() const;
    Vec3 bound_center() const;

private:
    void make_hull_of_mesh();

    Geometry source_;
    ColliderKind kind_ = ColliderKind::None;
    Hull hull_;
    std::string complaint_;
};

}  // namespace plab::detection
