#include "body_columns.h"

namespace plab::bodies
{

void BodyColumns::describe(Schema& schema)
{
    schema.state(position, "position", unit::metre, "origin of the body's frame, in the world").hosted();
    schema.state(orientation, "orientation", unit::one, "turns the body's axes into the world's").hosted();
    schema.param(material, "material", unit::one, "name that Material/Pair refers to").or_else("");
    describe_color(color, schema);
    schema.role(shape, "shape", {Facet::Shape}, "shapes for drawing, collision and mass properties").optional();
}

void VelocityColumns::describe(Schema& schema)
{
    schema.state(linear, "linear_velocity", unit::metre_per_second, "of the origin of the body's frame, in the world").hosted();
    schema.state(angular, "angular_velocity", unit::radian_per_second, "in the world").hosted();
}

void describe_color(Column<Vec3>& color, Schema& schema)
{
    schema.param(color, "color", unit::one, "red, green, blue, each from 0 to 1; the shapes' colours are multiplied by it")
        .or_else({1, 1, 1})
        .at_least(0)
        .at_most(1);
}

void describe_solver(Column<Ref>& solver, Schema& schema)
{
    schema.role(solver, "solver", {Facet::Component}, "the solver that advances it; the scene's solver if none is named")
        .family("Solver/")
        .optional();
}

void fill_unpushed(std::uint32_t index, Motion motion, Row row, const BodyColumns& body, Bodies& bodies, Materials& materials)
{
    bodies.motion[index] = motion;
    bodies.mass[index] = 0;
    bodies.inverse_mass[index] = 0;
    bodies.inertia_B[index] = {};
    bodies.inverse_inertia_B[index] = {};
    bodies.center_B[index] = {};
    bodies.material[index] = materials.intern(body.material[row]);
    bodies.shapes[index] = body.shape[row];
}

}  // namespace plab::bodies
