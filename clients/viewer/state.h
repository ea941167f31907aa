/// The poses of all objects at one time: a frame of plab/states without velocities, ordered by handle.
#pragma once

#include <cstdint>
#include <vector>

#include "idl/plab.h"
#include "plab/vector.h"

namespace plab::view
{

/// Times that differ by less are the same time (s): far below any step, far above the rounding of n * dt.
inline constexpr double kSameTime = 1e-9;

struct Body
{
    std::uint32_t handle = 0;
    Pose pose;  ///< X_WB
};

struct Shaft
{
    std::uint32_t handle = 0;
    double angle = 0;  ///< rad
};

struct State
{
    std::uint64_t run = 0, revision = 0;
    std::int64_t step = 0;
    double time = 0;            ///< s, simulated
    std::vector<Body> bodies;   ///< by handle
    std::vector<Shaft> shafts;  ///< by handle
};

State state_of(const plab_v2_Frame& frame);

/// From a (at 0) to b (at 1) along the shorter arc, at a constant rate of rotation.
Quat slerp(const Quat& a, const Quat& b, double share);

/// The state at `time` between those of two frames of one run, a before b: positions and angles linearly, orientations by
/// slerp. Objects that are only in a keep their pose until b; objects that are only in b appear with b. Step and revision are
/// those of the last frame that is not later than `time`.
State interpolate(const State& a, const State& b, double time);

}  // namespace plab::view
