#include "collider.h"

namespace plab::detection
{

bool start_ode()
{
    // Closed when the plugin goes; all spaces are gone by then, with the worlds that held them.
    struct Ode
    {
        bool started = dInitODE2(0) != 0;
        Ode() = default;
        Ode(const Ode&) = delete;
        Ode& operator=(const Ode&) = delete;
        ~Ode()
        {
            if (started) dCloseODE();
        }
    };
    static const Ode ode;
    return ode.started && dAllocateODEDataForThread(dAllocateFlagCollisionData) != 0;
}

Collider::Collider(const Geometry& geometry) : source_(geometry)
{
    switch (geometry.kind)
    {
        case GeometryKind::Sphere:
            kind_ = ColliderKind::Sphere;
            break;
        case GeometryKind::Box:
            make_box();
            break;
        case GeometryKind::Plane:
            kind_ = ColliderKind::Plane;
            break;
        case GeometryKind::Mesh:
            if (!geometry.hull_collides) break;
            if (auto hull = make_hull(geometry.vertices); hull)
                kind_ = ColliderKind::Hull, hull_ = hull.take();
            else
                complaint_ = hull.error().reason;
            break;
        case GeometryKind::None:
            break;
    }
}

void Collider::make_box()
{
    const Vec3& h = size();
    std::array<Vec3, 8> corners;
    for (std::size_t i = 0; i < 8; ++i) corners[i] = {i & 1 ? h.x : -h.x, i & 2 ? h.y : -h.y, i & 4 ? h.z : -h.z};
    auto hull = make_hull(corners);
    if (!hull)
    {
        complaint_ = "a box without volume does not collide";
        return;
    }
    kind_ = ColliderKind::Box, hull_ = hull.take();
    for (GeomHandle& probe : probes_) probe.reset(dCreateBox(nullptr, 2 * h.x, 2 * h.y, 2 * h.z));
}

bool Collider::built_from(const Geometry& g) const
{
    if (g.kind != source_.kind || g.pose != source_.pose || g.size != source_.size) return false;
    if (g.kind != GeometryKind::Mesh) return true;
    if (g.hull_collides != source_.hull_collides) return false;
    return !g.hull_collides || g.vertices == source_.vertices;
}

Vec3 Collider::bound_half() const
{
    if (kind_ == ColliderKind::Sphere) return {size().x, size().x, size().x};
    return kind_ == ColliderKind::Box ? size() : (hull_.upper - hull_.lower) * 0.5;
}

Vec3 Collider::bound_center() const { return kind_ == ColliderKind::Hull ? (hull_.upper + hull_.lower) * 0.5 : Vec3{}; }

dxGeom* Collider::probe(int side, const Pose& X) const
{
    dxGeom* geom = probes_[static_cast<std::size_t>(side)].get();
    set_pose(geom, X);
    return geom;
}

}  // namespace plab::detection
