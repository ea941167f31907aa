/// Free rotation of four bodies at once (plab/lanes.h), with the bits of turn_freely().
#pragma once

#include <array>
#include <cstdint>

#include "plab/tables.h"

namespace plab::simulation
{

/// Turns four bodies for h (s) with their angular momenta, as turn_freely() does. Returns false, and does nothing, unless this needs no
/// more than a series: all four have one moment of inertia and turn by less than 1/2 rad, or all of them turn slowly
/// (plab/free_rotation.h).
bool turn_four(Bodies& bodies, const std::array<std::uint32_t, 4>& which, double h);

}  // namespace plab::simulation
