#include "primitives.h"

#include "built_mesh.h"
#include "volume_integration.h"

namespace plab::shapes
{
namespace
{

void hand_over_primitive(GeometryKind kind, const Vec3& size, const StepContext& context, Row row, const ShapeColumns& shape,
                         Shapes& shapes)
{
    Geometry geometry;
    geometry.kind = kind, geometry.pose = shape.pose(row), geometry.size = size;
    shapes.geometry[context.facet_of_row[row]] = std::move(geometry);
}

}  // namespace

void SphereRows::describe(Schema& schema)
{
    shape.describe(schema);
    schema.param(radius, "radius", unit::metre, "radius").positive();
}

void prepare_sphere(const StepContext& context, Row row, const SphereRows& spheres, Shapes& shapes)
{
    hand_over_primitive(GeometryKind::Sphere, {spheres.radius[row], 0, 0}, context, row, spheres.shape, shapes);
}

void measure_sphere(Row row, const SphereRows& spheres, MassProperties& solid)
{
    solid = posed(solid_sphere(spheres.radius[row]), spheres.shape.pose(row));
}

void BoxRows::describe(Schema& schema)
{
    shape.describe(schema);
    schema.param(half_extents, "half_extents", unit::metre, "half of length, width and height along x, y, z").positive();
}

void prepare_box(const StepContext& context, Row row, const BoxRows& boxes, Shapes& shapes)
{
    hand_over_primitive(GeometryKind::Box, boxes.half_extents[row], context, row, boxes.shape, shapes);
}

void measure_box(Row row, const BoxRows& boxes, MassProperties& solid)
{
    solid = posed(solid_box(boxes.half_extents[row]), boxes.shape.pose(row));
}

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
    const Vec3 size{cylinders.radius[row], 0, 0.5 * cylinders.height[row]};
    if (cylinders.hull_collides[row]) return hand_over_primitive(GeometryKind::Cylinder, size, context, row, cylinders.shape, shapes);
    // One that is only drawn is a mesh to the host, which has no cylinders that do not collide.
    Geometry solid;
    solid.kind = GeometryKind::Cylinder, solid.size = size;
    shapes.geometry[context.facet_of_row[row]] = picture_of(solid).geometry(cylinders.shape.pose(row), false);
}

void measure_cylinder(Row row, const CylinderRows& cylinders, MassProperties& solid)
{
    solid = posed(solid_cylinder(cylinders.radius[row], cylinders.height[row]), cylinders.shape.pose(row));
}

void CapsuleRows::describe(Schema& schema)
{
    shape.describe(schema);
    schema.param(radius, "radius", unit::metre, "radius").positive();
    schema.param(length, "length", unit::metre, "of the straight part along z, between the centres of the round ends").positive();
}

void prepare_capsule(const StepContext& context, Row row, const CapsuleRows& capsules, Shapes& shapes)
{
    const Vec3 size{capsules.radius[row], 0, 0.5 * capsules.length[row]};
    hand_over_primitive(GeometryKind::Capsule, size, context, row, capsules.shape, shapes);
}

void measure_capsule(Row row, const CapsuleRows& capsules, MassProperties& solid)
{
    solid = posed(solid_capsule(capsules.radius[row], capsules.length[row]), capsules.shape.pose(row));
}

void prepare_plane(const StepContext& context, Row row, const PlaneRows& planes, Shapes& shapes)
{
    hand_over_primitive(GeometryKind::Plane, {}, context, row, planes.shape, shapes);
}

Result<void> measure_plane(Row, const PlaneRows&, MassProperties&) { return reason("a plane is unbounded and has no volume"); }

}  // namespace plab::shapes
