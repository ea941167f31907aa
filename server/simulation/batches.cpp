// The whole step in one go for everybody: groups in batches, one batch for each thread.
#include <algorithm>
#include <map>

#include "simulation/stepper.h"

namespace plab::simulation
{

GroupSystem& Stepper::system_for(std::span<const std::uint32_t> groups, std::span<const std::uint32_t> shadows)
{
    GroupSystem& system = pool_.of(frame_, groups, shadows);
    system.set_extra_forces(extra_);
    return system;
}

void Stepper::plan_batches()
{
    // One batch for each thread, in whole clusters: what reads another group must share its stage times. Partition never
    // shows in the state: groups do not feel one another, and a solver whose choices depend on its whole system gets each
    // cluster by itself.
    std::vector<std::size_t> weight(groups_.clusters, 0);
    std::size_t total = 0;
    for (const Group& g : groups_.all)
    {
        const std::size_t load = g.bodies.size() + g.shafts.size() + g.quantities.size() + 1;
        weight[g.cluster] += load;
        total += load;
    }
    std::vector<std::vector<std::uint32_t>> members(groups_.clusters);
    std::vector<std::uint32_t> clusters;  // in the order of their first group
    for (std::uint32_t g = 0; g < groups_.all.size(); ++g)
    {
        if (members[groups_.all[g].cluster].empty()) clusters.push_back(groups_.all[g].cluster);
        members[groups_.all[g].cluster].push_back(g);
    }
    batches_.clear();
    std::map<std::uint32_t, std::size_t> home;
    for (const std::uint32_t c : clusters)
    {
        const std::uint32_t solver = groups_.all[members[c].front()].solver;
        // A solver that keeps something between advances serves its clusters one after the other, in one order.
        const bool keeps = solver != kNoIndex && !world_.type_of(solver)->info.elementwise;
        const auto known = keeps ? home.find(solver) : home.end();
        Batch& batch = known != home.end() ? batches_[known->second] : lightest_batch(total);
        if (keeps) home.emplace(solver, static_cast<std::size_t>(&batch - batches_.data()));
        batch.load += weight[c];
        const bool alone = std::any_of(members[c].begin(), members[c].end(), [&](std::uint32_t g) { return goes_alone(groups_.all[g]); });
        batch.add(members[c], solver, !alone);
    }
    for (Batch& batch : batches_)
    {
        batch.scratch = std::make_unique<StageScratch>();
        batch.scratch->fit(world_);
        batch.work.assign(work_.size(), 0.0);
        for (Batch::Part& part : batch.parts)
        {
            part.system = std::make_unique<GroupSystem>(*batch.scratch);
            part.system->configure(frame_, part.groups);
        }
    }
}

Batch& Stepper::lightest_batch(std::size_t total_load)
{
    const auto threads = static_cast<std::size_t>(workers_.threads());
    for (Batch& batch : batches_)
        if (batch.load * threads < total_load) return batch;
    if (batches_.size() < threads) return batches_.emplace_back();
    return *std::min_element(batches_.begin(), batches_.end(), [](const Batch& x, const Batch& y) { return x.load < y.load; });
}

void Batch::add(std::span<const std::uint32_t> cluster, std::uint32_t solver, bool together)
{
    const auto same = together ? std::find_if(parts.begin(), parts.end(), [&](const Part& p) { return p.solver == solver; }) : parts.end();
    Part& part = same != parts.end() ? *same : parts.emplace_back();
    part.solver = solver;
    part.groups.insert(part.groups.end(), cluster.begin(), cluster.end());
    std::sort(part.groups.begin(), part.groups.end());
}

void Stepper::run_batch(Batch& batch, std::vector<double>& work)
{
    for (Batch::Part& part : batch.parts)
    {
        // The frame is new in each step; its pointers are the same.
        part.system->set_frame(frame_);
        part.fine = run_solver(*part.system, part.solver, 0, frame_.step, {&work, 1}, &batch.events);
    }
}

void Stepper::emit_in_order()
{
    // In an order that no partition shows in.
    std::vector<Event> all;
    for (Batch& batch : batches_)
    {
        std::move(batch.events.events.begin(), batch.events.events.end(), std::back_inserter(all));
        batch.events.events.clear();
    }
    const auto key = [&](const Event& e) { return std::pair(e.time, e.component == kNoIndex ? kNoIndex : world_.rank(e.component)); };
    std::stable_sort(all.begin(), all.end(), [&](const Event& x, const Event& y) { return key(x) < key(y); });
    for (Event& event : all) emit(std::move(event));
}

void Stepper::advance_batches()
{
    if (!batches_ready_) plan_batches();
    batches_ready_ = true;
    const bool alone = batches_.size() == 1;
    if (alone)
        run_batch(batches_.front(), work_);
    else
        workers_.run(batches_.size(), [this](std::size_t b) { run_batch(batches_[b], batches_[b].work); });
    emit_in_order();
    for (Batch& batch : batches_)
    {
        for (Batch::Part& part : batch.parts)
        {
            if (!part.fine) freeze(*part.system);
            part.system->add_reactions(reactions_);
            part.system->add_reports(row_reports_);
        }
        if (alone) continue;
        for (std::size_t i = 0; i < work_.size(); ++i) work_[i] += batch.work[i];
        std::fill(batch.work.begin(), batch.work.end(), 0.0);
    }
}

}  // namespace plab::simulation
