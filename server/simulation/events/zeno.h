/// Where a sequence of ever smaller bounces ends.
#pragma once

#include <optional>

#include "simulation/contacts/contacts.h"

namespace plab::simulation
{

/// A ball that loses a share of its speed in each bounce bounces infinitely often in finite time: intervals shrink by one
/// ratio r, and after an impact with the next interval d the sequence ends
///
///   d + r d + r^2 d + ... = d / (1 - r)
///
/// later. `next` (s) is that interval, as the speed after the impact and the acceleration say; `ratio` the coefficient of
/// restitution. None where the last two intervals of the pair do not confirm them: then it is no such sequence.
std::optional<double> rest_of_bounces(const BounceHistory& history, double next, double ratio);

/// Adds an impact at `time` (s).
void note_impact(BounceHistory& history, double time);

}  // namespace plab::simulation
