#include "bench/peers/scene.h"

namespace plab::peers
{

BodySpec sphere(double radius, double mass, const Vec3& position)
{
    BodySpec b;
    b.form = Form::Sphere;
    b.half = {radius, radius, radius};
    b.mass = mass;
    b.inertia = b.half * (0.4 * mass * radius);
    b.position = position;
    return b;
}

BodySpec box(const Vec3& half, double mass, const Vec3& position)
{
    const double x = half.x * half.x, y = half.y * half.y, z = half.z * half.z;
    BodySpec b;
    b.form = Form::Box;
    b.half = half;
    b.mass = mass;
    b.inertia = Vec3{y + z, x + z, x + y} * (mass / 3);
    b.position = position;
    return b;
}

}  // namespace plab::peers
