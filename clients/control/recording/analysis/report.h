/// A recording as one self-contained HTML page: energy and momentum over time, cost and error of each interaction with its
/// swaps, the pace of the run, what happened, what is missing.
#pragma once

#include "control/recording/analysis/summary.h"

namespace plab::analysis
{

std::string report_html(const Log& log, const Summary& summary);

}  // namespace plab::analysis
