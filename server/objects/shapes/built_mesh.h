/// Closed meshes, counter-clockwise seen from outside: of machine parts, built from outlines, and pictures of shapes that have no mesh
/// of their own.
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

    /// Adds a closed ring of vertices; returns the number of its first vertex.
    std::uint32_t add_ring(std::span<const Vec3> ring);
    std::uint32_t add_vertex(const Vec3& v);
    void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    /// Adds the band between two rings of `count` vertices each. Seen from outside, `lower` runs to the right and `upper` lies above it.
    void add_band(std::uint32_t lower, std::uint32_t upper, std::uint32_t count);
    /// Adds the cone from a ring to a point; seen from outside, the ring runs counter-clockwise around the point.
    void add_cap(std::uint32_t ring, std::uint32_t count, std::uint32_t tip);
    void append(const BuiltMesh& other);

    /// Converts the mesh to the geometry of a shape.
    Geometry geometry(const Pose& pose, bool hull_collides) &&;
};

/// A point of an outline in a plane through the axis, at distance `r` from the axis and height `z`, m.
struct ProfilePoint
{
    double r, z;
};

/// `sides` points of a circle about z at height z, the first of them in the direction of x.
std::vector<Vec3> circle(double radius, double z, std::uint32_t sides);

/// The solid of revolution of the profile about z; the profile runs from bottom to top, with its ends on the axis (r = 0).
BuiltMesh turned_profile(std::span<const ProfilePoint> profile, std::uint32_t sides);

/// The prism of an outline (counter-clockwise seen from z, around the origin) from -half to +half along z. It has a round hole whose
/// vertices are in the directions of the outline's vertices; if bore is 0, a vertex in the middle instead.
BuiltMesh bored_prism(std::span<const Vec3> outline, double bore, double half);

/// What is drawn of a shape, in the frame in which geometry.pose is given. Round parts have 64 sides. Empty for planes and compounds.
BuiltMesh picture_of(const Geometry& geometry);

}  // namespace plab::shapes
