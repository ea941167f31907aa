/// What decides which method fits a group.
#pragma once

#include "flat_system.h"

namespace plab::solvers
{

/// Vectors to work in, of the flat system's size.
struct StiffnessMemory
{
    std::vector<double>&y, &f, &direction, &image, &work, &units, &sizes;
};

/// The largest eigenvalue of df/dy, 1/s, at the present state, by a power iteration from a fixed vector on
/// K X_u + C^2  (K = dU/dx, C = dU/du, X_u = dX/du), whose eigenvalues are squares of frequencies and of decay rates: a pair of
/// conjugate ones gives no trouble. Good to some percent for one dominant force. 7 evaluations. Infinite where forces
/// are not finite.
double measure_stiffness(DynamicSystem& system, double h, StiffnessMemory memory);

/// The largest angular speed of a body, rad/s.
double fastest_spin(DynamicSystem& system);

}  // namespace plab::solvers
