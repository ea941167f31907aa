#include "relation.h"

#include <algorithm>
#include <cmath>

namespace plab::rules
{

const std::vector<std::string>& relation_names()
{
    static const std::vector<std::string> names{"near", "touching", "coaxial", "meshing", "inside"};
    return names;
}

Kind relation_of(const std::string& name)
{
    const auto& names = relation_names();
    return static_cast<Kind>(std::find(names.begin(), names.end(), name) - names.begin());
}

Measures measure(const Place& a, const Place& b)
{
    const Vec3 z_a = rotate(a.X.q, {0, 0, 1}), z_b = rotate(b.X.q, {0, 0, 1});
    const Vec3 d = b.X.p - a.X.p;
    Measures out;
    out.distance = length(d), out.along = dot(d, z_a);
    out.radial = length(d - out.along * z_a);
    out.angle = std::atan2(length(cross(z_a, z_b)), std::fabs(dot(z_a, z_b)));
    return out;
}

bool holds(const Bounds& bounds, const Measures& m, double radius_a, double radius_b, double slack)
{
    if (m.distance > slack * bounds.reach || std::fabs(m.along) > slack * bounds.along || m.angle > slack * bounds.angle) return false;
    const double tolerance = slack * bounds.tolerance;
    switch (bounds.kind)
    {
        case Kind::Near:
            return true;
        case Kind::Touching:
            return m.distance - (radius_a + radius_b) <= tolerance;
        case Kind::Coaxial:
            return m.radial <= tolerance;
        case Kind::Meshing:
            return std::fabs(m.radial - (radius_a + radius_b)) <= tolerance;
        case Kind::Inside:
            return std::fabs(m.radial - std::fabs(radius_a - radius_b)) <= tolerance;
    }
    return false;
}

}  // namespace plab::rules
