#include "simulation/step/schedule.h"

#include <map>

namespace plab::simulation
{

Schedule build_schedule(const world::World& world)
{
    // Keyed by type name and command number: an order that every run shares.
    std::array<std::map<std::pair<std::string, std::size_t>, Block>, kPhaseCount> found;
    for (const std::uint32_t i : world.in_id_order())
    {
        const world::Component& c = world.component(i);
        if (c.table == kNoIndex || c.quarantined) continue;
        const TypeInfo& info = world.table_of(i).type().info;
        for (std::size_t k = 0; k < info.commands.size(); ++k)
        {
            const CommandInfo& command = info.commands[k];
            if (!(c.commands & (1ull << k)) || !command.run) continue;
            Block& block = found[static_cast<std::size_t>(command.phase)][{info.name, k}];
            block.table = c.table, block.command = &command;
            block.rows.push_back(c.row);
        }
    }
    Schedule schedule;
    for (std::size_t phase = 0; phase < found.size(); ++phase)
        for (auto& [key, block] : found[phase]) schedule.blocks[phase].push_back(std::move(block));
    return schedule;
}

}  // namespace plab::simulation
