/// State/Kinematic: a body that moves with its prescribed velocity, whatever forces act on it: x' = v, q' = w q / 2.
#pragma once

#include "body_columns.h"

namespace plab::bodies
{

struct KinematicRows
{
    BodyColumns body;
    VelocityColumns velocity;
    Column<Ref> solver;

    void describe(Schema& schema);
};

void prepare_kinematic(const StepContext& context, Row row, const KinematicRows& kinematics, Bodies& bodies, Materials& materials);

}  // namespace plab::bodies
