#include "simulation/step/stepper.h"

#include <algorithm>
#include <utility>

#include "simulation/step/step_tree.h"

namespace plab::simulation
{
/// Calls the block's command for its rows: together, or one by one where each is measured.
void Stepper::run_block(const Block& block, StepContext& context, PhaseCall& call)
{
    world::Table& table = *world_.tables()[block.table];
    context.component_of_row = table.component_of_row(), context.facet_of_row = table.host_of_row();
    meter_.ran(block.table, block.command->phase);
    if (!block.alone)
    {
        const CostScope scope(meter_, meter_.of_table(block.table));
        call.rows = block.rows;
        (void)block.command->run(call, table.rows());
        return;
    }
    for (const Row& row : block.rows)
    {
        const CostScope scope(meter_, meter_.of_component(context.component_of_row[row]));
        call.rows = Rows(&row, 1);
        (void)block.command->run(call, table.rows());
    }
}

void Stepper::emit(Event event)
{
    event.tick = frame_.tick;
    events_.push_back(std::move(event));
}

void Stepper::step(Tick tick, double start_time, double dt)
{
    meter_.start();
    ++serial_;
    events_.clear(), releases_.clear();
    report_ = {};
    reactions_.clear();
    if (!schedule_.of(Phase::Constrain).empty()) row_reports_.clear(world_.components().size());
    frame_ = {&world_,   &schedule_,          &groups_, &graph_, &start_, start_time, dt, tick, world_.scene().settings.seed, interruption_,
              progress_, &told_.contradictory};
    if (interruption_) interruption_->forget_heeded();
    for (std::size_t i = 0; i < std::size(kStepTree) && !frame_.give_up(); ++i)
    {
        const StepNode& node = kStepTree[i];
        if (!(this->*node.needed)()) continue;
        if (progress_) progress_->enter(static_cast<std::uint8_t>(i), now_ns());
        (this->*node.run)();
    }
    collect_cost();
}

void Stepper::collect_cost()
{
    report_.evaluations += std::exchange(pool_.scratch().evaluations, 0);
    for (Batch& batch : batches_)
        if (batch.scratch) report_.evaluations += std::exchange(batch.scratch->evaluations, 0);
    meter_.stop();
    cost_.book(meter_.accounts());
}

void Stepper::save_start()
{
    start_.save(world_.host());
    if (!rewinds_possible_) return;
    segment_.save(world_.host());
    std::fill(segment_begin_.begin(), segment_begin_.end(), 0.0);
}

void Stepper::drive()
{
    changes_.clear();
    StepContext context;
    context.time = frame_.start_time, context.dt = frame_.step, context.tick = frame_.tick, context.seed = frame_.seed;
    context.events = this, context.changes = &changes_, context.interruption = interruption_;
    PhaseCall call;
    call.context = &context;
    call.bodies = &world_.host().bodies, call.shafts = &world_.host().shafts, call.shapes = &world_.host().shapes;
    call.quantities = &world_.host().quantities;
    for (const Block& block : schedule_.of(Phase::Drive)) run_block(block, context, call);
    if (!changes_.empty() && apply_changes_ && !frame_.give_up()) apply_changes_(changes_owner_, changes_);
}

void Stepper::couple_speeds()
{
    Shafts& shafts = world_.host().shafts;
    if (!graph_.consistent(shafts)) graph_.engage(shafts, &work_);
    if (schedule_.of(Phase::Couple).empty()) return;
    StepContext context;
    context.time = frame_.start_time, context.dt = frame_.step, context.tick = frame_.tick, context.seed = frame_.seed;
    const CouplingReport done = speed_system_.solve_speeds(context, shafts, work_);
    coupling_watch_.tell(world_, speed_system_, done, frame_.start_time, *this, told_.contradictory);
}

void Stepper::draw()
{
    const Sight sight = sight_.look(world_);
    StepContext context;
    context.time = frame_.start_time + frame_.step, context.dt = frame_.step, context.tick = frame_.tick, context.seed = frame_.seed;
    context.events = this;
    PhaseCall call;
    call.context = &context;
    call.sight = &sight, call.images = images_;
    for (const Block& block : schedule_.of(Phase::Draw)) run_block(block, context, call);
}

void Stepper::finish()
{
    StepContext context;
    context.time = frame_.start_time + frame_.step, context.dt = frame_.step, context.tick = frame_.tick, context.seed = frame_.seed;
    context.events = this;
    PhaseCall call;
    call.context = &context;
    call.bodies = &world_.host().bodies, call.shafts = &world_.host().shafts, call.shapes = &world_.host().shapes;
    call.quantities = &world_.host().quantities;
    call.reactions = &reactions_, call.row_reports = &row_reports_;
    for (const Block& block : schedule_.of(Phase::Finish)) run_block(block, context, call);
}

std::uint64_t Stepper::state_hash() const { return cache_.state_hash(world_, world_.state_hash(0xcbf29ce484222325ull)); }

}  // namespace plab::simulation
