/// Which rows take part in which phase: blocks of rows of one type, in the order of component ids.
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
    bool alone = false;  ///< the command is called, and timed, for one row at a time (measured_alone)
};

/// Rebuilt whenever components are added, removed, swapped or quarantined.
struct Schedule
{
    std::array<std::vector<Block>, kPhaseCount> blocks;

    const std::vector<Block>& of(Phase phase) const { return blocks[static_cast<std::size_t>(phase)]; }
};

/// Whether the components of this type are timed one by one. That holds for types whose commands the host calls for one component at a
/// time (solvers, managers, detections, responses), and for drives (scripts), whose calls take microseconds. For all other types the rows
/// share the measured time of the whole block.
bool measured_alone(const TypeInfo& type);

/// Blocks in the order of type names, so that neither load order nor row numbers influence the state. `takes_part`: by directory index;
/// null: all components.
Schedule build_schedule(const world::World& world, const std::vector<std::uint8_t>* takes_part = nullptr);

}  // namespace plab::simulation
