/// Mass properties of solids of density 1 kg/m^3: closed forms for primitives, exact integrals for meshes.
///
/// Frames: S the shape's, B its body's. Inertia is about the solid's own centre of mass.
///
/// A closed mesh is a sum of signed tetrahedra, each from a common origin o to one triangle (a, b, c): what lies outside the solid is
/// counted as often with a minus as with a plus. Volume, first and second moments of a tetrahedron are polynomials of its corners, so the
/// sums are the exact integrals over the solid, up to rounding; the inertia is tr(M) 1 - M with M the second moments about the centre.
/// Sources: B. Mirtich, Fast and accurate computation of polyhedral mass properties, J. Graphics Tools 1(2), 1996; F. Tonon, Explicit exact
/// formulas for the 3-D tetrahedron inertia tensor, J. Math. Stat. 1(1), 2004.
#pragma once

#include <cstdint>
#include <span>

#include "plab/result.h"
#include "plab/tables.h"
#include "plab/vector.h"

namespace plab::shapes
{

/// m = 4/3 pi r^3, I = 2/5 m r^2. radius in m.
MassProperties solid_sphere(double radius);

/// m = 8 a b c, I_xx = m (b^2 + c^2) / 3, ... ; half extents (a, b, c) in m.
MassProperties solid_box(const Vec3& half_extents);

/// m = pi r^2 h, I_zz = m r^2 / 2, I_xx = I_yy = m (3 r^2 + h^2) / 12; about z, lengths in m.
MassProperties solid_cylinder(double radius, double height);

/// A cylinder with half balls at its ends; `length` is the distance between their centres, along z, m:
///   m_c = pi r^2 l,  m_s = 4/3 pi r^3,  I_zz = m_c r^2/2 + 2/5 m_s r^2,
///   I_xx = I_yy = m_c (3 r^2 + l^2)/12 + m_s (2/5 r^2 + l^2/4 + 3/8 l r)
MassProperties solid_capsule(double radius, double length);

/// Several solids as one, in their common frame (parallel-axis theorem):
///   m = sum m_i,  c = sum m_i c_i / m,  I = sum I_i + m_i (|d|^2 1 - d d^T),  d = c_i - c
/// Where they overlap, mass counts twice.
MassProperties joined(std::span<const MassProperties> parts);

/// The solid inside closed triangles (index triples, counter-clockwise seen from outside). Refuses meshes that enclose no definite
/// volume: open, non-manifold, inconsistently wound, inside-out or flat ones. Self-intersections are not detected: overlapping parts
/// count twice.
Result<MassProperties> solid_mesh(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles);

/// The same, in B instead of S.
Result<void> measure_mesh_in_body(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles, const Pose& X_BS,
                                  MassProperties& solid);

/// The same solid expressed in B: centre X_BS c, inertia R I R^T.
MassProperties posed(const MassProperties& solid_S, const Pose& X_BS);

/// Whether triangles enclose a volume: every edge must be shared by two triangles that run along it in opposite directions.
///
/// Reports the first edge, in order of its vertex numbers, that violates the rule. Vertices at identical positions are merged if the mesh
/// is open by its numbers alone (files that repeat vertices for each face).
Result<void> check_closed(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles);

}  // namespace plab::shapes
