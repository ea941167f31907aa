#include "plane.h"

namespace plab::shapes
{

void prepare_plane(const StepContext& context, Row row, const PlaneRows& planes, Shapes& shapes)
{
    Geometry geometry;
    geometry.kind = GeometryKind::Plane;
    geometry.pose = planes.shape.pose(row);
    shapes.geometry[context.facet_of_row[row]] = geometry;
}

Result<void> measure_plane(Row, const PlaneRows&, MassProperties&) { return reason("a plane is unbounded and has no volume"); }

}  // namespace plab::shapes
