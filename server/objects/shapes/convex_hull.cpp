#include "convex_hull.h"

#include "plab/convex_hull.h"
#include "volume_integration.h"

namespace plab::shapes
{
namespace
{

/// All points in S; those of a mesh at the place given by the mesh's own pose.
Result<std::vector<Vec3>> points_of(Row row, const ConvexHullRows& hulls, const Shapes& shapes)
{
    const Reals& numbers = hulls.points[row];
    if (numbers.size() % 3 != 0) return reason("points must be triples x y z, not " + std::to_string(numbers.size()) + " numbers");
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < numbers.size(); i += 3) out.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
    if (!hulls.of[row].valid()) return out;
    const Geometry& mesh = shapes.geometry[hulls.of[row].index];
    if (mesh.vertices.empty()) return reason("`of` must name a shape that is made of vertices, such as a Shape/Mesh");
    for (const Vec3& v : mesh.vertices) out.push_back(mesh.pose * v);
    return out;
}

Result<ConvexHull> hull_of(Row row, const ConvexHullRows& hulls, const Shapes& shapes)
{
    const auto points = points_of(row, hulls, shapes);
    if (!points) return points.error();
    if (points->empty()) return reason("it needs `points`, or a mesh in the role `of`");
    return make_convex_hull(*points);
}

std::vector<std::uint32_t> triangles_of(const ConvexHull& hull)
{
    std::vector<std::uint32_t> out;
    for (const auto& face : hull.faces) out.insert(out.end(), face.begin(), face.end());
    return out;
}

}  // namespace

void ConvexHullRows::describe(Schema& schema)
{
    shape.describe(schema);
    schema.param(points, "points", unit::metre, "x y z of each point, in the shape's frame; those inside the others do not matter")
        .or_else({});
    schema.role(of, "of", {Facet::Shape}, "a mesh whose vertices are added to the points").optional();
}

Result<void> prepare_convex_hull(const StepContext& context, Row row, const ConvexHullRows& hulls, Shapes& shapes)
{
    auto hull = hull_of(row, hulls, shapes);
    if (!hull) return hull.error();
    Geometry geometry;
    geometry.kind = GeometryKind::Mesh;
    geometry.pose = hulls.shape.pose(row);
    geometry.triangles = triangles_of(*hull);
    geometry.vertices = std::move(hull->vertices);
    geometry.hull_collides = true;
    shapes.geometry[context.facet_of_row[row]] = std::move(geometry);
    return {};
}

Result<void> measure_convex_hull(Row row, const ConvexHullRows& hulls, const Shapes& shapes, MassProperties& solid)
{
    const auto hull = hull_of(row, hulls, shapes);
    if (!hull) return hull.error();
    const auto solid_S = solid_mesh(hull->vertices, triangles_of(*hull));
    if (!solid_S) return solid_S.error();
    solid = posed(*solid_S, hulls.shape.pose(row));
    return {};
}

}  // namespace plab::shapes
