#include "placed.h"

#include "volume_integration.h"

namespace plab::shapes
{

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
