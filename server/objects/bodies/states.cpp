#include "states.h"

#include <limits>

#include "inertia.h"
#include "plab/surface.h"

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

void prepare_static(const StepContext& context, Row row, const StaticRows& statics, Bodies& bodies, Materials& materials)
{
    fill_unpushed(context.facet_of_row[row], Motion::Static, row, statics.body, bodies, materials);
}

void KinematicRows::describe(Schema& schema)
{
    body.describe(schema);
    velocity.describe(schema);
    describe_solver(solver, schema);
}

void prepare_kinematic(const StepContext& context, Row row, const KinematicRows& kinematics, Bodies& bodies, Materials& materials)
{
    fill_unpushed(context.facet_of_row[row], Motion::Kinematic, row, kinematics.body, bodies, materials);
}

namespace
{

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Vec3 kNotGiven{kInfinity, kInfinity, kInfinity};

/// Which of the parameters the author of the scene gave.
struct Given
{
    bool mass, density, inertia, center, shapes;
};

Given given_of(Row row, const RigidBodyRows& rigid)
{
    return {rigid.mass[row] != 0, rigid.density[row] != 0, !(rigid.inertia[row] == Mat3{}), !(rigid.center_of_mass[row] == kNotGiven),
            !rigid.body.shape[row].empty()};
}

Result<void> check_given(Row row, const RigidBodyRows& rigid, const Given& given)
{
    if (given.mass && given.density) return reason("mass and density are both given; one of them must be left out");
    if (!given.mass && !given.density) return reason("mass must be positive: give mass (kg), or density (kg/m^3) and shapes");
    if (auto positive = given.mass ? check_positive("mass", rigid.mass[row]) : check_positive("density", rigid.density[row]); !positive)
        return positive;
    if (given.density && !given.shapes) return reason("density needs shapes to fill; give a shape, or mass and inertia");
    if (given.density && given.inertia)
        return reason("inertia is given with density; give mass with inertia, or leave the inertia to the shapes");
    if (!given.inertia && !given.shapes) return reason("mass needs an inertia, or shapes to compute it from");
    if (given.center && !is_finite(rigid.center_of_mass[row])) return reason("center_of_mass must be finite");
    return {};
}

/// The sum of the shapes' mass properties at density 1, in B.
Result<MassProperties> solid_of(const RefList& parts, const Shapes& shapes)
{
    MassProperties sum;
    for (const Ref part : parts)
    {
        const std::string& why_not = shapes.unmeasurable[part.index];
        if (!why_not.empty()) return reason("mass properties cannot be computed from its shapes: " + why_not + "; give mass and inertia");
        sum = combined(sum, shapes.solid[part.index]);
    }
    return sum;
}

/// Surfaces have no thickness for a collision response to act on, and do not collide with one another or with planes.
bool has_surface(const RefList& parts, const Shapes& shapes)
{
    for (const Ref part : parts)
    {
        const Geometry& g = shapes.geometry[part.index];
        if (surface_of(g) != Surface::None) return true;
        for (const std::uint32_t p : g.parts)
            if (surface_of(shapes.geometry[p]) != Surface::None) return true;
    }
    return false;
}

Result<MassProperties> mass_properties_of(Row row, const RigidBodyRows& rigid, const Given& given, const Shapes& shapes)
{
    MassProperties out{rigid.mass[row], {}, rigid.inertia[row]};
    if (!given.inertia)
    {
        const auto solid = solid_of(rigid.body.shape[row], shapes);
        if (!solid) return solid.error();
        out = scaled(*solid, given.mass ? rigid.mass[row] / solid->mass : rigid.density[row]);
        if (given.mass) out.mass = rigid.mass[row];
    }
    if (given.center) out.center = rigid.center_of_mass[row];
    return out;
}

}  // namespace

void RigidBodyRows::describe(Schema& schema)
{
    body.describe(schema);
    velocity.describe(schema);
    describe_solver(solver, schema);
    schema.param(mass, "mass", unit::kilogram, "0: not given, then density and shapes are").or_else(0);
    schema.param(density, "density", unit::kilogram_per_metre3, "of the shapes; 0: not given, then mass is").or_else(0);
    schema
        .param(inertia, "inertia", unit::kilogram_metre2,
               "about the centre of mass, in the body's axes; zero: not given, then it is integrated over the shapes")
        .or_else({});
    schema
        .param(center_of_mass, "center_of_mass", unit::metre,
               "in the body's frame; infinite: not given, then the shapes' centre, or the origin where inertia is given")
        .or_else(kNotGiven)
        .may_be_infinite();
}

