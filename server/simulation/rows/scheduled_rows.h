/// The components whose commands emit rows in one phase, and where shafts are replaced by the roots of their trains.
#pragma once

#include <span>
#include <vector>

#include "plab/rows.h"
#include "simulation/costs/cost_meter.h"
#include "simulation/groups/groups.h"
#include "simulation/groups/schedule.h"

namespace plab::simulation
{

/// Some rows of the tables that take part in a phase, by block.
class ScheduledRows
{
public:
    void select(world::World& world, const Schedule& schedule, Phase phase, std::span<const BlockRow> rows);
    bool empty() const { return count_ == 0; }
    /// Runs their commands, block by block. `meter`: where their time is booked; null: their caller does that.
    void run(const StepContext& context, RowSink& sink, CostMeter* meter) const;

private:
    struct Selected
    {
        const Block* block = nullptr;
        std::vector<Row> rows;
    };
    world::World* world_ = nullptr;
    std::vector<BlockRow> sorted_;
    std::vector<Selected> selected_;  // only the first count_ are valid
    std::size_t count_ = 0;
};

/// Replaces a shaft by the root of its train. Returns false if there was nothing to replace.
bool replace_by_root(RowBlock& block, const Shafts& shafts);

}  // namespace plab::simulation
