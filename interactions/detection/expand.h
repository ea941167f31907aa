/// The least depth of two overlapping cores: an expanding polytope, then the exact features.
#pragma once

#include "gjk.h"

namespace plab::detection
{

/// Two cores that overlap or touch: moved apart by `depth` along `normal` (from A to B) they only touch.
struct Overlap
{
    Vec3 a, b;  ///< the points that touch then, where they are now
    Vec3 normal;
    double depth = 0;       ///< m; < 0 by a rounding error if they do not overlap after all
    bool converged = true;  ///< false: the polytope was full; depth is that of a direction that is not proven to be the least
};

/// G. van den Bergen, Proximity queries and penetration depth computation on 3D game objects, GDC 2001. The polytope
/// inside A - B grows at the face nearest to the origin (also if the origin is outside of it, so no enclosing simplex is
/// needed) until its face is one of A - B: finite for polyhedra. At most 128 points. A - B must span a volume.
/// Of curved cores the face is found to 2 % of the depth; then the direction is refined.
Overlap overlap_of(const Solid& A, const Solid& B);

/// The least depth (or the largest gap: depth < 0) over the directions near n. B moved out by depth(n) + delta along n is
/// nearest to A along the next n: a fixed point of that is a stationary depth. One round where faces or edges meet; of
/// curved surfaces the error shrinks by about depth / radius in each of at most 16 rounds.
Overlap refine(const Solid& A, const Solid& B, const Vec3& n);

}  // namespace plab::detection