Result<void> prepare_rigid_body(const StepContext& context, Row row, const RigidBodyRows& rigid, Bodies& bodies, const Shapes& shapes,
                                Materials& materials)
{
    const Given given = given_of(row, rigid);
    if (auto complete = check_given(row, rigid, given); !complete) return complete;
    const auto solid = mass_properties_of(row, rigid, given, shapes);
    if (!solid) return solid.error();
    if (auto mass = check_positive("mass", solid->mass); !mass) return mass;
    if (auto inertia = check_inertia(solid->inertia); !inertia) return inertia;

    if (has_surface(rigid.body.shape[row], shapes))
        return reason(
            "a shape that collides as a surface (bowl, bore, height field, mesh) is for bodies that are not dynamic: State/Static, "
            "State/Kinematic");

    const std::uint32_t index = context.facet_of_row[row];
    bodies.motion[index] = Motion::Dynamic;
    bodies.mass[index] = solid->mass;
    bodies.inverse_mass[index] = 1 / solid->mass;
    bodies.inertia_B[index] = solid->inertia;
    bodies.inverse_inertia_B[index] = inverse_inertia(solid->inertia);
    bodies.center_B[index] = solid->center;
    bodies.material[index] = materials.intern(rigid.body.material[row]);
    bodies.shapes[index] = rigid.body.shape[row];
    return {};
}

void ShaftRows::describe(Schema& schema)
{
    schema.state(angle, "angle", unit::radian, "angle from its zero position; never wrapped").hosted();
    schema.state(angular_velocity, "angular_velocity", unit::radian_per_second, "about the axis").hosted();
    schema.param(inertia, "inertia", unit::kilogram_metre2, "about the axle; not needed where the speed is prescribed").or_else(0);
    schema.param(position, "position", unit::metre, "a point of the axle, in the world; the shapes' origin").or_else({});
    schema.param(axis, "axis", unit::one, "direction of the axle, in the world").or_else({0, 0, 1}).unit_length();
    schema.param(prescribed, "prescribed", unit::one, "turns at its angular_velocity, whatever torque acts on it").or_else(false);
    describe_color(color, schema);
    schema.role(shape, "shape", {Facet::Shape}, "shape for drawing; its frame has z along the axle").optional();
    describe_solver(solver, schema);
}

Quat rotation_from_z(const Vec3& axis)
{
    // Half-angle formulas with the cosine or the sine, whichever avoids cancellation.
    if (axis.z >= 0)
    {
        const double w = std::sqrt(0.5 * (1 + axis.z));
        return normalized(Quat{w, -axis.y / (2 * w), axis.x / (2 * w), 0});
    }
    const double s = std::sqrt(0.5 * (1 - axis.z));
    const double across = std::sqrt(axis.x * axis.x + axis.y * axis.y);
    if (across == 0) return {0, 1, 0, 0};
    return normalized(Quat{across / (2 * s), -s * axis.y / across, s * axis.x / across, 0});
}

Result<void> prepare_shaft(const StepContext& context, Row row, const ShaftRows& rows, Shafts& shafts)
{
    const double inertia = rows.inertia[row];
    const bool prescribed = rows.prescribed[row];
    const bool left_out = prescribed && inertia == 0;
    if (auto positive = check_positive("inertia", inertia); !positive && !left_out) return positive;

    const std::uint32_t index = context.facet_of_row[row];
    shafts.motion[index] = prescribed ? Motion::Kinematic : Motion::Dynamic;
    shafts.inertia[index] = inertia;
    shafts.inverse_inertia[index] = prescribed ? 0 : 1 / inertia;
    shafts.axle[index] = {rows.position[row], rotation_from_z(rows.axis[row])};
    shafts.shapes[index] = rows.shape[row];
    return {};
}

void QuantitiesRows::describe(Schema& schema)
{
    schema.state(values, "values", unit::one, "the numbers, in units of the scene's own").hosted();
    describe_solver(solver, schema);
}

Result<void> prepare_quantities(Row row, const QuantitiesRows& rows)
{
    if (rows.values[row].empty()) return reason("values must hold at least one number");
    return {};
}

}  // namespace plab::bodies
