#include "import/surface_law.h"

#include <algorithm>
#include <cmath>

namespace plab::import
{
namespace
{

bool is_direct(const Solref& s) { return s.first <= 0; }

/// As MuJoCo mixes those of two shapes of equal priority.
Solref mixed(const Solref& a, const Solref& b)
{
    if (is_direct(a) || is_direct(b)) return {std::min(a.first, b.first), std::min(a.second, b.second)};
    return {(a.first + b.first) / 2, (a.second + b.second) / 2};
}

SurfaceLaw law_of_mujoco(int dimensions, const Surface& a, const Surface& b, double restitution)
{
    SurfaceLaw law{.restitution = restitution};
    if (dimensions >= 3) law.friction = std::max(a.friction, b.friction);
    if (dimensions >= 4) law.spinning_friction = std::max(a.twisting, b.twisting);
    if (dimensions >= 6) law.rolling_friction = std::max(a.rolling, b.rolling);
    return law;
}

SurfaceLaw law_of_mujoco(const Surface& a, const Surface& b)
{
    if (a.priority != b.priority)
    {
        const Surface& one = a.priority > b.priority ? a : b;
        return law_of_mujoco(one.dimensions, one, one, rebound_of(spring_of(one.solref)));
    }
    return law_of_mujoco(std::max(a.dimensions, b.dimensions), a, b, rebound_of(spring_of(mixed(a.solref, b.solref))));
}

}  // namespace

SurfaceLaw surface_law(const Surface& a, const Surface& b, SurfaceRule rule)
{
    if (rule == SurfaceRule::MuJoCo) return law_of_mujoco(a, b);
    return {std::min(a.friction, b.friction), std::min(a.restitution, b.restitution)};
}

ContactSpring spring_of(const Solref& s)
{
    if (!is_direct(s)) return {1 / (s.first * s.second), s.second};
    const double frequency = std::sqrt(-s.first);
    return {frequency, frequency > 0 ? std::fabs(s.second) / (2 * frequency) : 1};
}

/// T. Schwager, T. Poeschel, Granular Matter 9 (2007), eq. 16.
double rebound_of(const ContactSpring& spring)
{
    const double z = spring.ratio;
    if (!(z < 1)) return 0;
    const double s = std::sqrt(1 - z * z);
    return std::exp(-z / s * std::atan2(2 * z * s, 2 * z * z - 1));
}

}  // namespace plab::import
