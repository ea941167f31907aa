#include "simulation/shafts/shaft_system.h"

#include <algorithm>

#include "world/command_call.h"

namespace plab::simulation
{

ShaftSystem::Part& ShaftSystem::part_of_cluster(std::uint32_t cluster)
{
    const std::uint32_t i = clusters_.add(cluster);
    if (i < count_) return parts_[i];
    if (count_ == parts_.size()) parts_.emplace_back();
    Part& part = parts_[count_++];
    part.members.clear(), part.prescribed.clear(), part.couplings.clear();
    part.begun = false;
    return part;
}

void ShaftSystem::configure(const world::World& world, const Schedule& schedule, const Groups& groups,
                            std::span<const std::uint32_t> members, const ConstraintGraph& graph)
{
    world_ = &world, schedule_ = &schedule, graph_ = &graph;
    count_ = 0;
    clusters_.clear(), shafts_.clear(), part_of_shaft_.clear();
    for (const std::uint32_t g : members)
    {
        const Group& group = groups.all[g];
        if (group.shafts.empty() && group.prescribed_shafts.empty()) continue;
        // Clusters without couplings need no sweeps, so they share one part.
        const bool swept = groups.cluster_has_couplings[group.cluster] != 0;
        Part& part = part_of_cluster(swept ? group.cluster : kNoIndex);
        part.members.insert(part.members.end(), group.shafts.begin(), group.shafts.end());
        part.prescribed.insert(part.prescribed.end(), group.prescribed_shafts.begin(), group.prescribed_shafts.end());
        part.couplings.insert(part.couplings.end(), group.couplings.begin(), group.couplings.end());
    }
    if (count_ == 0) return;
    const auto by_rank = [&](std::uint32_t a, std::uint32_t b) {
        return world.rank(Ref{Facet::Shaft, a}) < world.rank(Ref{Facet::Shaft, b});
    };
    for (std::uint32_t i = 0; i < count_; ++i)
    {
        Part& part = parts_[i];
        part.coupling.configure(part.members, part.prescribed);
        std::sort(part.members.begin(), part.members.end(), by_rank);
        std::sort(part.prescribed.begin(), part.prescribed.end(), by_rank);
        std::sort(part.couplings.begin(), part.couplings.end());
        part.couplings.erase(std::unique(part.couplings.begin(), part.couplings.end()), part.couplings.end());
        for (const auto* list : {&part.members, &part.prescribed})
            for (const std::uint32_t s : *list) set_part(s, i);
    }
}

void ShaftSystem::set_part(std::uint32_t shaft, std::uint32_t part)
{
    const std::uint32_t i = shafts_.add(shaft);
    if (i == part_of_shaft_.size()) part_of_shaft_.emplace_back();
    part_of_shaft_[i] = part;
}

CouplingReport ShaftSystem::sweep(Part& part, const StepContext& outer)
{
    if (part.couplings.empty()) return {};
    world::CommandCall call{outer, {}};
    call.arguments.shaft_motion = &part.coupling;
    const auto& blocks = schedule_->of(Phase::Couple);
    return part.coupling.solve(
        [&]
        {
            for (const BlockRow& row : part.couplings)
            {
                const Block& block = blocks[row.block];
                call.select(*world_->tables()[block.table]);
                (void)call.run(*block.command, Rows(&row.row, 1));
            }
        });
}

void ShaftSystem::solve_accelerations(const StepContext& context, std::span<const double> torque)
{
    for (std::size_t i = 0; i < count_; ++i)
    {
        Part& part = parts_[i];
        part.coupling.begin_accelerations(*graph_, world_->host().shafts, torque, part.members, part.prescribed);
        part.begun = true;
        (void)sweep(part, context);
    }
}

CouplingReport ShaftSystem::solve_speeds(const StepContext& context, Shafts& shafts, std::vector<double>& work)
{
    CouplingReport worst;
    for (std::size_t i = 0; i < count_; ++i)
    {
        Part& part = parts_[i];
        if (part.couplings.empty()) continue;
        part.coupling.begin_speeds(*graph_, shafts, part.members, part.prescribed);
        const CouplingReport report = sweep(part, context);
        part.coupling.store_speeds(shafts);
        part.coupling.account(work, 1.0);
        worst.sweeps = std::max(worst.sweeps, report.sweeps);
        if (report.residual > worst.residual) worst.residual = report.residual;
        worst.converged = worst.converged && report.converged;
        if (report.conflict && !worst.conflict) worst.conflict = report.conflict;
    }
    return worst;
}

double ShaftSystem::rate(std::uint32_t shaft) const { return parts_[part_of(shaft)].coupling.rate({Facet::Shaft, shaft}); }

const ShaftSystem::Part* ShaftSystem::swept_part_of(std::uint32_t shaft) const
{
    const std::uint32_t i = part_of(shaft);
    return i == kNoIndex || parts_[i].couplings.empty() ? nullptr : &parts_[i];
}

double ShaftSystem::scale(std::uint32_t shaft) const
{
    const Part* part = swept_part_of(shaft);
    return part ? part->coupling.scale({Facet::Shaft, shaft}) : 0.0;
}

bool ShaftSystem::yields(std::uint32_t shaft) const
{
    const Part* part = swept_part_of(shaft);
    return part && part->coupling.mobility({Facet::Shaft, shaft}) > 0;
}

void ShaftSystem::account(std::vector<double>& work, double share)
{
    for (std::size_t i = 0; i < count_; ++i) parts_[i].coupling.account(work, share);
}

void ShaftSystem::add_reactions(ShaftTorques& torques) const
{
    for (std::size_t i = 0; i < count_; ++i)
        if (parts_[i].begun) torques.add(parts_[i].coupling);
}

}  // namespace plab::simulation
