#include "simulation/step/stepper.h"

#include <utility>

namespace plab::simulation
{

/// Calls the block's command for all of its rows together, or for one row at a time if the cost of each is measured.
void Stepper::run_block(const Block& block, StepContext& context, PhaseCall& call)
{
    world::Table& table = *step_.world.tables()[block.table];
    context.component_of_row = table.component_of_row(), context.facet_of_row = table.host_of_row();
    step_.meter.ran(block.table, block.command->phase);
    if (!block.alone)
    {
        const CostScope scope(step_.meter, step_.meter.of_table(block.table));
        call.rows = block.rows;
        (void)block.command->run(call, table.rows());
        return;
    }
    for (const Row& row : block.rows)
    {
        const CostScope scope(step_.meter, step_.meter.of_component(context.component_of_row[row]));
        call.rows = Rows(&row, 1);
        (void)block.command->run(call, table.rows());
    }
}

/// Runs all blocks of a phase. `context` and `call` hold what this phase gets in addition to the world's tables.
void Stepper::run_blocks(Phase phase, StepContext& context, PhaseCall& call)
{
    context.seed = step_.frame.seed, context.events = &step_;
    call.context = &context;
    for (const Block& block : step_.schedule.of(phase)) run_block(block, context, call);
}

void Stepper::collect_cost()
{
    step_.report.evaluations += std::exchange(motion_.scratch().evaluations, 0) + advance_.batches().take_evaluations();
    step_.meter.stop();
    cost_.book(step_.meter.accounts());
}

void Stepper::retire(std::uint32_t component)
{
    if (component >= step_.work.size()) return;
    departed_work_ += std::exchange(step_.work[component], 0.0);
    cost_.forget(component);
    step_.contact_energy[component] = {};
    step_.reported.contradictory[component] = 0;
}

std::uint64_t Stepper::state_hash() const { return book_.cache().state_hash(step_.world, step_.world.state_hash(0xcbf29ce484222325ull)); }

void Stepper::search_as(const Stepper& whole, Tick tick, double start_time, double step)
{
    continue_after(tick, start_time, step);
    book_.search_as(whole.book_);
}

// The nodes of the step tree -------------------------------------------------------------------------------------------

void Stepper::save_start() { motion_.save_start(); }

void Stepper::drive()
{
    changes_.clear();
    StepContext context = step_.context();
    context.changes = &changes_, context.interruption = interruption_;
    PhaseCall call = step_.call();
    run_blocks(Phase::Drive, context, call);
    if (!changes_.empty() && apply_changes_ && !step_.frame.give_up()) apply_changes_(changes_owner_, changes_);
}

void Stepper::couple_speeds()
{
    Shafts& shafts = step_.world.host().shafts;
    if (!step_.graph.consistent(shafts)) step_.graph.engage(shafts, &step_.work);
    if (step_.schedule.of(Phase::Couple).empty()) return;
    StepContext context = step_.context();
    context.seed = step_.frame.seed;
    const CouplingReport done = speed_system_.solve_speeds(context, shafts, step_.work);
    coupling_watch_.report(step_.world, speed_system_, done, step_.frame.start_time, step_, step_.reported.contradictory);
}

void Stepper::advance_all() { advance_.advance_all(); }

void Stepper::locate_events()
{
    if (!locator_) locator_.emplace(step_, motion_, book_, forces_, advance_);
    locator_->run(book_.found());
}

void Stepper::finish_contacts()
{
    if (forces_.any()) forces_.finish_step(book_.found());
    hard_.finish_step();
}

void Stepper::finish()
{
    StepContext context = step_.context();
    context.time += step_.frame.step;
    PhaseCall call = step_.call();
    call.reactions = &motion_.reactions(), call.row_reports = &motion_.row_reports();
    run_blocks(Phase::Finish, context, call);
}

void Stepper::draw()
{
    const Sight sight = sight_.view_of(step_.world);
    StepContext context = step_.context();
    context.time += step_.frame.step;
    PhaseCall call;
    call.sight = &sight, call.images = images_;
    run_blocks(Phase::Draw, context, call);
}

}  // namespace plab::simulation
