/// Points of contact of two solids, from the parts of their surfaces that face one another.
#pragma once

#include "contact_points.h"
#include "solid.h"

namespace plab::detection
{

/// Points that stand for the rim of one end of a cylinder: four that are fixed to the body, and the furthest one in a
/// direction, where there is one.
struct RimPoints
{
    static constexpr std::uint32_t kFurthest = 4;
    std::array<Vec3, 5> p;
    std::array<std::uint32_t, 5> id{};
    std::uint32_t count = 0;
};
RimPoints rim_points(const Solid& cylinder, bool upper, const Vec3& direction);

/// Features by what meets: a corner of A or of B on the other, edges that cross, or the nearest points alone.
std::uint32_t corner_feature(bool of_a, std::uint32_t corner);
std::uint32_t crossing_feature(std::uint32_t edge_a, std::uint32_t edge_b);
inline constexpr std::uint32_t kNearestFeature = 3u << 18;
/// The same feature with A and B changed over.
std::uint32_t mirrored_feature(std::uint32_t feature);

/// The surfaces that face one another along s.normal (of the solids' signed distance) are laid over one another along it:
/// corners of each on the other, and where edges cross. Each point has its own depth along the normal; the deepest has
/// that of `s`. At most 9 are kept, the outermost ones and the deepest.
void add_manifold(const Solid& A, const Solid& B, const Separation& s, ContactPoints& out);

/// Two boxes by their 15 axes: the quick way to the same.
void box_box(const Solid& A, const Solid& B, ContactPoints& out);

}  // namespace plab::detection
