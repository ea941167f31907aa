#include "simulation/groups/schedule.h"

#include <algorithm>
#include <map>

namespace plab::simulation
{

bool measured_alone(const TypeInfo& type)
{
    const auto one_at_a_time = [](const CommandInfo& c)
    {
        return c.phase == Phase::Advance || c.phase == Phase::Solve || c.phase == Phase::Detect || c.phase == Phase::Locate ||
               c.phase == Phase::Respond || c.phase == Phase::Touch || c.phase == Phase::Drive || c.phase == Phase::Decide;
    };
    return std::any_of(type.commands.begin(), type.commands.end(), one_at_a_time);
}

Schedule build_schedule(const world::World& world, const Selection* part)
{
    // Keyed by type name and command number: an order that is the same in every run.
    std::array<std::map<std::pair<std::string, std::size_t>, Block>, kPhaseCount> found;
    std::vector<std::vector<Block*>> of_table(world.tables().size());  // by command; null until a row needs it
    for (const std::uint32_t i : part ? part->components : world.in_id_order())
    {
        const world::Component& c = world.component(i);
        if (c.table == kNoIndex || c.quarantined) continue;
        const TypeInfo& info = world.table_of(i).type().info;
        std::vector<Block*>& blocks = of_table[c.table];
        blocks.resize(info.commands.size(), nullptr);
        for (std::size_t k = 0; k < info.commands.size(); ++k)
        {
            const CommandInfo& command = info.commands[k];
            if (!(c.commands & (1ull << k)) || !command.run) continue;
            if (!blocks[k])
            {
                blocks[k] = &found[static_cast<std::size_t>(command.phase)][{info.name, k}];
                blocks[k]->table = c.table, blocks[k]->command = &command, blocks[k]->alone = measured_alone(info);
            }
            blocks[k]->rows.push_back(c.row);
        }
    }
    Schedule schedule;
    for (std::size_t phase = 0; phase < found.size(); ++phase)
        for (auto& [key, block] : found[phase]) schedule.blocks[phase].push_back(std::move(block));
    return schedule;
}

}  // namespace plab::simulation
