/// Bounce history: predicts the time at which an infinite sequence of ever smaller bounces ends (Zeno behaviour).
#pragma once

#include <optional>

#include "simulation/contacts/contacts.h"

namespace plab::simulation
{

/// A ball that keeps the fraction r of its speed in each bounce (r: coefficient of restitution) bounces infinitely often in finite time,
/// and event location would never reach the end of the step. But the intervals between the impacts form a geometric series: if the
/// interval after this impact is d, the sequence ends after
///
///   d + r d + r^2 d + ... = d / (1 - r)
///
/// and the pair can be set to rest at once if that is still within the step. `next` (s) is d as computed from the speed after the impact
/// and the normal acceleration; `ratio` is r. Returns the time (s) from this impact to the end of the sequence, or nothing if the last
/// two measured intervals of the pair do not confirm both numbers: then other forces or bodies take part, and it is not such a sequence.
std::optional<double> rest_of_bounces(const BounceHistory& history, double next, double ratio);

/// Adds an impact at `time` (s) to the history.
void note_impact(BounceHistory& history, double time);

}  // namespace plab::simulation
