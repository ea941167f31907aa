/// The energy of a scene under gravity.
#pragma once

#include "support/scene.h"

namespace plab::test
{

/// J: kinetic, and of weight at 9.81 m/s^2.
inline double mechanical_energy(const Scene& s)
{
    const Bodies& bodies = s.simulation().world().host().bodies;
    double sum = 0;
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
        if (bodies.dynamic(b)) sum += bodies.kinetic_energy(b) + 9.81 * bodies.mass[b] * bodies.position[b].z;
    return sum;
}

}  // namespace plab::test
