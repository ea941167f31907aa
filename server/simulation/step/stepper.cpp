#include "simulation/step/stepper.h"

#include <utility>

#include "simulation/costs/measured_call.h"

namespace plab::simulation
{

/// Runs all blocks of a phase. `call` has what this phase gets.
void Stepper::run_blocks(Phase phase, world::CommandCall& call)
{
    call.context.seed = step_.frame.seed, call.context.events = &step_;
    for (const Block& block : step_.schedule.of(phase))
    {
        call.select(*step_.world.tables()[block.table]);
        run_measured(call, block, block.rows, step_.meter);
    }
}

void Stepper::collect_cost()
{
    step_.report.evaluations += std::exchange(motion_.scratch().evaluations, 0) + advance_.batches().take_evaluations();
    motion_.scratch().held_bodies = 0;
    step_.meter.stop();
    // Of a part of the scene nobody asks; the accounts are those of the whole scene, and booking them would cost more than a small part does.
    if (!part_) cost_.book(step_.meter.accounts());
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

bool Stepper::look_again()
{
    if (!book_.looks_among_some()) return false;
    book_.detect_among(nullptr);  // also at those that fell asleep
    book_.detect_all();
    return true;
}

// The nodes of the step tree -------------------------------------------------------------------------------------------

void Stepper::save_start()
{
    const RestState& rest = book_.cache().rest();
    motion_.save_start(rest.changing_since(saved_mark_));
    saved_mark_ = rest.mark;
}

void Stepper::drive()
{
    changes_.clear();
    world::CommandCall call{step_.context(), step_.arguments()};
    call.context.changes = &changes_, call.context.interruption = interruption_, call.context.lookup = &step_.lookup;
    run_blocks(Phase::Drive, call);
    save_driven();
    if (changes_.empty() || !apply_changes_ || step_.frame.give_up()) return;
    apply_changes_(changes_owner_, changes_);
    hard_.note_change();
}

/// Bodies that choose their own velocity for the step (a user's hand) move from their present pose with the new one.
void Stepper::save_driven()
{
    for (const Block& block : step_.schedule.of(Phase::Drive))
    {
        const world::Table& table = *step_.world.tables()[block.table];
        if (table.type().info.facet != Facet::Body) continue;
        for (const Row row : block.rows) motion_.save_start_of(table.host_of_row()[row]);
    }
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
    if (book_.log().on()) sleeping_contacts_.finish_step();
}

void Stepper::finish()
{
    world::CommandCall call{step_.context(), step_.arguments()};
    call.context.time += step_.frame.step;
    call.context.lookup = &step_.lookup;
    call.arguments.reactions = &motion_.reactions(), call.arguments.row_reports = &motion_.row_reports();
    if (touches_.wanted()) touches_.collect();
    call.arguments.touches = &touches_;
    run_blocks(Phase::Finish, call);
}

void Stepper::draw()
{
    const RenderScene render_scene = render_scene_.view_of(step_.world);
    world::CommandCall call{step_.context(), {}};
    call.context.time += step_.frame.step;
    call.arguments.render_scene = &render_scene, call.arguments.images = images_;
    run_blocks(Phase::Draw, call);
}

}  // namespace plab::simulation
