/// The penetration depth of two overlapping cores: an expanding polytope (EPA), then refinement by exact features.
///
/// The penetration depth is the length of the shortest translation that separates A and B. In terms of the Minkowski difference
/// A - B, which contains the origin if they overlap, it is the distance from the origin to the boundary of A - B. EPA
/// approximates A - B from inside by a polytope of support points. In each round it takes the face nearest to the origin and
/// asks for the support along the normal of that face. The distance of the face is a lower bound of the depth, and that of the
/// support an upper bound. If they agree, the face lies on the boundary and its normal is the direction sought. Otherwise
/// the support becomes a new vertex: the faces that are visible from it are removed, and the hole is closed by triangles between
/// its rim and the new vertex.
#pragma once

#include "gjk.h"

namespace plab::detection
{

/// Two cores that overlap or touch: if B is translated by `depth` along `normal` (from A to B), they only touch.
struct Overlap
{
    Vec3 a, b;  ///< the points that would then touch, at their present positions
    Vec3 normal;
    double depth = 0;       ///< m; slightly < 0, by rounding, if they do not overlap after all
    bool converged = true;  ///< false: the polytope was full, and `normal` is not proven to be the direction of least depth
};

/// G. van den Bergen, Proximity queries and penetration depth computation on 3D game objects, GDC 2001. The polytope is also
/// expanded if it does not contain the origin yet, so no enclosing simplex is needed to start with. For polyhedra the number of
/// rounds is finite; the polytope has at most 128 points. A - B must have a volume. For curved cores the depth is found to
/// within 2 %, and the direction is then refined. `simplex`: where GJK ended, or no points.
Overlap overlap_of(const Solid& A, const Solid& B, const Simplex& simplex);

/// The least depth (or the largest gap: depth < 0) over the directions near n. If B is moved out by depth(n) + delta along n,
/// the closest points of A and B give a new direction n; a fixed point of this iteration is a stationary depth. Where faces or
/// edges meet, one round suffices. For curved surfaces the error shrinks by a factor of about depth / radius in each of at most
/// 16 rounds. `simplex`: where GJK may begin, or no points.
Overlap refine(const Solid& A, const Solid& B, const Vec3& n, const Simplex& simplex);

}  // namespace plab::detection
