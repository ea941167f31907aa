#include "simulation/step/stepper.h"

#include <algorithm>

#include "simulation/clock.h"
#include "simulation/step/step_tree.h"

namespace plab::simulation
{
template <class Body>
void Stepper::timed(const Block& block, Body body)
{
    const std::uint64_t before = now_ns();
    body();
    cost_.by_table[block.table][static_cast<std::size_t>(block.command->phase)] += now_ns() - before;
}

void Stepper::emit(Event event)
{
    event.tick = frame_.tick;
    events_.push_back(std::move(event));
}

void Stepper::step(Tick tick, double start_time, double dt)
{
    const std::uint64_t before = now_ns();
    events_.clear();
    report_ = {};
    reactions_.clear();
    if (!schedule_.of(Phase::Constrain).empty()) row_reports_.clear(world_.components().size());
    frame_ = {&world_, &schedule_, &groups_, &graph_, &start_, start_time, dt, tick, world_.scene().settings.seed, &told_.contradictory};
    for (const StepNode& node : kStepTree)
        if ((this->*node.needed)()) (this->*node.run)();
    collect_cost();
    ++cost_.steps;
    cost_.total += now_ns() - before;
}

void Stepper::collect_cost()
{
    report_.evaluations += pool_.scratch().evaluations;
    pool_.scratch().collect(cost_.by_table);
    for (Batch& batch : batches_)
    {
        if (!batch.scratch) continue;
        report_.evaluations += batch.scratch->evaluations;
        batch.scratch->collect(cost_.by_table);
    }
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
    context.events = this, context.changes = &changes_;
    PhaseCall call;
    call.context = &context;
    call.bodies = &world_.host().bodies, call.shafts = &world_.host().shafts, call.shapes = &world_.host().shapes;
    call.quantities = &world_.host().quantities;
    for (const Block& block : schedule_.of(Phase::Drive))
    {
        world::Table& table = *world_.tables()[block.table];
        context.component_of_row = table.component_of_row(), context.facet_of_row = table.host_of_row();
        call.rows = block.rows;
        timed(block, [&] { (void)block.command->run(call, table.rows()); });
    }
    if (!changes_.empty() && apply_changes_) apply_changes_(changes_owner_, changes_);
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
    for (const Block& block : schedule_.of(Phase::Draw))
    {
        world::Table& table = *world_.tables()[block.table];
        context.component_of_row = table.component_of_row(), context.facet_of_row = table.host_of_row();
        call.rows = block.rows;
        timed(block, [&] { (void)block.command->run(call, table.rows()); });
    }
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
    for (const Block& block : schedule_.of(Phase::Finish))
    {
        world::Table& table = *world_.tables()[block.table];
        context.component_of_row = table.component_of_row(), context.facet_of_row = table.host_of_row();
        call.rows = block.rows;
        timed(block, [&] { (void)block.command->run(call, table.rows()); });
    }
}

std::uint64_t Stepper::state_hash() const { return cache_.state_hash(world_, world_.state_hash(0xcbf29ce484222325ull)); }

}  // namespace plab::simulation
