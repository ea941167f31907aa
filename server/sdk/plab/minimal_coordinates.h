/// Minimal coordinates: an ability that a DynamicSystem may have beside its plain coordinates.
#pragma once

#include <string_view>

#include "plab/dynamics.h"

namespace plab
{

/// A system whose bodies are joined to trees can describe them by the coordinates of their joints alone. Joints then hold exactly, by
/// construction, and there are fewer unknowns; any explicit method for flat equations works on them as before.
///
/// A solver finds the ability with dynamic_cast<MinimalCoordinates*>(&system) and asks for it at the start of each advance. The state
/// stays what the host's tables hold (poses and velocities of bodies), so a swap between solvers carries it over exactly.
class MinimalCoordinates
{
public:
    virtual ~MinimalCoordinates() = default;
    /// To be called before the first evaluation of an advance. Afterwards coordinates() starts at 0 and has, for each body: one angle
    /// (hinge, rad), one length (slider, m), a rotation vector (ball joint, rad), nothing (weld), or the six of a free body; speeds() has
    /// the rates: rad/s, m/s, the angular velocity relative to the parent in the frame of the body, and v with w in the frame of the body.
    /// Shafts and quantities follow as before. body_count() is 0, because no member has six coordinates of its own any more. Returns an
    /// empty text, or the reason why the system keeps its plain coordinates. A system without joints keeps them without a reason: they
    /// are minimal.
    virtual std::string_view use_minimal_coordinates() = 0;
};

}  // namespace plab
