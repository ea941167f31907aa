/// Solids with a closed form, and the half space. S: the shape's frame, B its body's.
#pragma once

#include "shape_columns.h"

namespace plab::shapes
{

/// Shape/Sphere: all points within `radius` of the origin of S.
struct SphereRows
{
    ShapeColumns shape;
    Column<double> radius;  ///< m

    void describe(Schema& schema);
};

void prepare_sphere(const StepContext& context, Row row, const SphereRows& spheres, Shapes& shapes);
void measure_sphere(Row row, const SphereRows& spheres, MassProperties& solid);

/// Shape/Box: |x| <= a, |y| <= b, |z| <= c in S.
struct BoxRows
{
    ShapeColumns shape;
    Column<Vec3> half_extents;  ///< (a, b, c), m

    void describe(Schema& schema);
};

void prepare_box(const StepContext& context, Row row, const BoxRows& boxes, Shapes& shapes);
void measure_box(Row row, const BoxRows& boxes, MassProperties& solid);

/// Shape/Cylinder: x^2 + y^2 <= radius^2, |z| <= height / 2 in S. Collision and mass properties use the exact solid.
struct CylinderRows
{
    ShapeColumns shape;
    Column<double> radius, height;  ///< m
    Column<bool> hull_collides;

    void describe(Schema& schema);
};

void prepare_cylinder(const StepContext& context, Row row, const CylinderRows& cylinders, Shapes& shapes);
void measure_cylinder(Row row, const CylinderRows& cylinders, MassProperties& solid);

/// Shape/Capsule: all points within `radius` of a segment along z of S: a cylinder with round ends.
struct CapsuleRows
{
    ShapeColumns shape;
    Column<double> radius, length;  ///< m; length of the segment, so of the straight part

    void describe(Schema& schema);
};

void prepare_capsule(const StepContext& context, Row row, const CapsuleRows& capsules, Shapes& shapes);
void measure_capsule(Row row, const CapsuleRows& capsules, MassProperties& solid);

/// Shape/Plane: the half space z <= 0 in S; its surface is seen from z > 0.
struct PlaneRows
{
    ShapeColumns shape;

    void describe(Schema& schema) { shape.describe(schema); }
};

void prepare_plane(const StepContext& context, Row row, const PlaneRows& planes, Shapes& shapes);
/// Always refuses: a half space has no mass.
Result<void> measure_plane(Row row, const PlaneRows& planes, MassProperties& solid);

}  // namespace plab::shapes
