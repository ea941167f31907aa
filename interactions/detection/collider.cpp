#include "collider.h"

#include <cmath>

#include "plab/surface.h"

namespace plab::detection
{
namespace
{
bool positive(double a) { return a > 0 && std::isfinite(a); }
}  // namespace

Collider::Collider(const Geometry& geometry) : source_(geometry)
{
    const Vec3& h = geometry.size;
    switch (geometry.kind)
    {
        case GeometryKind::Sphere:
            kind_ = ColliderKind::Sphere;
            break;
        case GeometryKind::Box:
            if (positive(h.x) && positive(h.y) && positive(h.z))
                kind_ = ColliderKind::Box;
            else
                complaint_ = "a box without volume does not collide";
            break;
        case GeometryKind::Plane:
            kind_ = ColliderKind::Plane;
            break;
        case GeometryKind::Mesh:
            make_hull_of_mesh();
            break;
        case GeometryKind::Capsule:
        case GeometryKind::Cylinder:
            if (positive(h.x) && positive(h.z))
                kind_ = geometry.kind == GeometryKind::Capsule ? ColliderKind::Capsule : ColliderKind::Cylinder;
            else
                complaint_ = "it needs a radius and a length above 0";
            break;
        case GeometryKind::Compound:
        case GeometryKind::None:
            break;
    }
}

void Collider::make_surface()
{
    switch (surface_of(source_))
    {
        case Surface::Bowl:
            kind_ = ColliderKind::Bowl;
            break;
        case Surface::Bore:
            kind_ = ColliderKind::Bore;
            break;
        case Surface::Triangles:
            if (auto triangles = TriangleSurface::make(source_.vertices, source_.triangles); triangles)
                kind_ = ColliderKind::Triangles, triangles_ = triangles.take();
            else
                complaint_ = triangles.error().reason;
            break;
        case Surface::None:
            break;
    }
}

void Collider::make_hull_of_mesh()
{
    if (!source_.hull_collides) return make_surface();
    auto hull = make_hull(source_.vertices);
    if (hull)
    {
        kind_ = ColliderKind::Hull, hull_ = hull.take();
        fills_hollows_ = !fills_hull(source_.vertices, source_.triangles, hull_);
    }
    else
        complaint_ = hull.error().reason;
}

bool Collider::built_from(const Geometry& g) const
{
    if (g.kind != source_.kind || g.pose != source_.pose || g.size != source_.size) return false;
    if (g.kind == GeometryKind::Compound) return g.parts == source_.parts;
    if (g.kind != GeometryKind::Mesh) return true;
    if (g.hull_collides != source_.hull_collides) return false;
    return !(g.hull_collides || surface_of(g) == Surface::Triangles) || g.same_mesh(source_);
}

Vec3 Collider::bound_half() const
{
    const Vec3& h = size();
    switch (kind_)
    {
        case ColliderKind::Sphere:
            return {h.x, h.x, h.x};
        case ColliderKind::Box:
            return h;
        case ColliderKind::Capsule:
            return {h.x, h.x, h.x + h.z};
        case ColliderKind::Cylinder:
            return {h.x, h.x, h.z};
        case ColliderKind::Bowl:
            return {h.x, h.x, 0.5 * (h.z + h.x)};
        case ColliderKind::Bore:
            return {h.x, h.x, h.z};
        case ColliderKind::Triangles:
            return (triangles_.upper() - triangles_.lower()) * 0.5;
        default:
            return (hull_.upper - hull_.lower) * 0.5;
    }
}

Vec3 Collider::bound_center() const
{
    if (kind_ == ColliderKind::Hull) return (hull_.upper + hull_.lower) * 0.5;
    if (kind_ == ColliderKind::Triangles) return (triangles_.upper() + triangles_.lower()) * 0.5;
    return kind_ == ColliderKind::Bowl ? Vec3{0, 0, 0.5 * (size().z - size().x)} : Vec3{};
}

}  // namespace plab::detection
