/// A solid against a surface: the inside of a bowl or bore in closed form; triangle meshes by their faces, edges and corners.
///
/// Both work in the frame S of the surface. Normals point from the solid into the material behind the surface.
#pragma once

#include "contact_points.h"
#include "rim_points.h"
#include "solid.h"

namespace plab::detection
{

/// One place where a solid may touch a surface.
struct Meeting
{
    double gap = 0;  ///< m; < 0: overlap
    Vec3 on_solid, on_surface;
    Vec3 normal;  ///< unit
    std::uint32_t feature = 0;
    Pivot pivot{};  ///< A: of the solid
};

/// Receives candidates that are nearer than limit().
class MeetingSink
{
public:
    virtual ~MeetingSink() = default;
    virtual double limit() const = 0;  ///< m
    virtual void offer(const Meeting& meeting) = 0;
    void note_triangles(std::size_t more) { triangles_ += more; }
    std::size_t triangles() const { return triangles_; }  ///< number examined

private:
    std::size_t triangles_ = 0;
};

/// Bowls and bores. A ball may touch the wall and the rim. Of other solids, corners and round ends may touch the wall, and edges
/// that cross the opening the rim. The rim has no face on which something could lie.
void meet_round_wall(const Solid& K, const Collider& wall, MeetingSink& out);
/// Triangles. A ball touches at its closest points (local minima of the distance). Other solids touch with their corners on
/// faces, or at sharp edges and corners of the surface (separation.h).
void meet_triangles(const Solid& K, const Collider& surface, MeetingSink& out);

/// K in the frame W of X_surface; both as in narrow.h.
void collide_with_surface(const Collider& a, const Pose& X_a, const Collider& surface, const Pose& X_surface, ContactPoints& out);
/// The gap is infinite if the solid is completely behind the surface or beyond its border.
Separation separation_from_surface(const Collider& a, const Pose& X_a, const Collider& surface, const Pose& X_surface);

/// Calls visit(corner, number, touching) for the corners of a solid that may be furthest in direction d, the furthest one first for
/// cylinders: all corners of boxes and hulls, the centres of both ends of capsules, points on the rims of cylinders, which touch
/// elsewhere where the cylinder leans (rim_points.h).
template <class Visit>
void visit_corners(const Solid& K, const Vec3& d, Visit&& visit)
{
    const Vec3& h = K.size();
    switch (K.core())
    {
        case Core::Point:
            return visit(K.pose().p, 0u, K.pose().p);
        case Core::Segment:
            for (const std::uint32_t end : {0u, 1u})
            {
                const Vec3 p = K.pose().p + (end == 0 ? -h.z : h.z) * K.axis(2);
                visit(p, end, p);
            }
            return;
        case Core::Box:
            for (std::uint32_t i = 0; i < 8; ++i)
            {
                const Vec3 p = K.from_local({i & 1 ? h.x : -h.x, i & 2 ? h.y : -h.y, i & 4 ? h.z : -h.z});
                visit(p, i, p);
            }
            return;
        case Core::Hull:
            for (std::uint32_t i = 0; i < K.hull().vertices.size(); ++i)
            {
                const Vec3 p = K.from_local(K.hull().vertices[i]);
                visit(p, i, p);
            }
            return;
        case Core::Cylinder:
            for (std::uint32_t end = 0; end < 2; ++end)
            {
                const RimPoints rim = rim_points(K, end == 1, d);
                for (std::uint32_t i = rim.count; i-- > 0;) visit(rim.p[i], 8 * end + rim.id[i], rim.touching(i));
            }
            return;
    }
}

}  // namespace plab::detection
