/// Overlaps of a scene's bodies at given states: one geometry for all engines.
#pragma once

#include <span>

#include "bench/peers/engine.h"
#include "bench/peers/scene.h"

namespace plab::peers
{

struct Penetration
{
    double deepest = 0;  ///< m
    double mean = 0;     ///< m, over the pairs that overlap
    int pairs = 0;
};

/// Of all pairs of bodies, and of bodies with ground and container. Box and box: separating axes (Gottschalk, Lin,
/// Manocha, SIGGRAPH 1996), the least overlap of the 15 axes. Half-spaces: the lowest corner.
Penetration penetration_of(const Scene& scene, std::span<const BodyState> states);

}  // namespace plab::peers
