/// A recording as a film in three dimensions: glTF 2.0 with an animation (translations and rotations of bodies, turns of shafts).
#pragma once

#include "control/recording/analysis/export.h"

namespace plab::analysis
{

struct GltfOptions
{
    Span span = {};
    std::string out = {};     ///< a file
    double every = 1.0 / 60;  ///< s, least time between key frames
};

/// The first run in the span. Objects that are not there all the time have the size 0 meanwhile; what never moves has no key frames. z is
/// up in pLab and y in glTF: one node above all others turns. Numbers are floats of 32 bits there. Errors: no frames; more key frames than
/// 1 GiB holds.
Result<Exported> export_gltf(const Log& log, const GltfOptions& options);

}  // namespace plab::analysis
