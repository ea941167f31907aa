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

/// The components of a part of the scene, to which a stepper can be restricted. Objects outside it take no part in a step.
struct Selection
{
    std::vector<std::uint8_t> flags;        ///< by directory index
    std::vector<std::uint32_t> components;  ///< those that are flagged, in id order
};

/// Follows from the structure of the world (world/revisions.h).
struct Schedule
{
    std::array<std::vector<Block>, kPhaseCount> blocks;

    const std::vector<Block>& of(Phase phase) const { return blocks[static_cast<std::size_t>(phase)]; }
};

/// Whether the components of this type are timed one by one. That holds for types whose commands the host calls for one component at a
/// time (solvers, managers, detections, responses), and for drives (scripts) and decisions (governors), whose calls take microseconds. For
/// all other types the rows share the measured time of the whole block.
bool measured_alone(const TypeInfo& type);

/// Blocks in the order of type names, so that neither load order nor row numbers influence the state. `part`: null: all components.
Schedule build_schedule(const world::World& world, const Selection* part = nullptr);
/// Replaces the blocks of components that only advance others (ComponentType::only_advances) by those of the present structure. In phases
/// in which none of them takes part, all blocks stay where they are.
void rebuild_solvers(Schedule& schedule, const world::World& world, const Selection* part = nullptr);

}  // namespace plab::simulation
