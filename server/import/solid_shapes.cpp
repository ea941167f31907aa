#include "import/solid_shapes.h"

#include <numbers>

#include "objects/shapes/volume_integration.h"

namespace plab::import
{
namespace
{

/// m = 4/3 pi a b c, I_xx = m (b^2 + c^2) / 5, ...
MassProperties solid_ellipsoid(const Vec3& s)
{
    const double m = 4.0 / 3.0 * std::numbers::pi * s.x * s.y * s.z;
    const double xx = s.x * s.x, yy = s.y * s.y, zz = s.z * s.z;
    return {m, {}, Mat3::diagonal(m * (yy + zz) / 5, m * (xx + zz) / 5, m * (xx + yy) / 5)};
}

}  // namespace

Result<MassProperties> solid_of(const RobotShape& shape)
{
    switch (shape.kind)
    {
        case ShapeKind::Box:
            return shapes::solid_box(shape.size);
        case ShapeKind::Sphere:
            return shapes::solid_sphere(shape.size.x);
        case ShapeKind::Cylinder:
            return shapes::solid_cylinder(shape.size.x, 2 * shape.size.z);
        case ShapeKind::Capsule:
            return shapes::solid_capsule(shape.size.x, 2 * shape.size.z);
        case ShapeKind::Ellipsoid:
            return solid_ellipsoid(shape.size);
        case ShapeKind::Mesh:
            return shapes::solid_mesh(shape.mesh->vertices, shape.mesh->triangles);
        default:
            return MassProperties{};
    }
}

}  // namespace plab::import
