/// Results of the narrow phase: contact points of two shapes, or their closest points.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "plab/collision.h"
#include "plab/vector.h"

namespace plab::detection
{

/// One contact point; the normal points from the first shape to the second.
struct ContactPoint
{
    Vec3 point;                 ///< m, midway between the two surfaces
    Vec3 normal;                ///< unit
    double depth = 0;           ///< m; < 0: a gap, within the requested margin
    std::uint32_t feature = 0;  ///< which corner or edge, < kFeatures; the same while the same features touch
    Pivot pivot{};              ///< A: of the first shape
};

inline constexpr std::uint32_t kFeatures = 1u << 20;

/// Up to kCapacity contact points between two shapes.
class ContactPoints
{
public:
    static constexpr std::size_t kCapacity = 16;
    /// m: points with a gap of up to this are kept as well.
    explicit ContactPoints(double margin = 0) : margin_(margin) {}
    void clear() { count_ = 0, triangles_ = 0; }
    void clear(double margin) { clear(), margin_ = margin; }
    double margin() const { return margin_; }
    /// Whether a level end of a cylinder has a furthest point (ContactSink::level_rims).
    bool level_rims() const { return level_rims_; }
    void set_level_rims(bool wanted) { level_rims_ = wanted; }
    /// Keeps the point if it is within the margin and there is room left.
    void add(const ContactPoint& contact_point)
    {
        if (contact_point.depth > -margin_ && count_ < kCapacity) contact_points_[count_++] = contact_point;
    }
    /// Number of triangles examined to find them.
    std::size_t triangles() const { return triangles_; }
    void note_triangles(std::size_t more) { triangles_ += more; }
    std::span<ContactPoint> all() { return {contact_points_.data(), count_}; }
    std::span<const ContactPoint> all() const { return {contact_points_.data(), count_}; }

private:
    std::array<ContactPoint, kCapacity> contact_points_{};
    std::size_t count_ = 0, triangles_ = 0;
    double margin_ = 0;
    bool level_rims_ = false;
};

/// The closest points of two shapes.
struct Separation
{
    double gap = 0;             ///< m; < 0: minus the depth along `normal`
    Vec3 point_a, point_b;      ///< m
    Vec3 normal;                ///< unit, from a to b
    std::size_t triangles = 0;  ///< number of triangles examined
};

}  // namespace plab::detection
