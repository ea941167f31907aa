/// Principal axes of an inertia matrix.
#pragma once

#include "plab/vector.h"

namespace plab::world
{

struct PrincipalAxes
{
    Vec3 moments;  ///< kg m^2; ascending, or descending after reversed()
    Quat q_BP;     ///< turns principal axes into B
};

/// By Jacobi rotations (plab/symmetric.h); a diagonal matrix keeps its bits.
PrincipalAxes principal_axes(const Mat3& inertia_B);
/// The axes in the order 3, 2, 1, right-handed.
PrincipalAxes reversed(const PrincipalAxes& axes);

}  // namespace plab::world
