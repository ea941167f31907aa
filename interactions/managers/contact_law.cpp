#include "contact_law.h"

#include <algorithm>
#include <cmath>

namespace plab::managers
{
namespace
{

/// Of a point that presses with `normal` and would slide: along the slip direction the friction is mu j_n; across it, the direction of tau
/// turns with j and u. Across the slip direction j equals rho u, since tau has no component there. Substituting rho u keeps the rounding
/// errors of j from being amplified by `share`, which is large where sliding begins.
void add_sliding(const Point& p, const Vec3& u, double kappa, double rho, double normal, PointLaw& law)
{
    const double x = p.impulse.x - rho * u.x, y = p.impulse.y - rho * u.y, size = std::hypot(x, y), stiff = kappa * rho;
    const double c = x / size, s = y / size, beta = p.friction * normal / size;
    const double along = p.friction * (p.impulse.z + law.change.z) - (c * p.impulse.x + s * p.impulse.y);
    const double share = std::min(1 / (1 - beta), kappa), turn = rho * beta * share;
    const double across = -rho * (c * u.y - s * u.x) * share;
    law.change.x = along * c - across * s, law.change.y = along * s + across * c;
    Mat3& G = law.G;
    G(0, 0) = turn * s * s, G(0, 1) = G(1, 0) = -turn * c * s, G(1, 1) = turn * c * c;
    G(0, 2) = p.friction * c * stiff, G(1, 2) = p.friction * s * stiff;
}

/// The impulse that the row alone would want at this distance from its target.
double wanted_impulse(const Line& line, double gap) { return line.impulse - gap / line.admittance(); }

}  // namespace

PointLaw law_of(const Point& p, const Vec3& u, double kappa)
{
    PointLaw law;
    if (!(p.K(2, 2) > 0)) return law;
    const double rho = 1 / p.K(2, 2), stiff = kappa * rho;
    law.change = -p.impulse;
    const double normal = p.impulse.z - rho * (u.z - p.least);
    if (normal <= 0) return law;
    law.G(2, 2) = stiff;
    // Written so that the change of an active contact is -rho u itself: the digits of j do not enter.
    law.change.z = -stiff * (u.z - p.least);
    if (!p.frictional()) return law;
    if (piece_of(p, u) == 2)
    {
        add_sliding(p, u, kappa, rho, normal, law);
        return law;
    }
    law.G(0, 0) = law.G(1, 1) = stiff;
    law.change.x = -stiff * u.x, law.change.y = -stiff * u.y;
    return law;
}

LineLaw law_of(const Line& line, double gap, double kappa)
{
    if (line.count == 0) return {};
    const double stiff = line.stiffness(kappa), wanted = wanted_impulse(line, gap);
    const double held = std::clamp(wanted, line.least, line.most);
    return held == wanted ? LineLaw{-stiff * gap, stiff} : LineLaw{held - line.impulse, 0};
}

Vec3 within_cone(const Vec3& tau, double mu, double rho, Mat3* G)
{
    if (G) *G = {};
    const double size = mu > 0 ? std::hypot(tau.x, tau.y) : 0.0;
    // A point exactly on the boundary counts as active, so that a pile at rest starts with all its contacts.
    if (size <= mu * tau.z && tau.z >= 0)
    {
        if (G) *G = mu > 0 ? Mat3::diagonal(rho, rho, rho) : Mat3::diagonal(0, 0, rho);
        return {mu > 0 ? tau.x : 0.0, mu > 0 ? tau.y : 0.0, tau.z};
    }
    if (mu * size <= -tau.z) return {};
    const double share = 1 / (1 + mu * mu), c = tau.x / size, s = tau.y / size, normal = (tau.z + mu * size) * share;
    if (G)
    {
        const double turn = rho * mu * normal / size, along = rho * share * mu * mu, cross_term = rho * share * mu;
        (*G)(0, 0) = turn * s * s + along * c * c, (*G)(1, 1) = turn * c * c + along * s * s;
        (*G)(0, 1) = (*G)(1, 0) = (along - turn) * c * s;
        (*G)(0, 2) = (*G)(2, 0) = cross_term * c, (*G)(1, 2) = (*G)(2, 1) = cross_term * s;
        (*G)(2, 2) = rho * share;
    }
    return {mu * normal * c, mu * normal * s, normal};
}

char piece_of(const Point& p, const Vec3& u)
{
    if (!(p.K(2, 2) > 0)) return 0;
    const double rho = 1 / p.K(2, 2), normal = p.impulse.z - rho * (u.z - p.least);
    if (normal <= 0) return 0;
    const bool slides = p.frictional() && std::hypot(p.impulse.x - rho * u.x, p.impulse.y - rho * u.y) > p.friction * normal;
    return slides ? 2 : 1;
}

char piece_of(const Line& line, double gap)
{
    const double wanted = wanted_impulse(line, gap);
    return line.count > 0 && wanted >= line.least && wanted <= line.most ? 1 : 0;
}

}  // namespace plab::managers
