#include "import/component_text.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "blueprint/writer.h"
#include "model/numbers.h"
#include "objects/shapes/built_mesh.h"
#include "plab/convex_hull.h"

namespace plab::import
{
namespace
{

using model::format_real;

std::string triple(const Vec3& v) { return format_real(v.x) + " " + format_real(v.y) + " " + format_real(v.z); }

std::string mesh_attributes(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles, const RobotShape& shape)
{
    std::string points, corners;
    for (const Vec3& v : vertices) points += (points.empty() ? "" : " ") + triple(v);
    for (const std::uint32_t i : triangles) corners += (corners.empty() ? "" : " ") + std::to_string(i);
    return attribute("vertices", points) + attribute("triangles", corners) +
           (shape.is_surface ? attribute("surface_collides", "true") : attribute("hull_collides", shape.collides ? "true" : "false"));
}

/// What a shape looks like, in its own frame.
shapes::BuiltMesh picture(const RobotShape& shape)
{
    Geometry g;
    g.size = shape.size;
    g.kind = shape.kind == ShapeKind::Box        ? GeometryKind::Box
             : shape.kind == ShapeKind::Capsule  ? GeometryKind::Capsule
             : shape.kind == ShapeKind::Cylinder ? GeometryKind::Cylinder
                                                 : GeometryKind::Sphere;
    if (shape.kind == ShapeKind::Ellipsoid) g.size = {1, 1, 1};
    shapes::BuiltMesh mesh = shapes::picture_of(g);
    if (shape.kind == ShapeKind::Ellipsoid)
        for (Vec3& v : mesh.vertices) v = {v.x * shape.size.x, v.y * shape.size.y, v.z * shape.size.z};
    return mesh;
}

/// Type and size of a shape that collides as what it is.
std::pair<std::string_view, std::string> solid(const RobotShape& shape)
{
    switch (shape.kind)
    {
        case ShapeKind::Box:
            return {"Shape/Box", attribute("half_extents", shape.size)};
        case ShapeKind::Sphere:
            return {"Shape/Sphere", attribute("radius", shape.size.x)};
        case ShapeKind::Cylinder:
            return {"Shape/Cylinder", attribute("radius", shape.size.x) + attribute("height", 2 * shape.size.z)};
        case ShapeKind::Capsule:
            return {"Shape/Capsule", attribute("radius", shape.size.x) + attribute("length", 2 * shape.size.z)};
        default:
            return {"Shape/Plane", ""};
    }
}

}  // namespace

std::string Ids::make(std::string_view given)
{
    // Ids are made of other ids, too.
    const std::string name = (given.starts_with(prefix_) ? "" : prefix_) + std::string(given);
    std::string id;
    for (const char c : std::string_view(name).substr(0, 150)) id += static_cast<unsigned char>(c) <= ' ' || c == 0x7f ? '_' : c;
    while (!id.empty() && id.size() < name.size() && (static_cast<unsigned char>(name[id.size()]) & 0xC0) == 0x80) id.pop_back();
    if (id.empty() || id == "*") id = "unnamed";
    std::string unique = id;
    for (std::size_t& n = next_[id]; !taken_.insert(unique).second;) unique = id + "." + std::to_string(++n);
    return unique;
}

std::string attribute(std::string_view name, std::string_view value)
{
    return " " + std::string(name) + "=\"" + blueprint::escape_attribute(value) + "\"";
}
std::string attribute(std::string_view name, double value) { return attribute(name, format_real(value)); }
std::string attribute(std::string_view name, const Vec3& v) { return attribute(name, triple(v)); }
std::string attribute(std::string_view name, const Quat& q)
{
    return attribute(name, format_real(q.w) + " " + format_real(q.x) + " " + format_real(q.y) + " " + format_real(q.z));
}

std::string bound(std::string_view name, double value) { return std::isfinite(value) ? attribute(name, value) : std::string(); }

std::string component(const std::string& id, std::string_view type, const std::string& attributes)
{
    return "<component" + attribute("id", id) + attribute("type", type) + attributes + "/>";
}

bool is_convex(const TriangleMesh& mesh)
{
    const auto hull = make_convex_hull(mesh.vertices);
    return hull && fills_hull(mesh.vertices, mesh.triangles, *hull);
}

std::string shape_component(const RobotShape& shape, const std::string& id)
{
    std::string common;
    if (!(shape.pose.p == Vec3{})) common += attribute("position", shape.pose.p);
    if (!(shape.pose.q == Quat{})) common += attribute("orientation", shape.pose.q);
    if (shape.color) common += attribute("color", *shape.color);
    if (shape.mesh) return component(id, "Shape/Mesh", common + mesh_attributes(shape.mesh->vertices, shape.mesh->triangles, shape));
    if (shape.kind == ShapeKind::Ellipsoid || (!shape.collides && shape.kind != ShapeKind::Plane))
    {
        const shapes::BuiltMesh mesh = picture(shape);
        return component(id, "Shape/Mesh", common + mesh_attributes(mesh.vertices, mesh.triangles, shape));
    }
    const auto [type, size] = solid(shape);
    return component(id, type, size + common);
}

std::string mass_attributes(const MassProperties& mass)
{
    const Mat3& I = mass.inertia;
    std::string moments = triple({I(0, 0), I(1, 1), I(2, 2)});
    if (I(0, 1) != 0 || I(0, 2) != 0 || I(1, 2) != 0) moments += " " + triple({I(0, 1), I(0, 2), I(1, 2)});
    return attribute("mass", mass.mass) + attribute("center_of_mass", mass.center) + attribute("inertia", moments);
}

std::optional<Vec3> take_color(std::vector<RobotShape>& shapes)
{
    if (std::ranges::none_of(shapes, [](const RobotShape& s) { return s.color.has_value(); })) return {};
    constexpr Vec3 kPlain{0.8, 0.8, 0.8};  // the default of Shape/*
    Vec3 body;
    for (const RobotShape& s : shapes)
        for (int k = 0; k < 3; ++k) body[k] = std::max(body[k], s.color.value_or(kPlain)[k]);
    for (RobotShape& s : shapes)
    {
        Vec3 rest = s.color.value_or(kPlain);
        for (int k = 0; k < 3; ++k) rest[k] = body[k] > 0 ? rest[k] / body[k] : 1;
        s.color = rest;
    }
    return body;
}

std::string camera(const Assembly& assembly)
{
    Vec3 low{kInfinity, kInfinity, kInfinity}, high = -low;
    double size = 0.1;
    for (const PlacedBody& b : assembly.bodies)
        for (const RobotShape& s : b.shapes)
        {
            const Vec3 p = b.X_WB * s.pose.p;
            for (int k = 0; s.kind != ShapeKind::Plane && k < 3; ++k)
                low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]), size = std::max(size, s.size[k]);
        }
    if (!(low.x <= high.x)) return {};
    const Vec3 center = (low + high) * 0.5, from = Vec3{1.6, -2.2, 0.8} * (length(high - low) / 2 + size);
    return "<camera id=\"front\"" + attribute("position", center + from) + attribute("look_at", center) + "/>";
}

}  // namespace plab::import
