#include "meshes.h"

#include "plab/convex_hull.h"
#include "plab/surface.h"
#include "volume_integration.h"

namespace plab::shapes
{

namespace
{

Result<std::vector<Vec3>> vertices_of(const Reals& numbers)
{
    if (numbers.empty() || numbers.size() % 3 != 0)
        return reason("vertices must be triples x y z, not " + std::to_string(numbers.size()) + " numbers");
    std::vector<Vec3> out;
    out.reserve(numbers.size() / 3);
    for (std::size_t i = 0; i < numbers.size(); i += 3)
    {
        out.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
        if (!is_finite(out.back())) return reason("vertex " + std::to_string(i / 3) + " must be finite");
    }
    return out;
}

Result<std::vector<std::uint32_t>> triangles_of(const Integers& numbers, std::size_t vertex_count)
{
    if (numbers.empty() || numbers.size() % 3 != 0)
        return reason("triangles must be triples of vertex numbers, not " + std::to_string(numbers.size()) + " numbers");
    std::vector<std::uint32_t> out;
    out.reserve(numbers.size());
    for (const std::int64_t n : numbers)
    {
        if (n < 0 || static_cast<std::uint64_t>(n) >= vertex_count)
            return reason("triangle " + std::to_string(out.size() / 3) + " names vertex " + std::to_string(n) +
                          "; vertices are numbered from 0 to " + std::to_string(vertex_count - 1));
        out.push_back(static_cast<std::uint32_t>(n));
    }
    return out;
}

}  // namespace

void MeshRows::describe(Schema& schema)
{
    shape.describe(schema);
    schema.param(vertices, "vertices", unit::metre, "x y z of each vertex, in the shape's frame");
    schema.param(triangles, "triangles", unit::one, "three vertex numbers (from 0) per triangle, counter-clockwise seen from outside");
    schema
        .param(hull_collides, "hull_collides", unit::one,
               "the mesh is drawn and integrated as given; it collides as its convex hull (true) or not at all (false)")
        .or_else(true);
    schema
        .param(surface_collides, "surface_collides", unit::one,
               "it collides as a surface, from the side from which its triangles are counter-clockwise, concave or not; "
               "for bodies that are not dynamic. hull_collides is then ignored")
        .or_else(false);
}

Result<void> prepare_mesh(const StepContext& context, Row row, const MeshRows& meshes, Shapes& shapes)
{
    auto vertices = vertices_of(meshes.vertices[row]);
    if (!vertices) return vertices.error();
    auto triangles = triangles_of(meshes.triangles[row], vertices->size());
    if (!triangles) return triangles.error();

    Geometry geometry;
    geometry.kind = GeometryKind::Mesh;
    geometry.pose = meshes.shape.pose(row);
    geometry.set_mesh(vertices.take(), triangles.take());
    if (meshes.surface_collides[row])
        set_surface(geometry, Surface::Triangles);
    else
        geometry.hull_collides = meshes.hull_collides[row];
    shapes.geometry[context.facet_of_row[row]] = std::move(geometry);
    return {};
}

Result<void> measure_mesh(Row row, const MeshRows& meshes, MassProperties& solid)
{
    const auto vertices = vertices_of(meshes.vertices[row]);
    if (!vertices) return vertices.error();
    const auto triangles = triangles_of(meshes.triangles[row], vertices->size());
    if (!triangles) return triangles.error();
    return measure_mesh_in_body(*vertices, *triangles, meshes.shape.pose(row), solid);
}

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
    std::vector<std::uint32_t> triangles = triangles_of(*hull);
    geometry.set_mesh(std::move(hull->vertices), std::move(triangles));
    geometry.hull_collides = true;
    shapes.geometry[context.facet_of_row[row]] = std::move(geometry);
    return {};
}

Result<void> measure_convex_hull(Row row, const ConvexHullRows& hulls, const Shapes& shapes, MassProperties& solid)
{
    const auto hull = hull_of(row, hulls, shapes);
    if (!hull) return hull.error();
    return measure_mesh_in_body(hull->vertices, triangles_of(*hull), hulls.shape.pose(row), solid);
}

}  // namespace plab::shapes
