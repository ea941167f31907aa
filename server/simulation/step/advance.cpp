// Advancing groups over a part of a step, and taking them back.
#include <algorithm>

#include "plab/rotation.h"
#include "simulation/contacts/island_step.h"
#include "simulation/step/stepper.h"

namespace plab::simulation
{

void Stepper::advance_all()
{
    cache_.forget_parked();
    if (forces_.any()) forces_.begin_step();
    if (held_->any()) held_->begin_step();
    const bool contacts_rest =
        held_->holds_joints() || std::any_of(cache_.pairs().begin(), cache_.pairs().end(), [](const PairState& p) { return p.resting; });
    if (contacts_rest || (forces_.any() && forces_.may_touch()) ||
        std::any_of(groups_.all.begin(), groups_.all.end(),
                    [](const Group& g) { return g.solver == kNoIndex && !(g.bodies.empty() && g.shafts.empty() && g.quantities.empty()); }))
    {
        advance(island_all_, 0, frame_.step, {&work_, 1}, false);
    }
    else
        advance_batches();
    if (!rewinds_possible_) return;
    end_.save(world_.host());
    if (forces_.any()) forces_.save_ends();
}

bool Stepper::run_solver(GroupSystem& system, std::uint32_t solver, double from, double to, WorkBook book, EventSink* events)
{
    CostMeter& meter = system.meter();
    const CostScope scope(meter, solver != kNoIndex ? meter.of_component(solver) : meter.accounts().host);
    system.begin(from, to, book, events);
    if (!(to > from))
        system.evaluate(0, 0);  // a piece of no length: forces are wanted, nobody moves, and no solver has to divide by it
    else if (system.needs_solver() && solver != kNoIndex)
    {
        // Of the two that a solver may have, the last one is for any system.
        const auto& commands = world_.type_of(solver)->info.commands;
        const auto command =
            std::find_if(commands.rbegin(), commands.rend(), [](const CommandInfo& c) { return c.phase == Phase::Advance && c.run; });
        if (command != commands.rend()) (void)call_solver(system, solver, *command);
    }
    return system.finish();
}

bool Stepper::call_solver(GroupSystem& system, std::uint32_t solver, const CommandInfo& command)
{
    const world::Component& c = world_.component(solver);
    world::Table& table = *world_.tables()[c.table];
    StepContext context = system.context();  // the solver's own rows: evaluations set it to those of forces
    context.component_of_row = table.component_of_row(), context.facet_of_row = table.host_of_row();
    PhaseCall call;
    call.context = &context;
    call.rows = Rows(&c.row, 1);
    call.system = &system;
    return static_cast<bool>(command.run(call, table.rows()));
}

void Stepper::split_by_contact(std::span<const std::uint32_t> groups)
{
    group_flags_.assign(groups_.all.size(), 0);
    for (const std::uint32_t g : groups) group_flags_[g] = 1;
    for (const PairState& p : cache_.pairs())
        if (p.resting)
            for (const Ref r : {p.a, p.b})
                if (const std::uint32_t g = groups_.of(r); g != kNoIndex && group_flags_[g]) group_flags_[g] = 2;
    for (const std::uint32_t g : groups)
        if (held_->holds_joints_of(g)) group_flags_[g] = 2;
    smooth_.clear(), in_contact_.clear();
    for (const std::uint32_t g : groups)
    {
        const Group& group = groups_.all[g];
        const bool moves = !(group.bodies.empty() && group.shafts.empty());
        (group_flags_[g] == 2 && moves ? in_contact_ : smooth_).push_back(g);
    }
}

void Stepper::collect_shadows(std::span<const std::uint32_t> groups)
{
    group_flags_.assign(groups_.all.size(), 0);
    for (const std::uint32_t g : groups) group_flags_[g] = 1;
    shadows_.clear();
    const auto look = [&](std::uint32_t g)
    {
        for (const std::uint32_t up : groups_.all[g].upstream)
            if (!group_flags_[up]) group_flags_[up] = 1, shadows_.push_back(up);
    };
    for (const std::uint32_t g : groups) look(g);
    for (std::size_t i = 0; i < shadows_.size(); ++i) look(shadows_[i]);
    std::sort(shadows_.begin(), shadows_.end());
}

void Stepper::advance(std::span<const std::uint32_t> groups, double from, double to, WorkBook book, bool trial)
{
    collect_shadows(groups);
    // Whom the members read goes along from where the members are, and comes back to where it had got to.
    if (!shadows_.empty())
    {
        for (const std::uint32_t g : shadows_) rewind(g);
        const bool together = std::all_of(shadows_.begin(), shadows_.end(), [&](std::uint32_t g) { return segment_begin_[g] == 0; });
        if (together && from > 0) advance_smooth(shadows_, {}, 0, from, {}, true);
        for (const std::uint32_t g : shadows_)
            if (!together && segment_begin_[g] < from) advance_smooth(std::span(&g, 1), {}, segment_begin_[g], from, {}, true);
    }
    split_by_contact(groups);
    if (forces_.any())
    {
        forces_.take(groups, smooth_, in_contact_, from, to);
        forces_.advance(shadows_, from, to, book, trial);
    }
    if (!in_contact_.empty()) advance_contacts(in_contact_, shadows_, from, to, book, trial);
    if (!smooth_.empty()) advance_smooth(smooth_, shadows_, from, to, book, trial);
    for (const std::uint32_t g : shadows_) restore_end(g);
}

bool Stepper::goes_alone(const Group& group) const
{
    if (!group.rows.empty()) return true;
    if (group.solver == kNoIndex) return false;
    const TypeInfo& solver = world_.type_of(group.solver)->info;
    if (solver.elementwise) return false;
    // Some solvers treat each body by itself where no force depends on time or state.
    const auto& forces = schedule_.of(Phase::Force);
    const auto is_uniform = [&](const BlockRow& force) { return world_.tables()[forces[force.block].table]->type().info.uniform; };
    const bool free = group.couplings.empty() && !extra_ && std::all_of(group.forces.begin(), group.forces.end(), is_uniform);
    return !(solver.uniform && free);
}

/// Groups that are advanced in one system without changing a bit: those of one elementwise solver; the members of one
/// cluster where the solver looks at its system as a whole, or joints do.
void Stepper::collect_units(std::span<const std::uint32_t> groups)
{
    units_.clear();
    const auto cluster_goes_alone = [&](std::uint32_t cluster)
    {
        return std::any_of(groups.begin(), groups.end(),
                           [&](std::uint32_t g) { return groups_.all[g].cluster == cluster && goes_alone(groups_.all[g]); });
    };
    for (const std::uint32_t g : groups)
    {
        const Group& group = groups_.all[g];
        const std::uint32_t rank = group.solver == kNoIndex ? kNoIndex : world_.rank(group.solver);
        const bool alone = goes_alone(group) || (!group.upstream.empty() && cluster_goes_alone(group.cluster));
        units_.push_back({rank, alone ? group.cluster : kNoIndex, g});
    }
    std::sort(units_.begin(), units_.end());
}

void Stepper::advance_smooth(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> shadows, double from, double to,
                             WorkBook book, bool trial)
{
    collect_units(groups);
    for (std::size_t i = 0; i < units_.size();)
    {
        const std::size_t first = i;
        same_unit_.clear();
        for (; i < units_.size() && units_[i].solver_rank == units_[first].solver_rank && units_[i].cluster == units_[first].cluster; ++i)
            same_unit_.push_back(units_[i].group);
        GroupSystem& system = system_for(same_unit_, shadows);
        const std::uint32_t solver = groups_.all[same_unit_.front()].solver;
        finish_advance(system, run_solver(system, solver, from, to, book, sink_for(trial)), to, trial);
    }
}

void Stepper::finish_advance(GroupSystem& system, bool finite, double to, bool trial)
{
    if (trial) return;
    if (!finite) freeze(system);
    if (to != frame_.step) return;
    system.add_reactions(reactions_);
    system.add_reports(row_reports_);
}

void Stepper::rewind(std::uint32_t g)
{
    const Group& group = groups_.all[g];
    for (const std::uint32_t b : group.bodies) segment_.restore_body(world_.host(), b);
    for (const std::uint32_t s : group.shafts) segment_.restore_shaft(world_.host(), s);
    for (const std::uint32_t q : group.quantities) segment_.restore_quantities(world_.host(), q);
    if (forces_.any()) forces_.rewind(g);
}

void Stepper::save_segment(std::uint32_t g)
{
    const Group& group = groups_.all[g];
    for (const std::uint32_t b : group.bodies) segment_.save_body(world_.host(), b);
    for (const std::uint32_t s : group.shafts) segment_.save_shaft(world_.host(), s);
    for (const std::uint32_t q : group.quantities) segment_.save_quantities(world_.host(), q);
    if (forces_.any()) forces_.save_segment(g);
}

void Stepper::save_end(std::uint32_t g)
{
    const Group& group = groups_.all[g];
    for (const auto* list : {&group.bodies, &group.prescribed_bodies})
        for (const std::uint32_t b : *list) end_.save_body(world_.host(), b);
    for (const auto* list : {&group.shafts, &group.prescribed_shafts})
        for (const std::uint32_t s : *list) end_.save_shaft(world_.host(), s);
    for (const std::uint32_t q : group.quantities) end_.save_quantities(world_.host(), q);
    if (forces_.any()) forces_.save_end(g);
}

void Stepper::restore_end(std::uint32_t g)
{
    const Group& group = groups_.all[g];
    for (const auto* list : {&group.bodies, &group.prescribed_bodies})
        for (const std::uint32_t b : *list) end_.restore_body(world_.host(), b);
    for (const auto* list : {&group.shafts, &group.prescribed_shafts})
        for (const std::uint32_t s : *list) end_.restore_shaft(world_.host(), s);
    for (const std::uint32_t q : group.quantities) end_.restore_quantities(world_.host(), q);
    if (forces_.any()) forces_.restore_end(g);
}

void Stepper::freeze(GroupSystem& system)
{
    world::HostTables& host = world_.host();
    const auto report = [&](Ref ref)
    {
        report_.frozen.push_back(ref);
        Event e;
        e.time = frame_.start_time + frame_.step, e.kind = "state.not_finite", e.severity = Severity::Failure;
        e.component = host.component_of(ref), e.a = ref;
        e.message = world_.id_of(ref) + " left the numbers that a step can compute with; it stays where the step began";
        emit(std::move(e));
    };
    for (const std::uint32_t b : system.bodies())
    {
        if (is_finite(host.bodies, b)) continue;
        start_.restore_body(host, b);
        host.bodies.velocity[b] = host.bodies.angular_velocity[b] = host.bodies.angular_momentum[b] = {};
        report({Facet::Body, b});
    }
    for (const std::uint32_t s : system.shafts())
    {
        if (is_finite(host.shafts, s)) continue;
        start_.restore_shaft(host, s);
        host.shafts.speed[s] = 0;
        report({Facet::Shaft, s});
    }
    for (const std::uint32_t q : system.quantities())
    {
        if (is_finite(host.quantities, q)) continue;
        start_.restore_quantities(host, q);
        report({Facet::Quantities, q});
    }
}

}  // namespace plab::simulation
