/// A shape as detection needs it: its geometry, hull, and ODE's copy of it.
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
    None,  ///< for drawing only, or a hull without volume: never touches
    Sphere,
    Plane,
    Box,
    Hull,
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
    const Hull& hull() const { return hull_; }  ///< of boxes too
    /// Why a shape that should collide does not; empty if nothing is wrong.
    const std::string& complaint() const { return complaint_; }

    /// Half extents and centre in S of a box around the shape; not for planes.
    Vec3 bound_half() const;
    Vec3 bound_center() const;
    /// ODE's box outside of any space, at X; `side` 0 or 1, so that a shape can meet itself. Boxes only.
    dxGeom* probe(int side, const Pose& X) const;

private:
    void make_box();

    Geometry source_;
    ColliderKind kind_ = ColliderKind::None;
    Hull hull_;
    std::string complaint_;
    std::array<GeomHandle, 2> probes_;
};

}  // namespace plab::detection
