#include "shape_columns.h"

namespace plab::shapes
{

void ShapeColumns::describe(Schema& schema)
{
    schema.param(position, "position", unit::metre, "origin of the shape's frame, in the body's").or_else({});
    schema.param(orientation, "orientation", unit::one, "turns the shape's axes into the body's").or_else({});
    schema.param(color, "color", unit::one, "red, green, blue, each from 0 to 1").or_else({0.8, 0.8, 0.8}).at_least(0).at_most(1);
}

}  // namespace plab::shapes
