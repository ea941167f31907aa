#include "simulation/rows/scheduled_rows.h"

#include <algorithm>

#include "simulation/costs/measured_call.h"

namespace plab::simulation
{

void ScheduledRows::select(world::World& world, const Schedule& schedule, Phase phase, std::span<const BlockRow> rows)
{
    world_ = &world;
    sorted_.assign(rows.begin(), rows.end());
    std::sort(sorted_.begin(), sorted_.end());
    sorted_.erase(std::unique(sorted_.begin(), sorted_.end()), sorted_.end());
    const auto& blocks = schedule.of(phase);
    if (selected_.size() < blocks.size()) selected_.resize(blocks.size());
    count_ = 0;
    for (std::size_t i = 0; i < sorted_.size();)
    {
        Selected& s = selected_[count_++];
        s.block = &blocks[sorted_[i].block];
        s.rows.clear();
        for (const std::uint32_t block = sorted_[i].block; i < sorted_.size() && sorted_[i].block == block; ++i)
            s.rows.push_back(sorted_[i].row);
    }
}

void ScheduledRows::run(const StepContext& context, RowSink& sink, CostMeter* meter) const
{
    world::HostTables& host = world_->host();
    world::CommandCall call{context, {}};
    PhaseCall& to = call.arguments;
    to.bodies = &host.bodies, to.shafts = &host.shafts, to.shapes = &host.shapes, to.materials = &host.materials;
    to.quantities = &host.quantities, to.rows_out = &sink;
    for (std::size_t k = 0; k < count_; ++k)
    {
        const Selected& s = selected_[k];
        call.select(*world_->tables()[s.block->table]);
        if (meter)
            run_measured(call, *s.block, s.rows, *meter);
        else
            (void)call.run(*s.block->command, s.rows);  // rows report problems as events, not as errors
    }
}

bool replace_by_root(RowBlock& block, const Shafts& shafts)
{
    if (block.participant.facet != Facet::Shaft || !block.participant.valid()) return false;
    const std::uint32_t shaft = block.participant.index, root = shafts.root[shaft];
    if (root == shaft) return false;
    block.angular.x *= shafts.ratio[shaft];
    block.participant.index = root;
    return true;
}

}  // namespace plab::simulation
