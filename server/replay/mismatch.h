/// Where a replay and its recording differ.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/snapshot/compare.h"

namespace plab::replay
{

/// The first place where a replay and its recording differ.
struct Mismatch
{
    std::uint64_t run = 0;
    Tick step = 0;
    std::uint64_t recorded = 0, replayed = 0;  ///< hashes
    /// The differences: from the recorded frame of that step or the next one that exists, and from the next snapshot, as far as
    /// they exist.
    std::vector<simulation::Difference> in_frame, in_snapshot;
    Tick snapshot_step = -1;
    Tick frame_step = -1;  ///< of the recorded frame; < 0: there is none before the snapshot
    /// Components added, removed or exchanged until then: the number in that frame, and in the replay.
    std::uint64_t recorded_revision = 0, replayed_revision = 0;

    std::string text() const;
};

}  // namespace plab::replay
