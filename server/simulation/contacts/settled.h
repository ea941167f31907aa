/// When a pair that touches is taken for one that slides.
#pragma once

#include "plab/context.h"

namespace plab::simulation
{

/// Steps after which a pair that touched all the while slides, and does not bounce: its margin is wider from then on.
constexpr Tick kSettled = 8;

}  // namespace plab::simulation
