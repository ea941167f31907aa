#include "sphere.h"

#include "volume_integration.h"

namespace plab::shapes
{

void SphereRows::describe(Schema& schema)
{
    shape.describe(schema);
    schema.param(radius, "radius", unit::metre, "radius").positive();
}

void prepare_sphere(const StepContext& context, Row row, const SphereRows& spheres, Shapes& shapes)
{
    Geometry geometry;
    geometry.kind = GeometryKind::Sphere;
    geometry.pose = spheres.shape.pose(row);
    geometry.size.x = spheres.radius[row];
    shapes.geometry[context.facet_of_row[row]] = geometry;
}

void measure_sphere(Row row, const SphereRows& spheres, MassProperties& solid)
{
    solid = posed(solid_sphere(spheres.radius[row]), spheres.shape.pose(row));
}

}  // namespace plab::shapes
