// Advancing groups over a part of a step, and taking them back.
#include <algorithm>

#include "plab/rotation.h"
#include "simulation/stepper.h"

namespace plab::simulation
{

void Stepper::advance_all()
{
    const bool contacts_rest = std::any_of(cache_.pairs().begin(), cache_.pairs().end(), [](const PairState& p) { return p.resting; });
    if (contacts_rest || std::any_of(groups_.all.begin(), groups_.all.end(),
                                     [](const Group& g) { return g.solver == kNoIndex && !(g.bodies.empty() && g.shafts.empty()); }))
    {
        advance(island_all_, 0, frame_.step, {&work_, 1}, false);
    }
    else
        advance_batches();
    if (rewinds_possible_) end_.save(world_.host());
}

void Stepper::advance_batches()
{
    if (!batches_ready_)
    {
        plan_batches();
        for (std::size_t b = 0; b < batches_.size(); ++b) batch_systems_[b]->configure(frame_, batches_[b]);
        batches_ready_ = true;
    }
    // The frame is new in each step; its pointers are the same.
    for (std::size_t b = 0; b < batches_.size(); ++b) batch_systems_[b]->set_frame(frame_);
    const auto job = [this](std::size_t b)
    {
        std::vector<double>& work = batches_.size() == 1 ? work_ : batch_work_[b];
        batch_fine_[b] = run_clusters(*batch_systems_[b], batches_[b], {&work, 1}) ? 1 : 0;
    };
    if (batches_.size() == 1)
        job(0);
    else
        workers_.run(batches_.size(), job);
    for (std::size_t b = 0; b < batches_.size(); ++b)
    {
        if (!batch_fine_[b]) freeze(*batch_systems_[b]);
        batch_systems_[b]->add_reactions(reactions_);
        if (batches_.size() == 1) continue;
        for (std::size_t i = 0; i < work_.size(); ++i) work_[i] += batch_work_[b][i];
        std::fill(batch_work_[b].begin(), batch_work_[b].end(), 0.0);
    }
}

bool Stepper::run_clusters(GroupSystem& system, const std::vector<std::uint32_t>& groups, WorkBook book)
{
    return run_solver(system, groups_.all[groups.front()].solver, 0, frame_.step, book, false);
}

bool Stepper::run_solver(GroupSystem& system, std::uint32_t solver, double from, double to, WorkBook book, bool trial)
{
    system.begin(from, to, book, trial ? nullptr : this);
    if (system.needs_solver() && solver != kNoIndex)
    {
        const world::Component& c = world_.component(solver);
        world::Table& table = *world_.tables()[c.table];
        PhaseCall call;
        call.context = &system.context();
        call.rows = Rows(&c.row, 1);
        call.system = &system;
        for (const CommandInfo& command : table.type().info.commands)
            if (command.phase == Phase::Advance && command.run) (void)command.run(call, table.rows());
    }
    return system.finish();
}

void Stepper::split_by_contact(std::span<const std::uint32_t> groups)
{
    group_flags_.assign(groups_.all.size(), 0);
    for (const std::uint32_t g : groups) group_flags_[g] = 1;
    for (const PairState& p : cache_.pairs())
        if (p.resting)
            for (const Ref r : {p.a, p.b})
                if (const std::uint32_t g = groups_.of(r); g != kNoIndex && group_flags_[g]) group_flags_[g] = 2;
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

GroupSystem& Stepper::system_for(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> shadows)
{
    for (Cached& c : cached_systems_)
        if (c.system && std::equal(c.groups.begin(), c.groups.end(), groups.begin(), groups.end()) &&
            std::equal(c.shadows.begin(), c.shadows.end(), shadows.begin(), shadows.end()))
        {
            c.system->set_frame(frame_);
            return *c.system;
        }
    Cached& c = cached_systems_[next_cached_++ % cached_systems_.size()];
    if (!c.system) c.system = std::make_unique<GroupSystem>();
    c.groups.assign(groups.begin(), groups.end());
    c.shadows.assign(shadows.begin(), shadows.end());
    c.system->configure(frame_, groups, shadows);
    return *c.system;
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
    if (!in_contact_.empty()) advance_contacts(in_contact_, shadows_, from, to, book, trial);
    if (!smooth_.empty()) advance_smooth(smooth_, shadows_, from, to, book, trial);
    for (const std::uint32_t g : shadows_) restore_end(g);
}

void Stepper::advance_smooth(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> shadows, double from, double to,
                             WorkBook book, bool trial)
{
    // One system for each solver that occurs, in id order of the solvers.
    solvers_.clear();
    for (const std::uint32_t g : groups)
        if (std::find(solvers_.begin(), solvers_.end(), groups_.all[g].solver) == solvers_.end()) solvers_.push_back(groups_.all[g].solver);
    std::sort(solvers_.begin(), solvers_.end(),
              [&](std::uint32_t a, std::uint32_t b)
              {
                  const auto rank = [&](std::uint32_t s) { return s == kNoIndex ? kNoIndex : world_.rank(s); };
                  return rank(a) < rank(b);
              });
    if (solvers_.size() == 1)
    {
        GroupSystem& system = system_for(groups, shadows);
        finish_advance(system, run_solver(system, solvers_.front(), from, to, book, trial), to, trial);
        return;
    }
    for (std::size_t i = 0; i < solvers_.size(); ++i)
    {
        same_solver_.clear();
        for (const std::uint32_t g : groups)
            if (groups_.all[g].solver == solvers_[i]) same_solver_.push_back(g);
        GroupSystem& system = system_for(same_solver_, shadows);
        finish_advance(system, run_solver(system, solvers_[i], from, to, book, trial), to, trial);
    }
}

void Stepper::finish_advance(GroupSystem& system, bool finite, double to, bool trial)
{
    if (trial) return;
    if (!finite) freeze(system);
    if (to == frame_.step) system.add_reactions(reactions_);
}

void Stepper::rewind(std::uint32_t g)
{
    const Group& group = groups_.all[g];
    for (const std::uint32_t b : group.bodies) segment_.restore_body(world_.host(), b);
    for (const std::uint32_t s : group.shafts) segment_.restore_shaft(world_.host(), s);
}

void Stepper::save_segment(std::uint32_t g)
{
    const Group& group = groups_.all[g];
    for (const std::uint32_t b : group.bodies) segment_.save_body(world_.host(), b);
    for (const std::uint32_t s : group.shafts) segment_.save_shaft(world_.host(), s);
}

void Stepper::save_end(std::uint32_t g)
{
    const Group& group = groups_.all[g];
    for (const auto* list : {&group.bodies, &group.prescribed_bodies})
        for (const std::uint32_t b : *list) end_.save_body(world_.host(), b);
    for (const auto* list : {&group.shafts, &group.prescribed_shafts})
        for (const std::uint32_t s : *list) end_.save_shaft(world_.host(), s);
}

void Stepper::restore_end(std::uint32_t g)
{
    const Group& group = groups_.all[g];
    for (const auto* list : {&group.bodies, &group.prescribed_bodies})
        for (const std::uint32_t b : *list) end_.restore_body(world_.host(), b);
    for (const auto* list : {&group.shafts, &group.prescribed_shafts})
        for (const std::uint32_t s : *list) end_.restore_shaft(world_.host(), s);
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
        e.message = world_.id_of(ref) + " left the finite numbers; it stays where the step began";
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
}

}  // namespace plab::simulation
