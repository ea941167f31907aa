#include "simulation/motion/group_motion.h"

#include <algorithm>

#include "world/command_call.h"

namespace plab::simulation
{

void GroupMotion::rebuild(bool rewinds, bool members_only)
{
    rewinds_ = rewinds, members_only_ = members_only && !rewinds;
    segment_begin_.assign(step_.groups.all.size(), 0.0);
    pool_.clear(step_.world);
    row_reports_.clear(step_.world.components().size());
    if (members_only_)
    {
        fit_members(), save_members(start_);
        return;
    }
    for (world::MotionMemento* memento : {&start_, &segment_, &end_})
        if (rewinds_)
            memento->save(step_.world.host());
        else
            memento->fit(step_.world.host());  // within a step it keeps the state at the start of the step
}

void GroupMotion::fit_members()
{
    std::vector<std::uint32_t> bodies, shafts, quantities;
    const auto add = [](const std::vector<std::uint32_t>& from, std::vector<std::uint32_t>& to)
    { to.insert(to.end(), from.begin(), from.end()); };
    for (const Group& g : step_.groups.all)
        add(g.bodies, bodies), add(g.prescribed_bodies, bodies), add(g.shafts, shafts), add(g.prescribed_shafts, shafts),
            add(g.quantities, quantities);
    for (auto* rows : {&bodies, &shafts, &quantities}) std::sort(rows->begin(), rows->end());
    start_.fit_rows(std::move(bodies), std::move(shafts), std::move(quantities));
}

void GroupMotion::save_members(world::MotionMemento& memento) const
{
    const world::HostTables& host = step_.world.host();
    for (const Group& group : step_.groups.all)
    {
        for (const auto* list : {&group.bodies, &group.prescribed_bodies})
            for (const std::uint32_t b : *list) memento.save_body(host, b);
        for (const auto* list : {&group.shafts, &group.prescribed_shafts})
            for (const std::uint32_t s : *list) memento.save_shaft(host, s);
        for (const std::uint32_t q : group.quantities) memento.save_quantities(host, q);
    }
}

void GroupMotion::clear_reports()
{
    reactions_.clear();
    if (!step_.schedule.of(Phase::Constrain).empty()) row_reports_.clear(step_.world.components().size());
}

void GroupMotion::save_start(const std::vector<std::uint32_t>* changed)
{
    if (members_only_)
        save_members(start_);
    else if (changed)
        start_.save_some(step_.world.host(), *changed);
    else
        start_.save(step_.world.host());
    if (!rewinds_) return;
    segment_.save(step_.world.host());
    std::fill(segment_begin_.begin(), segment_begin_.end(), 0.0);
}

void GroupMotion::save_start_of(std::uint32_t body)
{
    if (step_.groups.group_of_body[body] == kNoIndex) return;
    start_.save_body(step_.world.host(), body);
    if (rewinds_) segment_.save_body(step_.world.host(), body);
}

void GroupMotion::save_ends()
{
    if (!rewinds_) return;
    end_.save(step_.world.host());
    if (memory_) memory_->save_ends();
}

void GroupMotion::take_reports(const GroupSystem& system)
{
    system.add_reactions(reactions_);
    system.add_reports(row_reports_);
}

GroupSystem& GroupMotion::system_for(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed)
{
    GroupSystem& system = pool_.of(step_.frame, groups, observed);
    system.set_extra_forces(extra_);
    return system;
}

void GroupMotion::put_prescribed(std::span<const std::uint32_t> groups, double time)
{
    if (groups.empty()) return;
    GroupSystem& system = system_for(groups, {});
    system.begin(time, time, {}, nullptr);
    system.move_prescribed();
}

bool GroupMotion::run_solver(GroupSystem& system, std::uint32_t solver, double from, double to, WorkBook book, EventSink* events)
{
    CostMeter& meter = system.meter();
    const CostScope scope(meter, solver != kNoIndex ? meter.of_component(solver) : meter.accounts().host);
    system.begin(from, to, book, events);
    if (!(to > from))
        system.evaluate(0, 0);  // a piece of zero length: only the forces are evaluated, so that no solver divides by it
    else if (system.needs_solver() && solver != kNoIndex)
    {
        // A solver may have two commands for this phase; the last one accepts any system.
        const auto& commands = step_.world.type_of(solver)->info.commands;
        const auto command =
            std::find_if(commands.rbegin(), commands.rend(), [](const CommandInfo& c) { return c.phase == Phase::Advance && c.run; });
        if (command != commands.rend()) (void)call_solver(system, solver, *command);
    }
    return system.finish();
}

bool GroupMotion::call_solver(GroupSystem& system, std::uint32_t solver, const CommandInfo& command)
{
    world::CommandCall call{system.context(), {}};
    call.arguments.system = &system;
    call.select(step_.world.table_of(solver));
    return static_cast<bool>(call.run(command, Rows(&step_.world.component(solver).row, 1)));
}

bool GroupMotion::goes_alone(const Group& group) const
{
    if (!group.rows.empty()) return true;
    if (group.solver == kNoIndex) return false;
    const TypeInfo& solver = step_.world.type_of(group.solver)->info;
    if (solver.elementwise) return false;
    // Some solvers treat each body by itself if no force depends on time or state.
    const auto& forces = step_.schedule.of(Phase::Force);
    const auto is_uniform = [&](const BlockRow& force) { return step_.world.tables()[forces[force.block].table]->type().info.uniform; };
    const bool free = group.couplings.empty() && !extra_ && std::all_of(group.forces.begin(), group.forces.end(), is_uniform);
    return !(solver.uniform && free);
}

/// Collects the groups that can be advanced in one system without changing a bit of the result: all groups of one elementwise solver; and
/// the members of one cluster, if the solver depends on its whole system or if there are joints.
void GroupMotion::collect_units(std::span<const std::uint32_t> groups)
{
    units_.clear();
    const auto cluster_goes_alone = [&](std::uint32_t cluster)
    {
        return std::any_of(groups.begin(), groups.end(),
                           [&](std::uint32_t g) { return step_.groups.all[g].cluster == cluster && goes_alone(step_.groups.all[g]); });
    };
    for (const std::uint32_t g : groups)
    {
        const Group& group = step_.groups.all[g];
        const std::uint32_t rank = group.solver == kNoIndex ? kNoIndex : step_.world.rank(group.solver);
        const bool alone = goes_alone(group) || (!group.upstream.empty() && cluster_goes_alone(group.cluster));
        units_.push_back({rank, alone ? group.cluster : kNoIndex, g});
    }
    std::sort(units_.begin(), units_.end());
}

void GroupMotion::advance_smooth(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed, double from, double to,
                                 WorkBook book, bool trial)
{
    collect_units(groups);
    for (std::size_t i = 0; i < units_.size();)
    {
        const std::size_t first = i;
        same_unit_.clear();
        for (; i < units_.size() && units_[i].solver_rank == units_[first].solver_rank && units_[i].cluster == units_[first].cluster; ++i)
            same_unit_.push_back(units_[i].group);
        GroupSystem& system = system_for(same_unit_, observed);
        const std::uint32_t solver = step_.groups.all[same_unit_.front()].solver;
        finish_advance(system, run_solver(system, solver, from, to, book, trial ? nullptr : &step_), to, trial);
    }
}

void GroupMotion::finish_advance(GroupSystem& system, bool finite, double to, bool trial)
{
    if (trial) return;
    if (!finite) freeze(system);
    if (to != step_.frame.step) return;
    take_reports(system);
}

void GroupMotion::rewind(std::uint32_t g)
{
    const Group& group = step_.groups.all[g];
    for (const std::uint32_t b : group.bodies) segment_.restore_body(step_.world.host(), b);
    for (const std::uint32_t s : group.shafts) segment_.restore_shaft(step_.world.host(), s);
    for (const std::uint32_t q : group.quantities) segment_.restore_quantities(step_.world.host(), q);
    if (memory_) memory_->rewind(g);
}

void GroupMotion::save_segment(std::uint32_t g)
{
    const Group& group = step_.groups.all[g];
    for (const std::uint32_t b : group.bodies) segment_.save_body(step_.world.host(), b);
    for (const std::uint32_t s : group.shafts) segment_.save_shaft(step_.world.host(), s);
    for (const std::uint32_t q : group.quantities) segment_.save_quantities(step_.world.host(), q);
    if (memory_) memory_->save_segment(g);
}

/// Prescribed objects are saved at the end only: a system sets them from the time (GroupSystem::scatter_prescribed), so
/// a rewind needs no earlier state of them.
void GroupMotion::save_end(std::uint32_t g)
{
    const Group& group = step_.groups.all[g];
    for (const auto* list : {&group.bodies, &group.prescribed_bodies})
        for (const std::uint32_t b : *list) end_.save_body(step_.world.host(), b);
    for (const auto* list : {&group.shafts, &group.prescribed_shafts})
        for (const std::uint32_t s : *list) end_.save_shaft(step_.world.host(), s);
    for (const std::uint32_t q : group.quantities) end_.save_quantities(step_.world.host(), q);
    if (memory_) memory_->save_end(g);
}

void GroupMotion::restore_end(std::uint32_t g)
{
    const Group& group = step_.groups.all[g];
    for (const auto* list : {&group.bodies, &group.prescribed_bodies})
        for (const std::uint32_t b : *list) end_.restore_body(step_.world.host(), b);
    for (const auto* list : {&group.shafts, &group.prescribed_shafts})
        for (const std::uint32_t s : *list) end_.restore_shaft(step_.world.host(), s);
    for (const std::uint32_t q : group.quantities) end_.restore_quantities(step_.world.host(), q);
    if (memory_) memory_->restore_end(g);
}

/// One diverged object must not end the run: it goes back to the start of the step, at rest, while the other members of its system
/// keep their results. The simulation then quarantines it (StepReport::frozen).
void GroupMotion::freeze(const GroupSystem& system)
{
    world::HostTables& host = step_.world.host();
    const auto report = [&](Ref ref)
    {
        step_.report.frozen.push_back(ref);
        Event e;
        e.time = step_.frame.start_time + step_.frame.step, e.kind = "state.not_finite", e.severity = Severity::Failure;
        e.component = host.component_of(ref), e.a = ref;
        e.message =
            step_.world.id_of(ref) + " left the range of numbers that a step can compute with; it is put back to the start of the step";
        step_.emit(std::move(e));
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
