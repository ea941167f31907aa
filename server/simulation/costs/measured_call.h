/// A call of a scheduled command, with its time booked to what is called.
#pragma once

#include "simulation/costs/cost_meter.h"
#include "simulation/groups/schedule.h"
#include "world/command_call.h"

namespace plab::simulation
{

/// Calls the block's command for some of its rows: for all together, or for one at a time if the cost of each is measured. The block's
/// table has been selected. Commands of a step report trouble as events, so what they return is ignored. `weight`: of calls by type that
/// are made very often only one of `weight` is timed, and counts for all; 0: this one is not timed.
inline void run_measured(world::CommandCall& call, const Block& block, Rows rows, CostMeter& meter, std::uint32_t weight = 1)
{
    meter.ran(block.table, block.command->phase);
    if (block.alone)
    {
        for (const Row& row : rows)
        {
            const CostScope scope(meter, meter.of_component(call.context.component_of_row[row]));
            (void)call.run(*block.command, Rows(&row, 1));
        }
        return;
    }
    if (weight > 0) meter.enter(meter.of_table(block.table));
    (void)call.run(*block.command, rows);
    if (weight > 0) meter.leave(weight);
}

}  // namespace plab::simulation
