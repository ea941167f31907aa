#include "simulation/stepper.h"

#include <algorithm>
#include <chrono>

#include "simulation/step_tree.h"

namespace plab::simulation
{
namespace
{

std::uint64_t now_ns()
{
    return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
}

}  // namespace

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
    frame_ = {&world_, &schedule_, &groups_, &graph_, &start_, start_time, dt, tick, world_.scene().settings.seed};
    for (const StepNode& node : kStepTree)
        if ((this->*node.needed)()) (this->*node.run)();
    ++cost_.steps;
    cost_.total += now_ns() - before;
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
    std::vector<std::uint32_t>& members = island_;
    std::vector<std::uint32_t>& prescribed = shadows_;
    members.clear(), prescribed.clear();
    for (const std::uint32_t i : world_.in_id_order())
    {
        const world::Component& c = world_.component(i);
        if (c.facet == Facet::Shaft) (shafts.dynamic(c.host_index) ? members : prescribed).push_back(c.host_index);
    }
    ShaftCoupling& coupling = speed_coupling_;
    coupling.begin_speeds(graph_, shafts, members, prescribed);
    StepContext context;
    context.time = frame_.start_time, context.dt = frame_.step, context.tick = frame_.tick, context.seed = frame_.seed;
    PhaseCall call;
    call.context = &context, call.shaft_motion = &coupling;
    const CouplingReport done = coupling.solve([&] {
        for (const Block& block : schedule_.of(Phase::Couple))
        {
            world::Table& table = *world_.tables()[block.table];
            context.component_of_row = table.component_of_row(), context.facet_of_row = table.host_of_row();
            call.rows = block.rows;
            (void)block.command->run(call, table.rows());
        }
    });
    coupling.store_speeds(shafts);
    coupling.account(work_, 1.0);
    report_.coupling_residual = std::max(report_.coupling_residual, done.converged ? 0.0 : done.residual);
    if (!done.conflict) return;
    Event e;
    e.time = frame_.start_time, e.kind = "coupling.conflict", e.severity = Severity::Warning;
    e.component = done.conflict->second;
    e.message = "drives " + world_.id_of(Ref{Facet::Shaft, done.conflict->shaft}) + " against " + world_.id_of(done.conflict->first) +
                ", which is obeyed";
    emit(std::move(e));
}

void Stepper::finish()
{
    reactions_.clear();
    if (!groups_.all.empty() && !world_.host().shafts.motion.empty())
        for (const auto& system : batch_systems_) reactions_.add(system->coupling());
    StepContext context;
    context.time = frame_.start_time + frame_.step, context.dt = frame_.step, context.tick = frame_.tick, context.seed = frame_.seed;
    context.events = this;
    PhaseCall call;
    call.context = &context;
    call.bodies = &world_.host().bodies, call.shafts = &world_.host().shafts, call.shapes = &world_.host().shapes;
    call.reactions = &reactions_;
    for (const Block& block : schedule_.of(Phase::Finish))
    {
        world::Table& table = *world_.tables()[block.table];
        context.component_of_row = table.component_of_row(), context.facet_of_row = table.host_of_row();
        call.rows = block.rows;
        timed(block, [&] { (void)block.command->run(call, table.rows()); });
    }
}

std::uint64_t Stepper::state_hash() const
{
    std::uint64_t h = world_.state_hash(0xcbf29ce484222325ull);
    ByteWriter bytes;
    cache_.save(world_, bytes);
    return world::hash_bytes(h, bytes.bytes());
}

}  // namespace plab::simulation
