#include "simulation/events/extent.h"

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

double largest_radius(const Geometry& g, const Shapes& shapes)
{
    double r = 0;
    switch (g.kind)
    {
        case GeometryKind::Sphere:
            return g.size.x;
        case GeometryKind::Box:
            return length(g.size);
        case GeometryKind::Plane:
            return kUnbounded;
        case GeometryKind::Capsule:
            return g.size.x + g.size.z;
        case GeometryKind::Cylinder:
            return std::hypot(g.size.x, g.size.z);
        case GeometryKind::Mesh:
            for (const Vec3& v : g.vertices) r = std::max(r, length(v));
            return r;
        case GeometryKind::Compound:
            for (const std::uint32_t part : g.parts)
                r = std::max(r, length(shapes.geometry[part].pose.p) + largest_radius(shapes.geometry[part], shapes));
            return r;
        case GeometryKind::None:
            return 0;
    }
    return 0;
}

}  // namespace

BodyExtent extent_of(const Bodies& bodies, const Shapes& shapes, std::uint32_t b)
{
    BodyExtent out;
    const auto add = [&](std::uint32_t shape, const Pose& in_body)
    {
        const Geometry& g = shapes.geometry[shape];
        const double offset = length(in_body.p - bodies.center_B[b]), radius = largest_radius(g, shapes);
        out.shapes.push_back({offset + radius, g.kind == GeometryKind::Sphere ? offset : offset + radius, surface_of(g) == Surface::None,
                              g.kind == GeometryKind::Plane, g.kind == GeometryKind::None ? kNoIndex : shape, in_body});
    };
    for (const Ref shape : bodies.shapes[b])
    {
        const Geometry& g = shapes.geometry[shape.index];
        if (g.kind != GeometryKind::Compound) add(shape.index, g.pose);
        for (const std::uint32_t part : g.parts) add(part, g.pose * shapes.geometry[part].pose);
    }
    std::size_t solids = 0;
    for (const ShapeExtent& s : out.shapes)
    {
        if (s.shape == kNoIndex) continue;
        static_cast<ShapeExtent&>(out) = {
            std::max(out.radius, s.radius), std::max(out.arm, s.arm), s.convex && ++solids == 1, s.is_plane, s.shape, s.in_body};
    }
    out.is_plane = out.is_plane && out.convex;
    if (!out.convex) out.shape = kNoIndex;
    out.principal = principal_extent_of(bodies, shapes, b);
    return out;
}

Vec3 support_point(const Bodies& bodies, const Shapes& shapes, std::uint32_t b, const ShapeExtent& extent, const Quat& q, const Vec3& m)
{
    const Geometry& g = shapes.geometry[extent.shape];
    const Quat turn = q * extent.in_body.q;
    const Vec3 from = rotate(q, extent.in_body.p - bodies.center_B[b]), l = rotate_back(turn, m);
    const auto side = [](double x) { return x < 0 ? -1.0 : 1.0; };
    const double round = g.size.x / length(m);
    switch (g.kind)
    {
        case GeometryKind::Sphere:
            return from + m * round;
        case GeometryKind::Box:
            return from + rotate(turn, {side(l.x) * g.size.x, side(l.y) * g.size.y, side(l.z) * g.size.z});
        case GeometryKind::Capsule:
            return from + rotate(turn, {0, 0, side(l.z) * g.size.z}) + m * round;
        case GeometryKind::Cylinder:
        {
            const double across = std::hypot(l.x, l.y), share = across > 0 ? g.size.x / across : 0;
            return from + rotate(turn, {l.x * share, l.y * share, side(l.z) * g.size.z});
        }
        case GeometryKind::Mesh:
        {
            Vec3 best;
            double most = -kUnbounded;
            for (const Vec3& v : g.vertices)
                if (const double d = dot(l, v); d > most) most = d, best = v;
            return from + rotate(turn, best);
        }
        default:
            return from;
    }
}

double support(const Bodies& bodies, const Shapes& shapes, std::uint32_t b, const ShapeExtent& extent, const Quat& q, const Vec3& m)
{
    if (extent.shape == kNoIndex) return support(bodies, shapes, b, q, m);
    const Pose X{rotate(q, extent.in_body.p - bodies.center_B[b]), q * extent.in_body.q};
    return support_of_shape(shapes.geometry[extent.shape], shapes, X, m);
}

}  // namespace plab::simulation
