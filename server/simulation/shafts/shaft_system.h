/// The coupled shafts of some groups, solved cluster by cluster: what converges in one cluster waits for no other, so
/// neither threads nor bystanders show in the result.
#pragma once

#include <deque>

#include "simulation/groups/groups.h"
#include "simulation/shafts/shaft_reactions.h"

namespace plab::simulation
{

class ShaftSystem
{
public:
    /// Members and couplings of the groups. Keeps its memory from use to use.
    void configure(const world::World& world, const Schedule& schedule, const Groups& groups, std::span<const std::uint32_t> members,
                   const ConstraintGraph& graph);
    bool empty() const { return count_ == 0; }
    /// Accelerations under torques (N m, by shaft).
    void solve_accelerations(const StepContext& context, std::span<const double> torque);
    /// Brings speeds together at a step boundary and writes those that changed. The worst report of all clusters.
    CouplingReport solve_speeds(const StepContext& context, Shafts& shafts, std::vector<double>& work);
    /// Of the last solve; rad/s^2.
    double rate(std::uint32_t shaft) const;
    /// The shafts that sweeps bring together with this one.
    std::uint32_t part_of(std::uint32_t shaft) const { return shaft < part_of_shaft_.size() ? part_of_shaft_[shaft] : kNoIndex; }
    /// After solve_speeds(): the largest |speed| that it had on the way, rad/s; 0 where nothing is swept.
    double scale(std::uint32_t shaft) const;
    /// Likewise: whether pairwise couplings move it. Prescribed motion and one-way drives do not yield.
    bool yields(std::uint32_t shaft) const;
    void account(std::vector<double>& work, double share);
    void add_reactions(ShaftTorques& torques) const;

private:
    struct Part
    {
        std::uint32_t cluster = 0;
        std::vector<std::uint32_t> members, prescribed;  ///< in id order
        std::vector<BlockRow> couplings;
        ShaftCoupling coupling;
        bool begun = false;
    };
    Part& part_of_cluster(std::uint32_t cluster);
    CouplingReport sweep(Part& part, const StepContext& context);
    const Part* swept_part_of(std::uint32_t shaft) const;

    const world::World* world_ = nullptr;
    const Schedule* schedule_ = nullptr;
    const ConstraintGraph* graph_ = nullptr;
    std::deque<Part> parts_;  // a coupling keeps the address of its part's members
    std::size_t count_ = 0;
    std::vector<std::uint32_t> part_of_shaft_;
};

}  // namespace plab::simulation
