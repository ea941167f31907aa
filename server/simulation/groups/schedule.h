/// Which rows take part in which phase: blocks of one type each, rows in the order of component ids.
#pragma once

#include <array>
#include <vector>

#include "world/world.h"

namespace plab::simulation
{

/// The rows of one type that run one command.
struct Block
{
    std::uint32_t table = 0;
    const CommandInfo* command = nullptr;
    std::vector<Row> rows;
    bool alone = false;  ///< rows are called, and timed, one by one (measured_alone)
};

/// Rebuilt whenever components come, go, are exchanged or quarantined.
struct Schedule
{
    std::array<std::vector<Block>, kPhaseCount> blocks;

    const std::vector<Block>& of(Phase phase) const { return blocks[static_cast<std::size_t>(phase)]; }
};

/// Whether components of this type are measured each by itself: whose commands the host calls for one at a time (solvers,
/// managers, detections, responses), and what drives (scripts), whose calls take microseconds. The others' rows share what their
/// type costs.
bool measured_alone(const TypeInfo& type);

/// Blocks in the order of type names: neither load order nor row numbers reach the state.
/// `takes_part`: by directory index; null: everybody.
Schedule build_schedule(const world::World& world, const std::vector<std::uint8_t>* takes_part = nullptr);

}  // namespace plab::simulation
