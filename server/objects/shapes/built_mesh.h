/// Closed meshes of machine parts, built from outlines. All are counter-clockwise seen from outside.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "plab/tables.h"

namespace plab::shapes
{

struct BuiltMesh
{
    std::vector<Vec3> vertices;
    std::vector<std::uint32_t> triangles;

    /// A closed ring of vertices; its number is that of the first.
    std::uint32_t add_ring(std::span<const Vec3> ring);
    std::uint32_t add_vertex(const Vec3& v);
    void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    /// The band between two rings of `count` vertices each. Seen from outside, `lower` runs to the right and `upper` lies
    /// above it.
    void add_band(std::uint32_t lower, std::uint32_t upper, std::uint32_t count);
    /// The cone from a ring to a point: seen from outside, the ring runs counter-clockwise about the point.
    void add_cap(std::uint32_t ring, std::uint32_t count, std::uint32_t tip);
    void append(const BuiltMesh& other);

    /// Turns into the geometry of a shape.
    Geometry geometry(const Pose& pose, bool hull_collides) &&;
};

/// A point of an outline in the plane of the axis: `r` from it, at height `z`, m.
struct ProfilePoint
{
    double r, z;
};

/// The profile turned about z; from bottom to top, its ends on the axis (r = 0).
BuiltMesh turned_profile(std::span<const ProfilePoint> profile, std::uint32_t sides);

/// An outline (counter-clockwise seen from z, around the origin) from -half to +half along z, with a round hole whose
/// vertices stand in the outline's directions; without one, and a vertex in the middle, where bore is 0.
BuiltMesh bored_prism(std::span<const Vec3> outline, double bore, double half);

}  // namespace plab::shapes
