/// A recording as one HTML page for people that needs nothing else: the course of energy and momentum, cost and error of
/// each interaction with its swaps, how fast it ran, what happened, what is missing.
#pragma once

#include "recordings/summary.h"

namespace plab::recordings
{

std::string report_html(const Log& log, const Summary& summary);

}  // namespace plab::recordings
