// The forces on the members of a system: which ones act, and their evaluation at a stage of the solver.
#include <algorithm>
#include <functional>
#include <span>

#include "simulation/costs/measured_call.h"
#include "simulation/systems/group_system.h"

namespace plab::simulation
{

void GroupSystem::filter_forces()
{
    merged_.clear();
    for (const std::uint32_t g : groups_)
    {
        const auto& rows = frame_.groups->all[g].forces;
        merged_.insert(merged_.end(), rows.begin(), rows.end());
    }
    std::sort(merged_.begin(), merged_.end());
    merged_.erase(std::unique(merged_.begin(), merged_.end()), merged_.end());

    const auto& blocks = frame_.schedule->of(Phase::Force);
    if (selected_.size() < blocks.size()) selected_.resize(blocks.size());
    selected_count_ = 0;
    for (std::size_t i = 0; i < merged_.size();)
    {
        Selected& s = selected_[selected_count_++];
        s.index = merged_[i].block, s.block = &blocks[s.index];
        s.rows.clear();
        for (; i < merged_.size() && merged_[i].block == s.index; ++i) s.rows.push_back(merged_[i].row);
        make_shortlists(s);
    }
    uniform_ = std::all_of(selected_.begin(), selected_.begin() + static_cast<std::ptrdiff_t>(selected_count_),
                           [&](const Selected& s) { return frame_.world->tables()[s.block->table]->type().info.uniform; });
    for (const std::uint32_t g : groups_) uniform_ = uniform_ && frame_.groups->all[g].couplings.empty();
}

/// Calls visit(list) for each list of participants for which there is a shortlist.
template <class Visit>
void GroupSystem::for_each_long_list(const Selected& selected, Visit visit) const
{
    constexpr std::size_t kLong = 16;  // for shorter lists a shortlist does not pay
    const world::Table& table = *frame_.world->tables()[selected.block->table];
    for (const Role& role : table.schema().roles())
    {
        if (!role.many || !role.independent) continue;
        for (const Row row : selected.rows)
            if (const RefList& all = (*role.many)[row]; all.size() > kLong) visit(all);
    }
}

/// The blocks have moved with the schedule, and so may have the lists of participants, by whose address shortlists are found.
bool GroupSystem::follow_forces()
{
    const auto& blocks = frame_.schedule->of(Phase::Force);
    bool holds = true;
    for (Selected& s : std::span(selected_).first(selected_count_))
    {
        s.block = &blocks[s.index];
        const auto is_listed = [&](const RefList& all)
        { return std::ranges::any_of(s.shortlists, [&](const Shortlist& l) { return l.all == &all; }); };
        for_each_long_list(s, [&](const RefList& all) { holds = holds && is_listed(all); });
    }
    return holds;
}

void GroupSystem::make_shortlists(Selected& selected)
{
    activate();
    selected.shortlists.clear();
    const auto add = [&](const RefList& all)
    {
        Shortlist& s = selected.shortlists.emplace_back();
        s.all = &all;
        scratch_->list_active(all, s.active);
    };
    for_each_long_list(selected, add);
    const auto by_address = [](const Shortlist& a, const Shortlist& b) { return std::less<>()(a.all, b.all); };
    std::sort(selected.shortlists.begin(), selected.shortlists.end(), by_address);
}

void GroupSystem::clear_wrenches()
{
    Wrenches& w = scratch_->wrenches;
    for (const std::uint32_t b : bodies_) w.force[b] = {}, w.torque[b] = {};
    for (const std::uint32_t s : shafts_) w.shaft_torque[s] = 0;
    for (const std::uint32_t q : quantities_) std::fill(w.quantity_rate[q].begin(), w.quantity_rate[q].end(), 0.0);
}

void GroupSystem::book_forces(std::span<const double> moved_with)
{
    world::HostTables& host = frame_.world->host();
    StageScratch& scratch = *scratch_;
    const auto exchange_speeds = [&] { std::ranges::swap_ranges(speeds_, scratch.speeds); };
    scratch.speeds.assign(moved_with.begin(), moved_with.end());
    go_midway();
    exchange_speeds();
    scatter(midway_);
    for (const std::vector<std::uint32_t>* list : {&bodies_, &prescribed_bodies_})
        for (const std::uint32_t b : *list)
        {
            scratch.moved_bodies.position[b] = host.bodies.position[b], scratch.moved_bodies.velocity[b] = host.bodies.velocity[b];
            scratch.moved_bodies.angular_velocity[b] = host.bodies.angular_velocity[b];
        }
    for (const std::vector<std::uint32_t>* list : {&shafts_, &prescribed_shafts_})
        for (const std::uint32_t s : *list) scratch.moved_shafts.speed[s] = host.shafts.speed[s];
    exchange_speeds();
    scatter(midway_);
    clear_wrenches();
    scratch.wrenches.bind(scratch.moved_bodies, scratch.moved_shafts);
    run_forces(1);
    scratch.wrenches.bind(host.bodies, host.shafts);
    for (const std::uint32_t s : shafts_) host.shafts.speed[s] = scratch.moved_shafts.speed[s];
    rates_of_shafts(1);
}

void GroupSystem::run_forces(double weight)
{
    world::HostTables& host = frame_.world->host();
    const bool booked = book_.work != nullptr && weight != 0;
    StageScratch& scratch = *scratch_;
    Wrenches& wrenches = scratch.wrenches;
    ++scratch.evaluations;
    wrenches.power = booked ? &scratch.power : nullptr;
    wrenches.accounted_bodies = scratch.accounted_bodies, wrenches.accounted_shafts = scratch.accounted_shafts;
    // Forces report problems as events, not as errors. Solvers with error control make many short trial evaluations, so only one of kOneOf
    // is timed.
    constexpr std::uint32_t kOneOf = 8;
    const std::uint32_t weight_of_time = booked ? 1 : (scratch.evaluations % kOneOf == 0 ? kOneOf : 0);
    PhaseCall& to = call_.arguments;
    to.bodies = &host.bodies, to.shafts = &host.shafts, to.quantities = &host.quantities, to.shapes = &host.shapes;
    to.materials = &host.materials, to.wrenches = &wrenches;
    for (std::size_t k = 0; k < selected_count_; ++k)
    {
        const Selected& s = selected_[k];
        call_.select(*frame_.world->tables()[s.block->table]);
        call_.context.shortlists = s.shortlists;
        run_measured(call_, *s.block, s.rows, scratch.meter(), weight_of_time);
        if (!booked) continue;
        const double share = book_.sign * weight * call_.context.dt;
        for (const Row row : s.rows)
        {
            const std::uint32_t component = call_.context.component_of_row[row];
            (*book_.work)[component] += share * scratch.power[component];
            scratch.power[component] = 0;
        }
    }
    if (!extra_) return;
    extra_->add(call_.context, wrenches);
    if (booked) extra_->book(call_.context, *book_.work, scratch.power, book_.sign * weight * call_.context.dt);
}

}  // namespace plab::simulation
