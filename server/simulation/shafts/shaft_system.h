/// The coupled shafts of some groups, solved cluster by cluster. Each cluster converges on its own, so the result does not depend on the
/// number of threads or on unrelated clusters.
#pragma once

#include <deque>

#include "simulation/groups/groups.h"
#include "simulation/shafts/shaft_reactions.h"

namespace plab::simulation
{

class ShaftSystem
{
public:
    /// Selects the members and couplings of the groups. Memory is kept between calls.
    void configure(const world::World& world, const Schedule& schedule, const Groups& groups, std::span<const std::uint32_t> members,
                   const ConstraintGraph& graph);
    bool empty() const { return count_ == 0; }
    /// Computes the accelerations under torques (N m, by shaft).
    void solve_accelerations(const StepContext& context, std::span<const double> torque);
    /// Makes the speeds consistent at a step boundary and writes those that changed. Returns the worst report of all clusters.
    CouplingReport solve_speeds(const StepContext& context, Shafts& shafts, std::vector<double>& work);
    /// Of the last solve, rad/s^2.
    double rate(std::uint32_t shaft) const;
    /// Identifies the set of shafts that are swept together with this one.
    std::uint32_t part_of(std::uint32_t shaft) const
    {
        const std::uint32_t i = shafts_.find(shaft);
        return i == kNoIndex ? kNoIndex : part_of_shaft_[i];
    }
    /// After solve_speeds(): the largest |speed| during the sweeps, rad/s; 0 if the shaft is not swept.
    double scale(std::uint32_t shaft) const;
    /// After solve_speeds(): whether pairwise couplings can move the shaft. Prescribed and one-way driven shafts cannot be moved.
    bool yields(std::uint32_t shaft) const;
    void account(std::vector<double>& work, double share);
    void add_reactions(ShaftTorques& torques) const;

private:
    struct Part
    {
        std::vector<std::uint32_t> members, prescribed;  ///< in id order
        std::vector<BlockRow> couplings;
        ShaftCoupling coupling;
        bool begun = false;
    };
    Part& part_of_cluster(std::uint32_t cluster);
    void set_part(std::uint32_t shaft, std::uint32_t part);
    CouplingReport sweep(Part& part, const StepContext& context);
    const Part* swept_part_of(std::uint32_t shaft) const;

    const world::World* world_ = nullptr;
    const Schedule* schedule_ = nullptr;
    const ConstraintGraph* graph_ = nullptr;
    std::deque<Part> parts_;  // a deque, because a coupling keeps the address of its part's members
    std::size_t count_ = 0;
    MemberIndex clusters_;  // their numbers are those of the parts
    MemberIndex shafts_;
    std::vector<std::uint32_t> part_of_shaft_;  // by number of the shaft
};

}  // namespace plab::simulation
