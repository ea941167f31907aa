/// Triangles with normals for everything that is drawn: primitives of unit size, and the given meshes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "plab/result.h"
#include "render/render.h"

namespace plab::render
{

struct Corner
{
    std::array<float, 3> position, normal;
    friend bool operator==(const Corner&, const Corner&) = default;
};
inline std::array<float, 3> floats(const Vec3& v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

struct Surface
{
    std::vector<Corner> corners;
    std::vector<std::uint32_t> triangles;
};

/// Radius 1; 20 * 4^level triangles.
Surface unit_sphere(int level);
/// Half extents 1.
Surface unit_box();
/// Radius 1, from z = -1 to 1.
Surface unit_cylinder(int sides);

/// In the plane z = 0, about the unit disc; four sides make a square that is parallel to x and y.
Surface unit_disc(int sides);

/// The mesh with normals: faces that meet at less than the crease angle are shaded as one smooth surface, sharper edges stay
/// sharp. Refuses triangles that refer to nonexistent vertices.
Result<Surface> surface_of(const Mesh& mesh);

}  // namespace plab::render
