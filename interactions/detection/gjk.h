/// The closest points of two convex cores, by GJK.
///
/// Two convex sets A and B overlap exactly if the Minkowski difference A - B = { a - b } contains the origin; if they do not,
/// the point of A - B nearest to the origin gives their distance and closest points. A - B itself is never built. GJK needs only
/// its support mapping: the point of A - B furthest in a direction d is that of A along d minus that of B along -d. The
/// algorithm keeps a simplex of up to four such points. In each round it finds the point of the simplex nearest to the origin,
/// drops the vertices which that point does not depend on, and adds the support in the direction from that point towards the
/// origin. It ends when a new support brings no further progress, which proves that the nearest point has been found, or when
/// the simplex encloses the origin.
///
/// For polyhedra this is exact up to rounding. For curved shapes GJK only converges slowly, and the direction between two close
/// points loses digits. nearest_pair() therefore polishes the result: it solves p = c_A(c_B(p)) by Newton's method, where c_A
/// and c_B map a point to the closest point of A and of B (Solid::closest_point), with analytic derivatives. The normal is then
/// taken from the features that meet.
#pragma once

#include "solid.h"

namespace plab::detection
{

/// A point of the Minkowski difference A - B, with the points of A and B that it comes from.
struct Support
{
    Vec3 w, a, b;
};
Support support_of(const Solid& A, const Solid& B, const Vec3& d);

/// Up to four support points; their convex hull contains the point nearest to the origin that is known so far.
struct Simplex
{
    std::array<Support, 4> at{};
    std::size_t count = 0;
    Vec3 nearest;           ///< point of the simplex nearest to the origin
    Vec3 nearest_a;         ///< the corresponding point of A
    bool encloses = false;  ///< the origin is inside, so the cores overlap
};

/// E. Gilbert, D. Johnson, S. Keerthi, A fast procedure for computing the distance between complex objects, IEEE J. Robotics and
/// Automation 4(2), 1988. The nearest point of the simplex is found by trying all its vertices, edges and faces, which is robust
/// for nearly degenerate simplices. Stops when the distance is known to `tolerance` (m), when rounding prevents progress, or
/// after 96 rounds (`converged` is then false).
struct GjkResult
{
    Simplex simplex;
    bool converged = true;
};
GjkResult gjk(const Solid& A, const Solid& B, double tolerance);

/// The closest points of two separated cores: the result of gjk, polished by Newton's method on the fixed point p = c_A(c_B(p))
/// down to rounding.
struct NearestPair
{
    Vec3 a, b;    ///< closest points on the cores
    Vec3 normal;  ///< unit, from a to b; from the features (a face, two edges) where these define one, hence accurate for any gap
    double gap = 0;
    bool apart = false;  ///< false: the cores touch or overlap, and the other fields are not set
};
NearestPair nearest_pair(const Solid& A, const Solid& B);

}  // namespace plab::detection
