/// Torques that couplings transmit at the end of a step, for Phase::Finish.
#pragma once

#include <optional>
#include <vector>

#include "plab/shafts.h"
#include "simulation/shafts/shaft_coupling.h"

namespace plab::simulation
{

class ShaftTorques final : public ShaftReactions
{
public:
    /// Forgets the torques of the step before.
    void clear();
    /// Takes over what a solve at accelerations found: the torque of each coupling of the graph (redundant ones: none),
    /// of pairwise ones and of drives. Solves of several groups add up.
    void add(const ShaftCoupling& coupling);
    std::optional<double> torque(std::uint32_t component) const override;

private:
    void add_tree(const ShaftCoupling& coupling, const ShaftTree& tree);
    void set(std::uint32_t component, double torque);

    std::vector<std::optional<double>> torque_;  // by component
    std::vector<double> own_;                    // by node
    SideSums sums_;
};

}  // namespace plab::simulation
