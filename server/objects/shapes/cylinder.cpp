#include "cylinder.h"

#include "picture.h"
#include "volume_integration.h"

namespace plab::shapes
{

void CylinderRows::describe(Schema& schema)
{
    shape.describe(schema);
    schema.param(radius, "radius", unit::metre, "radius").positive();
    schema.param(height, "height", unit::metre, "length along z, half of it on either side").positive();
    schema.param(hull_collides, "hull_collides", unit::one, "it collides, as the true cylinder (true), or is only drawn (false)")
        .or_else(true);
}

void prepare_cylinder(const StepContext& context, Row row, const CylinderRows& cylinders, Shapes& shapes)
{
    Geometry geometry;
    geometry.kind = GeometryKind::Cylinder;
    geometry.pose = cylinders.shape.pose(row);
    geometry.size = {cylinders.radius[row], 0, 0.5 * cylinders.height[row]};
    if (!cylinders.hull_collides[row])
    {
        // A cylinder that is only drawn is represented by a mesh that does not collide.
        geometry.pose = {};
        geometry = picture_of(geometry).geometry(cylinders.shape.pose(row), false);
    }
    shapes.geometry[context.facet_of_row[row]] = std::move(geometry);
}

void measure_cylinder(Row row, const CylinderRows& cylinders, MassProperties& solid)
{
    solid = posed(solid_cylinder(cylinders.radius[row], cylinders.height[row]), cylinders.shape.pose(row));
}

}  // namespace plab::shapes
