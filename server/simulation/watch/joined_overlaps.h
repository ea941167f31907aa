/// Reports bodies that a joint holds inside one another where a run begins, and that collide all the same: joint and contact then work
/// against one another from the first step on, which is hardly ever meant.
///
/// contact.joined (warning, once for each detection, in the first step of a run; value: m, overlap): names the pair that overlaps most, the
/// joint, and what keeps the two from colliding. The report changes nothing.
#pragma once

#include <span>
#include <vector>

#include "plab/context.h"
#include "simulation/watch/run_view.h"

namespace plab::simulation
{

/// To be called after the first step. `half_thickness`: m, by body; 0 where it is not known.
void report_joined_overlaps(const RunView& s, std::span<const double> half_thickness, std::vector<Event>& events);

}  // namespace plab::simulation
