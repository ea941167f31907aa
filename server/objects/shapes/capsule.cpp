#include "capsule.h"

#include "volume_integration.h"

namespace plab::shapes
{

void CapsuleRows::describe(Schema& schema)
{
    shape.describe(schema);
    schema.param(radius, "radius", unit::metre, "radius").positive();
    schema.param(length, "length", unit::metre, "of the straight part along z, between the centres of the round ends").positive();
}

void prepare_capsule(const StepContext& context, Row row, const CapsuleRows& capsules, Shapes& shapes)
{
    Geometry geometry;
    geometry.kind = GeometryKind::Capsule;
    geometry.pose = capsules.shape.pose(row);
    geometry.size = {capsules.radius[row], 0, 0.5 * capsules.length[row]};
    shapes.geometry[context.facet_of_row[row]] = geometry;
}

void measure_capsule(Row row, const CapsuleRows& capsules, MassProperties& solid)
{
    solid = posed(solid_capsule(capsules.radius[row], capsules.length[row]), capsules.shape.pose(row));
}

}  // namespace plab::shapes
