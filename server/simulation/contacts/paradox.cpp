#include "simulation/contacts/paradox.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "simulation/contacts/contacts.h"

namespace plab::simulation
{
namespace
{

/// A contact that slides less than this fraction of the radius of gyration in a step counts as sticking.
constexpr double kNoSlip = 0x1p-24;

/// Adds n . K n and n . K j of a body: the changes of the velocity at p along n by unit impulses there along n, and by an impulse j. The
/// levers are rotated into the axes of the body, which costs less than rotating its inertia.
void add_couplings(const Bodies& bodies, std::uint32_t b, const Vec3& p, const Vec3& n, const Vec3& j, double& of_n, double& of_j)
{
    if (!bodies.dynamic(b)) return;
    const Vec3 r = p - bodies.position[b];
    const Mat3 R = rotation_matrix(bodies.orientation[b]);
    const Vec3 lever = transposed_times(R, cross(r, n)), turn = bodies.inverse_inertia_B[b] * lever;
    of_n += bodies.inverse_mass[b] + dot(turn, lever);
    of_j += bodies.inverse_mass[b] * dot(n, j) + dot(turn, transposed_times(R, cross(r, j)));
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
    double alone = 0, sliding = 0;
    for (const std::uint32_t b : both) add_couplings(bodies, b, c.point, c.normal, force, alone, sliding);
    return alone > 0 ? sliding / alone : 1;
}

double wedging(const Bodies& bodies, std::uint32_t body, const Vec3& extents, double radius)
{
    if (!bodies.dynamic(body)) return 0;
    const Mat3& A = bodies.inverse_inertia_B[body];
    const double x = extents.x * extents.x, y = extents.y * extents.y, z = extents.z * extents.z;
    // No eigenvalue of A is larger than the largest sum of a row.
    double most = 0, aside = 0;
    for (int i = 0; i < 3; ++i)
    {
        const double others = std::fabs(A(i, (i + 1) % 3)) + std::fabs(A(i, (i + 2) % 3));
        most = std::max(most, std::fabs(A(i, i)) + others), aside += others;
    }
    most *= radius * radius;
    if (aside == 0 && std::isfinite(x + y + z))
    {
        const double sum = A(0, 0) * (y + z) + A(1, 1) * (z + x) + A(2, 2) * (x + y);
        const double product = (A(1, 1) * A(2, 2) * x + A(2, 2) * A(0, 0) * y + A(0, 0) * A(1, 1) * z) * (x + y + z);
        most = std::min(most, 0.5 * (sum + std::sqrt(std::max(0.0, sum * sum - 4 * product))));
    }
    return bodies.mass[body] * most;
}

}  // namespace plab::simulation
