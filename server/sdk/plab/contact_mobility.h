/// The mobility of a contact point: how its relative velocity answers an impulse, du = K dj.
#pragma once

#include "plab/vector.h"

namespace plab
{

/// K += -[r] I^-1 [r] in contact coordinates (t1, t2, n): the rotational part that one body contributes. r: m, from its centre of mass to
/// the point; `inverse_inertia`: 1 / (kg m^2); all in W. The caller adds 1/m, so that it knows both parts.
inline void add_turning_mobility(Mat3& K, const Mat3& inverse_inertia, const Vec3& r, const Vec3& t1, const Vec3& t2, const Vec3& n)
{
    const Vec3 lever[3] = {cross(r, t1), cross(r, t2), cross(r, n)};
    for (int i = 0; i < 3; ++i)
    {
        const Vec3 spin = inverse_inertia * lever[i];
        for (int j = i; j < 3; ++j)
        {
            K(i, j) += dot(lever[j], spin);
            K(j, i) = K(i, j);
        }
    }
}

}  // namespace plab
