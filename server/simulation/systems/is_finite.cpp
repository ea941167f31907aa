// Whether the values of an object are small and finite enough for the step to continue.
#include <algorithm>

#include "plab/limits.h"
#include "plab/rotation.h"
#include "simulation/systems/group_system.h"

namespace plab::simulation
{

bool is_finite(const Bodies& bodies, std::uint32_t b)
{
    return is_computable(bodies.position[b]) && is_computable(bodies.velocity[b]) && plab::is_finite(bodies.orientation[b]) &&
           is_computable(bodies.angular_velocity[b]);
}

bool is_finite(const Quantities& quantities, std::uint32_t q)
{
    return std::all_of(quantities.value[q].begin(), quantities.value[q].end(), [](double v) { return is_computable(v); });
}

bool is_finite(const Shafts& shafts, std::uint32_t s) { return is_computable(shafts.angle[s]) && is_computable(shafts.speed[s]); }

}  // namespace plab::simulation
