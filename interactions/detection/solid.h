/// A convex solid as the general methods (GJK, expanding polytope, manifolds) use it: a core, such as a segment or a box, with a
/// rounding radius around it.
#pragma once

#include "collider.h"

namespace plab::detection
{

enum class Core : std::uint8_t
{
    Point,
    Segment,   ///< from -size.z to size.z along z
    Box,       ///< half extents `size`
    Cylinder,  ///< radius size.x, from -size.z to size.z along z
    Hull,
};

/// The closest point of a solid (or of a part of its surface) to a point outside.
struct ClosestPoint
{
    Vec3 p;
    Mat3 J;        ///< derivative of p with respect to the point outside; symmetric, eigenvalues in [0, 1]
    int flat = 0;  ///< dimensions of the surface that are known exactly at p: 0 corner, 1 along `axis`, 2 perpendicular to `axis`, 3 inside
    Vec3 axis;     ///< unit: tangent if flat = 1, outward normal if flat = 2
};

/// A part of a hull's surface: up to three of its vertices, in the common frame.
struct Facelet
{
    std::array<Vec3, 3> corner;
    int count = 0;
};

/// All points within `radius` of a core at a pose. Keeps a reference to its collider.
class Solid
{
public:
    /// Must not be a plane or a surface.
    Solid(const Collider& collider, const Pose& X);
    /// A segment without thickness, from a to b.
    static Solid rod(const Vec3& a, const Vec3& b);

    Core core() const { return core_; }
    double radius() const { return radius_; }  ///< around the core, m
    const Vec3& size() const { return size_; }
    const Hull& hull() const { return *hull_; }
    const Pose& pose() const { return X_; }
    Vec3 axis(int k) const { return {R_(0, k), R_(1, k), R_(2, k)}; }
    const Mat3& axes() const { return R_; }  ///< in columns
    bool curved() const { return core_ == Core::Cylinder; }
    /// m: the distance of no point of the core from `center` exceeds this.
    double extent() const { return extent_; }
    const Vec3& center() const { return center_; }
    void move(const Vec3& by) { X_.p += by, center_ += by; }

    Vec3 to_local(const Vec3& p) const { return transposed_times(R_, p - X_.p); }
    Vec3 to_local_direction(const Vec3& d) const { return transposed_times(R_, d); }
    Vec3 from_local(const Vec3& p_S) const { return X_.p + R_ * p_S; }
    Vec3 from_local_direction(const Vec3& d_S) const { return R_ * d_S; }

    /// The point of the core furthest in direction d.
    Vec3 support(const Vec3& d) const;
    /// The closest point of the core to q; for a hull, only the facelet is considered.
    ClosestPoint closest_point(const Vec3& q, const Facelet& facelet) const;

private:
    Solid() = default;
    ClosestPoint closest_point_on_segment(const Vec3& q) const;
    ClosestPoint closest_point_on_box(const Vec3& q) const;
    ClosestPoint closest_point_on_cylinder(const Vec3& q) const;

    Core core_ = Core::Point;
    double radius_ = 0, extent_ = 0;
    Vec3 size_, center_;
    const Hull* hull_ = nullptr;
    Pose X_;
    Mat3 R_;
};

/// The closest point of a facelet to q.
ClosestPoint closest_point_on_facelet(const Vec3& q, const Facelet& facelet);

}  // namespace plab::detection
