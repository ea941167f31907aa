// The forces on the members of a system: which ones act, and their evaluation at a stage of the solver.
#include <algorithm>
#include <functional>

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
        s.block = &blocks[merged_[i].block];
        s.rows.clear();
        for (const std::uint32_t block = merged_[i].block; i < merged_.size() && merged_[i].block == block; ++i)
            s.rows.push_back(merged_[i].row);
        make_shortlists(s);
    }
    uniform_ = std::all_of(selected_.begin(), selected_.begin() + static_cast<std::ptrdiff_t>(selected_count_),
                           [&](const Selected& s) { return frame_.world->tables()[s.block->table]->type().info.uniform; });
    for (const std::uint32_t g : groups_) uniform_ = uniform_ && frame_.groups->all[g].couplings.empty();
}

void GroupSystem::make_shortlists(Selected& selected)
{
    constexpr std::size_t kLong = 16;  // for shorter lists a shortlist does not pay
    activate();
    selected.shortlists.clear();
    const world::Table& table = *frame_.world->tables()[selected.block->table];
    for (const Role& role : table.schema().roles())
    {
        if (!role.many || !role.independent) continue;
        for (const Row row : selected.rows)
        {
            const RefList& all = (*role.many)[row];
            if (all.size() <= kLong) continue;
            Shortlist& s = selected.shortlists.emplace_back();
            s.all = &all;
            scratch_->list_active(all, s.active);
        }
    }
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

void GroupSystem::run_forces(double weight)
{
    world::HostTables& host = frame_.world->host();
    const bool booked = book_.work != nullptr && weight != 0;
    StageScratch& scratch = *scratch_;
    Wrenches& wrenches = scratch.wrenches;
    ++scratch.evaluations;
    wrenches.power = booked ? &scratch.power : nullptr;
    wrenches.accounted_bodies = scratch.accounted_bodies, wrenches.accounted_shafts = scratch.accounted_shafts;
    PhaseCall call;
    call.context = &context_;
    call.bodies = &host.bodies, call.shafts = &host.shafts, call.quantities = &host.quantities, call.shapes = &host.shapes;
    call.materials = &host.materials;
    call.wrenches = &wrenches;
    for (std::size_t k = 0; k < selected_count_; ++k)
    {
        const Selected& s = selected_[k];
        const world::Table& table = *frame_.world->tables()[s.block->table];
        context_.component_of_row = table.component_of_row(), context_.facet_of_row = table.host_of_row();
        context_.shortlists = s.shortlists;
        run_force(s, call, booked);
        if (!booked) continue;
        const double share = book_.sign * weight * context_.dt;
        for (const Row row : s.rows)
        {
            const std::uint32_t component = context_.component_of_row[row];
            (*book_.work)[component] += share * scratch.power[component];
            scratch.power[component] = 0;
        }
    }
    if (!extra_) return;
    extra_->add(context_, wrenches);
    if (booked) extra_->book(context_, *book_.work, scratch.power, book_.sign * weight * context_.dt);
}

/// Forces report problems as events, not as errors. Solvers with error control make many short trial evaluations, so only one of kOneOf
/// is timed.
void GroupSystem::run_force(const Selected& s, PhaseCall& call, bool booked)
{
    constexpr std::uint64_t kOneOf = 8;
    CostMeter& meter = scratch_->meter();
    void* const rows = frame_.world->tables()[s.block->table]->rows();
    meter.ran(s.block->table, Phase::Force);
    if (s.block->alone)
    {
        for (const Row& row : s.rows)
        {
            const CostScope scope(meter, meter.of_component(context_.component_of_row[row]));
            call.rows = Rows(&row, 1);
            (void)s.block->command->run(call, rows);
        }
        return;
    }
    call.rows = s.rows;
    const bool timed = booked || scratch_->evaluations % kOneOf == 0;
    if (timed) meter.enter(meter.of_table(s.block->table));
    (void)s.block->command->run(call, rows);
    if (timed) meter.leave(booked ? 1 : kOneOf);
}

}  // namespace plab::simulation
