#include "simulation/contacts/support.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plab/rotation.h"
#include "plab/surface.h"

namespace plab::simulation
{
namespace
{

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// max of d . p over the points of a box.
double support_of_box(const Vec3& lower, const Vec3& upper, const Vec3& d)
{
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += std::max(d[k] * lower[k], d[k] * upper[k]);
    return sum;
}

}  // namespace

double support_of_shape(const Geometry& g, const Shapes& shapes, const Pose& X, const Vec3& m)
{
    const double at = dot(m, X.p);
    const Vec3 l = rotate_back(X.q, m);
    switch (g.kind)
    {
        case GeometryKind::Sphere:
            return at + g.size.x * length(m);
        case GeometryKind::Box:
            return at + std::fabs(l.x) * g.size.x + std::fabs(l.y) * g.size.y + std::fabs(l.z) * g.size.z;
        case GeometryKind::Capsule:
            return at + std::fabs(l.z) * g.size.z + g.size.x * length(m);
        case GeometryKind::Cylinder:
            return at + std::fabs(l.z) * g.size.z + g.size.x * std::hypot(l.x, l.y);
        case GeometryKind::Mesh:
        {
            // A surface may have a million vertices. The box around it is as good here: what is apart from the box is apart from the
            // surface.
            if (g.mesh_digest != 0 && surface_of(g) == Surface::Triangles) return at + support_of_box(g.mesh_lower, g.mesh_upper, l);
            double most = -kUnbounded;
            for (const Vec3& v : g.vertices) most = std::max(most, dot(l, v));
            return at + most;
        }
        case GeometryKind::Compound:
        {
            double most = -kUnbounded;
            for (const std::uint32_t part : g.parts)
            {
                const Geometry& p = shapes.geometry[part];
                most = std::max(most, support_of_shape(p, shapes, X * p.pose, m));
            }
            return most;
        }
        case GeometryKind::Plane:
        case GeometryKind::None:
            break;
    }
    return -kUnbounded;
}

double support(const Bodies& bodies, const Shapes& shapes, std::uint32_t b, const Quat& q, const Vec3& m)
{
    double most = -kUnbounded;
    for (const Ref shape : bodies.shapes[b])
    {
        const Geometry& g = shapes.geometry[shape.index];
        const Pose X{rotate(q, g.pose.p - bodies.center_B[b]), q * g.pose.q};
        most = std::max(most, support_of_shape(g, shapes, X, m));
    }
    return most;
}

}  // namespace plab::simulation
