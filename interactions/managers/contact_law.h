/// The laws of a contact point and of a row, linearised in the piece in which each of them is.
///
/// With tau = j - rho (u - least) and P the projection of the law (newton.h), a Newton step wants dj = change - G du, with change = P(tau)
/// - j and G = rho P'(tau).
#pragma once

#include "problem.h"

namespace plab::managers
{

struct PointLaw
{
    Vec3 change;  ///< N s, contact coordinates (t1, t2, n)
    Mat3 G;       ///< kg
};
struct LineLaw
{
    double change = 0, G = 0;
};

/// Whether the point presses, sticks or slides is decided from tau with rho = 1 / K, for which impulses and velocities have the same
/// weight; the active directions then use the stiffer rho = kappa / K. A point that nothing can move has no law.
PointLaw law_of(const Point& p, const Vec3& u, double kappa);
LineLaw law_of(const Line& line, double gap, double kappa);

/// The point of the cone |j_t| <= mu j_n that is nearest to tau; G, if asked for: rho times the derivative of this projection.
Vec3 within_cone(const Vec3& tau, double mu, double rho, Mat3* G);

/// The piece of the law that a point is in: 0 separated, 1 sticking (or without friction), 2 sliding; as law_of decides it.
char piece_of(const Point& p, const Vec3& u);
/// 1 where a row acts within its bounds, or 0.
char piece_of(const Line& line, double gap);

}  // namespace plab::managers
