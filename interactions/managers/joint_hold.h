/// Joints of an island whose impulses were found by sweeps: a sweep carries the effect of a joint only to its neighbours, so joints yield
/// under load. After the sweeps, speeds and positions are projected onto the joints, exactly and with all of them at once. The projection
/// of speeds takes energy and gives none; contacts may be left violated, for the next step.
#pragma once

#include "newton.h"
#include "stepping.h"

namespace plab::managers
{

/// Whether the island has rows of joints.
bool has_joints(const Island& island);
/// Projects the speeds in the tables onto the joints at the present positions. The problem has the movers and lines of the island and no
/// points; afterwards the impulses of its lines are those of the projection, and its movers have the speeds of the tables.
void hold_joint_speeds(Problem& problem, Island& island, Bodies& bodies, Shafts& shafts, NewtonSolver& newton);
/// Closes the joints by displacements. The movers' speeds are used up.
void close_joints(Problem& problem, Island& island, Bodies& bodies, Shafts& shafts, NewtonSolver& newton);

}  // namespace plab::managers
