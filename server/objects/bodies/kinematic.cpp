#include "kinematic.h"

namespace plab::bodies
{

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

}  // namespace plab::bodies
