/// State/RigidBody: a dynamic body. Newton-Euler equations about the centre of mass C:
///   m v_WC' = F,   L' = T,   w_WB = R I_B^-1 R^T L,   q' = w q / 2.
///
/// Mass properties come from one of:
///   mass and inertia             about C, which is center_of_mass, or B's origin where that is not given;
///   mass and shapes              the shapes' inertia, scaled to that mass;
///   density and shapes           both integrated over the shapes.
/// The last two use the shapes' common centre, unless center_of_mass is given; the shapes' inertia about their own centre is then taken
/// as the one about C.
#pragma once

#include "body_columns.h"

namespace plab::bodies
{

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

}  // namespace plab::bodies
