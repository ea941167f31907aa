#include "composed.h"

#include "built_mesh.h"
#include "volume_integration.h"

namespace plab::shapes
{

void CompoundRows::describe(Schema& schema)
{
    shape.describe(schema);
    schema.role(parts, "parts", {Facet::Shape}, "the shapes that it is made of; no planes and no compounds");
}

Result<void> prepare_compound(const StepContext& context, Row row, const CompoundRows& compounds, Shapes& shapes)
{
    Geometry geometry;
    geometry.kind = GeometryKind::Compound;
    geometry.pose = compounds.shape.pose(row);
    BuiltMesh picture;
    for (const Ref part : compounds.parts[row])
    {
        const Geometry& g = shapes.geometry[part.index];
        if (g.kind == GeometryKind::None) return reason("a part has no geometry; it must not refer back to this compound");
        if (g.kind == GeometryKind::Plane)
            return reason("a plane is unbounded and cannot be a part; give it to the body as a shape of its own");
        if (g.kind == GeometryKind::Compound) return reason("a compound cannot be a part of another; name its parts instead");
        geometry.parts.push_back(part.index);
        picture.append(picture_of(g));
    }
    geometry.set_mesh(std::move(picture.vertices), std::move(picture.triangles));
    shapes.geometry[context.facet_of_row[row]] = std::move(geometry);
    return {};
}

Result<void> measure_compound(Row row, const CompoundRows& compounds, const Shapes& shapes, MassProperties& solid)
{
    std::vector<MassProperties> parts;
    for (const Ref part : compounds.parts[row])
    {
        if (!shapes.unmeasurable[part.index].empty()) return reason(shapes.unmeasurable[part.index]);
        parts.push_back(shapes.solid[part.index]);
    }
    solid = posed(joined(parts), compounds.shape.pose(row));
    return {};
}

void PlacedRows::describe(Schema& schema)
{
    shape.describe(schema);
    schema.role(of, "of", {Facet::Shape}, "the shape to be placed");
}

Result<void> prepare_placed(const StepContext& context, Row row, const PlacedRows& placed, Shapes& shapes)
{
    Geometry geometry = shapes.geometry[placed.of[row].index];
    if (geometry.kind == GeometryKind::None) return reason("the placed shape has no geometry; it must not refer back to this one");
    geometry.pose = placed.shape.pose(row) * geometry.pose;
    shapes.geometry[context.facet_of_row[row]] = std::move(geometry);
    return {};
}

Result<void> measure_placed(Row row, const PlacedRows& placed, const Shapes& shapes, MassProperties& solid)
{
    const std::uint32_t of = placed.of[row].index;
    if (!shapes.unmeasurable[of].empty()) return reason(shapes.unmeasurable[of]);
    solid = posed(shapes.solid[of], placed.shape.pose(row));
    return {};
}

}  // namespace plab::shapes
