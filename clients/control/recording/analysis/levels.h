/// Levels of detail over time: how many components a governor has at each level.
#pragma once

#include "control/recording/analysis/log.h"
#include "figures/chart.h"

namespace plab::analysis
{

/// One curve for each governor and level, in the order in which they first occur; the unit is the governor. Empty: the recording has no
/// governor. A component that is removed counts until the run ends.
std::vector<figures::Curve> levels_over_time(const Log& log);

}  // namespace plab::analysis
