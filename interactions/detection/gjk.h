/// The nearest points of two convex cores, and the least depth of two that overlap.
#pragma once

#include "solid.h"

namespace plab::detection
{

/// A point of the Minkowski difference A - B with the two points that it comes from.
struct Support
{
    Vec3 w, a, b;
};
Support support_of(const Solid& A, const Solid& B, const Vec3& d);

/// Up to four supports that span the part of A - B nearest to the origin.
struct Simplex
{
    std::array<Support, 4> at{};
    std::size_t count = 0;
    Vec3 nearest;           ///< its point nearest to the origin
    Vec3 nearest_a;         ///< the point of A there
    bool encloses = false;  ///< the origin is inside: the cores overlap
};

/// E. Gilbert, D. Johnson, S. Keerthi, A fast procedure for computing the distance between complex objects, IEEE J.
/// Robotics and Automation 4(2), 1988; the nearest point of a simplex by trying all of its parts, which slivers do not
/// upset. Stops when `tolerance` (m) is reached, when rounding ends its progress, or after 96 rounds (`converged` false).
struct GjkResult
{
    Simplex simplex;
    bool converged = true;
};
GjkResult gjk(const Solid& A, const Solid& B, double tolerance);

/// Where two cores that are apart are nearest: from gjk's answer, polished by Newton's method on the fixed point
/// p = foot_A(foot_B(p)) until rounding.
struct NearestPair
{
    Vec3 a, b;    ///< on the cores
    Vec3 normal;  ///< unit, from a to b; from the features (face, two edges) where they give one, so right at any gap
    double gap = 0;
    bool apart = false;  ///< false: they touch or overlap, the rest is not set
};
NearestPair nearest_pair(const Solid& A, const Solid& B);

}  // namespace plab::detection
