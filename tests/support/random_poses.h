/// Random numbers, vectors and rotations for tests and benches, the same on every machine.
#pragma once

#include "plab/random.h"
#include "plab/vector.h"

namespace plab::test
{

inline double uniform(std::uint64_t& s, double lo, double hi) { return lo + (hi - lo) * next_uniform(s); }
/// Each component in [-size, size].
inline Vec3 random_vector(std::uint64_t& s, double size)
{
    const double x = uniform(s, -size, size), y = uniform(s, -size, size), z = uniform(s, -size, size);
    return {x, y, z};
}
inline Quat random_rotation(std::uint64_t& s)
{
    const Vec3 v = random_vector(s, 1);
    return normalized(Quat{uniform(s, -1, 1), v.x, v.y, v.z});
}

}  // namespace plab::test
