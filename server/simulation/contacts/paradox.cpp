#include "simulation/contacts/paradox.h"

#include <array>

#include "simulation/contacts/contacts.h"

namespace plab::simulation
{
namespace
{

/// A contact that slides less than this fraction of the radius of gyration in a step counts as sticking.
constexpr double kNoSlip = 0x1p-24;

/// n . K j: the change of the velocity at p along n by an impulse j there. K is symmetric, so n and j may be exchanged.
double coupling(const Bodies& bodies, std::uint32_t b, const Vec3& p, const Vec3& n, const Vec3& j)
{
    if (!bodies.dynamic(b)) return 0;
    const Vec3 r = p - bodies.position[b];
    return bodies.inverse_mass[b] * dot(n, j) + dot(cross(r, n), bodies.inverse_inertia_W(b) * cross(r, j));
}

}  // namespace

double pressing_share(const Bodies& bodies, const Contact& c, double h)
{
    if (!(c.friction > 0)) return 1;
    const Vec3 u = bodies.velocity_at(c.b.index, c.point) - bodies.velocity_at(c.a.index, c.point);
    const Vec3 slip = u - c.normal * dot(u, c.normal);
    const double speed = length(slip);
    const std::array<std::uint32_t, 2> both{c.a.index, c.b.index};
    if (!(speed * h > kNoSlip * least_gyration(bodies, both))) return 1;
    const Vec3 force = c.normal - slip * (c.friction / speed);
    const auto sum = [&](const Vec3& j)
    { return coupling(bodies, c.a.index, c.point, c.normal, j) + coupling(bodies, c.b.index, c.point, c.normal, j); };
    const double alone = sum(c.normal);
    return alone > 0 ? sum(force) / alone : 1;
}

}  // namespace plab::simulation
