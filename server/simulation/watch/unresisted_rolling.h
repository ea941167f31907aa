/// Reports materials that resist rolling where nothing does so: contacts whose response leaves them to no manager.
///
/// contact.unresisted (warning, once for each detection, in the first step of a run): names the response.
#pragma once

#include <vector>

#include "plab/context.h"
#include "simulation/watch/run_view.h"

namespace plab::simulation
{

/// To be called after the first step.
void report_unresisted_rolling(const RunView& s, std::vector<Event>& events);

}  // namespace plab::simulation
