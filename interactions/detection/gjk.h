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
/// points loses digits. nearest_pair() therefore lets GJK find only roughly where they are, and polishes the result: it solves
/// p = c_A(c_B(p)) by Newton's method, where c_A and c_B map a point to the closest point of A and of B (Solid::closest_point), with
/// analytic derivatives. The normal is then taken from the features that meet. A support along it proves the gap; if it does not, GJK
/// goes on with a smaller tolerance.
#pragma once

#include <cmath>

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
    double least = 0;       ///< m: the distance is proven to be at least this
    bool encloses = false;  ///< the origin is inside, so the cores overlap

    /// The same points of the cores after B has moved.
    Simplex with_b_moved(const Vec3& by) const;
};

/// When gjk() has found out enough, m.
struct GjkGoal
{
    double tolerance = 0;        ///< the distance is known to this
    double tolerance_apart = 0;  ///< the same, if the cores are proven to be apart
    double beyond = HUGE_VAL;    ///< the distance is proven to be larger
};

/// E. Gilbert, D. Johnson, S. Keerthi, A fast procedure for computing the distance between complex objects, IEEE J. Robotics and
/// Automation 4(2), 1988. The nearest point of the simplex is found by trying all its vertices, edges and faces, which is robust
/// for nearly degenerate simplices. Goes on from the given simplex, or begins if that has no points, until a goal is reached, rounding
/// prevents progress, or 96 rounds have been made.
void gjk(const Solid& A, const Solid& B, const GjkGoal& goal, Simplex& simplex);

/// The closest points of two separated cores: the result of gjk, polished by Newton's method on the fixed point p = c_A(c_B(p))
/// down to rounding.
struct NearestPair
{
    Vec3 a, b;    ///< closest points on the cores
    Vec3 normal;  ///< unit, from a to b; from the features (a face, two edges) where these define one, hence accurate for any gap
    double gap = 0;
    bool apart = false;   ///< false: the cores touch or overlap, and the fields above are not set
    bool beyond = false;  ///< the gap is larger than asked for: `gap` is a lower bound, and the points and the normal are not set
    bool proven = false;  ///< planes perpendicular to the normal separate the cores by the gap
};
/// `beyond`, m: cores with a larger gap only need a proof that they are apart by more. `simplex`: where to begin (no points: anywhere), and
/// then where GJK ended. `guess`: a point near the closest one of A, where the simplex has the corners that meet; GJK then runs only if
/// this does not lead to closest points that are proven.
NearestPair nearest_pair(const Solid& A, const Solid& B, double beyond, Simplex& simplex, const Vec3* guess = nullptr);

/// One step of Newton's method from the guess: `proven` says whether it was enough.
NearestPair nearest_pair_near(const Solid& A, const Solid& B, const Simplex& simplex, const Vec3& guess);

}  // namespace plab::detection
