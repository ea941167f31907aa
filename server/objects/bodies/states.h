/// State/*: what moves. Bodies in space, shafts with one degree of freedom, and quantities without a place.
///
/// Poses, velocities, angles and quantities are hosted: the columns here hold the initial values, the host's tables the live ones.
#pragma once

#include <string>

#include "plab/registrar.h"

namespace plab::bodies
{

/// Columns that all bodies have: pose, appearance and material.
struct BodyColumns
{
    Column<Vec3> position;     ///< p_WB, m
    Column<Quat> orientation;  ///< q_WB
    Column<std::string> material;
    Column<Vec3> color;  ///< red, green, blue: 0 to 1
    Column<RefList> shape;

    void describe(Schema& schema);
};

struct VelocityColumns
{
    Column<Vec3> linear;   ///< v_WB of B's origin, m/s
    Column<Vec3> angular;  ///< w_WB in W, rad/s

    void describe(Schema& schema);
};

/// `color`, for bodies and shafts alike.
void describe_color(Column<Vec3>& color, Schema& schema);
/// The role `solver`: the solver that advances the object.
void describe_solver(Column<Ref>& solver, Schema& schema);

/// Fills the host row of a body that is not dynamic: no mass, no inverse mass, centre at B's origin.
void fill_unpushed(std::uint32_t index, Motion motion, Row row, const BodyColumns& body, Bodies& bodies, Materials& materials);

/// State/Static: a body that never moves.
struct StaticRows
{
    BodyColumns body;

    void describe(Schema& schema) { body.describe(schema); }
};

void prepare_static(const StepContext& context, Row row, const StaticRows& statics, Bodies& bodies, Materials& materials);

/// State/Kinematic: a body that moves with its prescribed velocity, whatever forces act on it: x' = v, q' = w q / 2.
struct KinematicRows
{
    BodyColumns body;
    VelocityColumns velocity;
    Column<Ref> solver;

    void describe(Schema& schema);
};

void prepare_kinematic(const StepContext& context, Row row, const KinematicRows& kinematics, Bodies& bodies, Materials& materials);

/// State/RigidBody: a dynamic body. Newton-Euler equations about the centre of mass C:
///   m v_WC' = F,   L' = T,   w_WB = R I_B^-1 R^T L,   q' = w q / 2.
///
/// Mass properties come from one of:
///   mass and inertia             about C, which is center_of_mass, or B's origin where that is not given;
///   mass and shapes              the shapes' inertia, scaled to that mass;
///   density and shapes           both integrated over the shapes.
/// The last two use the shapes' common centre, unless center_of_mass is given; the shapes' inertia about their own centre is then taken
/// as the one about C.
struct RigidBodyRows
{
    BodyColumns body;
    VelocityColumns velocity;
    Column<Ref> solver;
    Column<double> mass;          ///< kg; 0: not given
    Column<double> density;       ///< kg/m^3; 0: not given
    Column<Mat3> inertia;         ///< about C, in B, kg m^2; zero: not given
    Column<Vec3> center_of_mass;  ///< p_BC, m; infinite: not given

    void describe(Schema& schema);
};

/// Fills the host row except pose and velocities.
Result<void> prepare_rigid_body(const StepContext& context, Row row, const RigidBodyRows& rigid, Bodies& bodies, const Shapes& shapes,
                                Materials& materials);

/// State/Shaft: one degree of freedom about an axle that is fixed in the world: J w' = T, angle' = w. A prescribed shaft keeps its
/// angular velocity, whatever torque acts on it.
struct ShaftRows
{
    Column<double> angle;             ///< rad, never wrapped
    Column<double> angular_velocity;  ///< rad/s
    Column<double> inertia;           ///< J about the axle, kg m^2
    Column<Vec3> position;            ///< of the axle's origin in W, m
    Column<Vec3> axis;                ///< axis_W, unit
    Column<bool> prescribed;
    Column<Vec3> color;
    Column<RefList> shape;  ///< for drawing
    Column<Ref> solver;

    void describe(Schema& schema);
};

/// Fills the host row except angle and speed.
Result<void> prepare_shaft(const StepContext& context, Row row, const ShaftRows& rows, Shafts& shafts);

/// The shortest rotation that turns z into `axis` (unit); about x where that is -z.
Quat rotation_from_z(const Vec3& axis);

/// State/Quantities: numbers without a place in space that change at rates added by interactions: z' = r(t, z, ...). Temperatures,
/// concentrations, currents. The solver advances them together with the objects to which they are coupled.
struct QuantitiesRows
{
    Column<Reals> values;
    Column<Ref> solver;

    void describe(Schema& schema);
};

/// Checks the initial values; from then on the host has the live ones.
Result<void> prepare_quantities(Row row, const QuantitiesRows& rows);

}  // namespace plab::bodies
