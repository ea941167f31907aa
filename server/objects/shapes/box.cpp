#include "box.h"

#include "volume_integration.h"

namespace plab::shapes
{

void BoxRows::describe(Schema& schema)
{
    shape.describe(schema);
    schema.param(half_extents, "half_extents", unit::metre, "half of length, width and height along x, y, z").positive();
}

void prepare_box(const StepContext& context, Row row, const BoxRows& boxes, Shapes& shapes)
{
    Geometry geometry;
    geometry.kind = GeometryKind::Box;
    geometry.pose = boxes.shape.pose(row);
    geometry.size = boxes.half_extents[row];
    shapes.geometry[context.facet_of_row[row]] = geometry;
}

void measure_box(Row row, const BoxRows& boxes, MassProperties& solid)
{
    solid = posed(solid_box(boxes.half_extents[row]), boxes.shape.pose(row));
}

}  // namespace plab::shapes
