/// Surfaces that solids touch from the front only, concave ones included: a bowl, a bore, triangles. The space behind them is solid. For
/// bodies that are not dynamic.
///
/// The geometry of a surface is a mesh (which is also how it is drawn) with hull_collides false. A mesh does not use its `size`, so the
/// collision parameters of the surface are stored there and a table of shapes needs no further column.
#pragma once

#include "plab/tables.h"

namespace plab
{

enum class Surface : std::uint8_t
{
    None,
    Bowl,       ///< the inside of the sphere of `radius` around the origin of S, where z <= rim_height
    Bore,       ///< the inside of the cylinder of `radius` about z of S, where |z| <= rim_height
    Triangles,  ///< the mesh's triangles, touched from the side from which they appear counter-clockwise
};

/// `radius`, `rim_height` (m): of bowls and bores.
inline void set_surface(Geometry& mesh, Surface surface, double radius = 0, double rim_height = 0)
{
    mesh.hull_collides = false;
    mesh.size = {radius, static_cast<double>(surface), rim_height};
}

inline Surface surface_of(const Geometry& geometry)
{
    if (geometry.kind != GeometryKind::Mesh || geometry.hull_collides || !(geometry.size.y > 0)) return Surface::None;
    return static_cast<Surface>(static_cast<int>(geometry.size.y));
}

/// m; of a shape for which surface_of() returns a bowl or a bore.
inline double surface_radius(const Geometry& geometry) { return geometry.size.x; }

}  // namespace plab
