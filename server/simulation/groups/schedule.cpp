#include "simulation/groups/schedule.h"

#include <algorithm>
#include <functional>
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

namespace
{

/// Keyed by type name and command number: an order that is the same in every run.
using FoundBlocks = std::array<std::map<std::pair<std::string, std::size_t>, Block>, kPhaseCount>;

/// The blocks of these components, which are in id order.
FoundBlocks blocks_of(const world::World& world, std::span<const std::uint32_t> components)
{
    FoundBlocks found;
    std::vector<std::vector<Block*>> of_table(world.tables().size());  // by command; null until a row needs it
    for (const std::uint32_t i : components)
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
    return found;
}

}  // namespace

Schedule build_schedule(const world::World& world, const Selection* part)
{
    FoundBlocks found = blocks_of(world, part ? part->components : world.in_id_order());
    Schedule schedule;
    for (std::size_t phase = 0; phase < found.size(); ++phase)
        for (auto& [key, block] : found[phase]) schedule.blocks[phase].push_back(std::move(block));
    return schedule;
}

void rebuild_solvers(Schedule& schedule, const world::World& world, const Selection* part)
{
    const auto is_solver = [&](const Block& b) { return world.tables()[b.table]->type().only_advances(); };
    std::vector<std::uint32_t> components;
    for (const auto& table : world.tables())
    {
        if (!table->type().only_advances()) continue;
        for (const std::uint32_t i : table->component_of_row())
            if (i != kNoIndex && (!part || part->flags[i] != 0)) components.push_back(i);
    }
    std::sort(components.begin(), components.end(), [&](std::uint32_t a, std::uint32_t b) { return world.rank(a) < world.rank(b); });
    FoundBlocks found = blocks_of(world, components);
    // As in build_schedule(): the commands of a type lie in the order of their numbers.
    const auto before = [&](const Block& a, const Block& b)
    {
        const std::string &x = world.tables()[a.table]->type().info.name, &y = world.tables()[b.table]->type().info.name;
        return x != y ? x < y : std::less<>()(a.command, b.command);
    };
    for (std::size_t phase = 0; phase < found.size(); ++phase)
    {
        std::vector<Block>& blocks = schedule.blocks[phase];
        std::erase_if(blocks, is_solver);
        if (found[phase].empty()) continue;
        for (auto& [key, block] : found[phase]) blocks.push_back(std::move(block));
        std::sort(blocks.begin(), blocks.end(), before);
    }
}

}  // namespace plab::simulation
