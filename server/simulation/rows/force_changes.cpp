#include "simulation/rows/force_changes.h"

#include "plab/row_speed.h"

namespace plab::simulation
{

class ForceChanges::Sink final : public RowSink
{
public:
    Sink(std::vector<ConstraintRow>& out, const world::HostTables& host, double ahead) : out_(out), host_(host), ahead_(ahead) {}
    void begin(std::uint32_t component) override { component_ = component; }
    void add(const ConstraintRow& row) override
    {
        ConstraintRow& mine = out_.emplace_back(row);
        mine.component = component_, mine.impulse = 0;
        for (std::uint32_t k = 0; k < mine.count; ++k) (void)replace_by_root(mine.blocks[k], host_.shafts);
        mine.rate = speed_of(mine, host_.bodies, host_.shafts), mine.error = -ahead_ * mine.rate;
    }

private:
    std::vector<ConstraintRow>& out_;
    const world::HostTables& host_;
    double ahead_;
    std::uint32_t component_ = kNoIndex;
};

void ForceChanges::configure(world::World& world, const Schedule& schedule, std::span<const BlockRow> forces)
{
    world_ = &world;
    chosen_.clear(), rows_.clear();
    const auto &by_force = schedule.of(Phase::Force), &blocks = schedule.of(Phase::Linearize);
    for (const BlockRow& force : forces)
    {
        const std::uint32_t table = by_force[force.block].table;
        for (std::uint32_t b = 0; b < blocks.size(); ++b)
            if (blocks[b].table == table) chosen_.push_back({b, force.rank, force.row});
    }
    scheduled_.select(world, schedule, Phase::Linearize, chosen_);
}

void ForceChanges::collect(const StepContext& context, double ahead, CostMeter& meter)
{
    rows_.clear();
    if (empty()) return;
    Sink sink(rows_, world_->host(), ahead);
    scheduled_.run(context, sink, &meter);
}

}  // namespace plab::simulation
