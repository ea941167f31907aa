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
};

/// Rebuilt whenever components come, go, are exchanged or quarantined.
struct Schedule
{
    std::array<std::vector<Block>, kPhaseCount> blocks;

    const std::vector<Block>& of(Phase phase) const { return blocks[static_cast<std::size_t>(phase)]; }
};

/// Blocks in the order of type names: neither load order nor row numbers reach the state.
Schedule build_schedule(const world::World& world);

}  // namespace plab::simulation
