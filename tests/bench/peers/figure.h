/// The picture of a case: error against processor time.
#pragma once

#include <string>

#include "bench/peers/results.h"

namespace plab::peers
{

/// Draws one panel per metric, log-log, all points, the peers' front and pLab's: to path.svg and path.png. False if that fails.
bool draw_case(const CaseResult& result, const std::string& path);

}  // namespace plab::peers
