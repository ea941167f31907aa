/// The torques that couplings transmit at the end of a step, for Phase::Finish.
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
    /// Removes the torques of the previous step.
    void clear();
    /// Adds the results of a solve at acceleration level: the torque of each coupling of the graph (redundant ones have none), of
    /// pairwise couplings and of drives. Several groups may be added.
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
