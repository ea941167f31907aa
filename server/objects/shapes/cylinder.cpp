#include "cylinder.h"

#include "volume_integration.h"

namespace plab::shapes
{
namespace
{

constexpr std::uint32_t kSides = 64;

}  // namespace

void CylinderRows::describe(Schema& schema)
{
    shape.describe(schema);
    schema.param(radius, "radius", unit::metre, "radius").positive();
    schema.param(height, "height", unit::metre, "length along z, half of it on either side").positive();
    schema
        .param(hull_collides, "hull_collides", unit::one, "it collides as the prism of 64 sides that is drawn (true) or not at all (false)")
        .or_else(true);
}

void prepare_cylinder(const StepContext& context, Row row, const CylinderRows& cylinders, Shapes& shapes)
{
    const double radius = cylinders.radius[row], half = 0.5 * cylinders.height[row];
    const ProfilePoint profile[] = {{0, -half}, {radius, -half}, {radius, half}, {0, half}};
    shapes.geometry[context.facet_of_row[row]] =
        turned_profile(profile, kSides).geometry(cylinders.shape.pose(row), cylinders.hull_collides[row]);
}

void measure_cylinder(Row row, const CylinderRows& cylinders, MassProperties& solid)
{
    solid = posed(solid_cylinder(cylinders.radius[row], cylinders.height[row]), cylinders.shape.pose(row));
}

}  // namespace plab::shapes
