/// Where a step began, to go back there when it is given up half way.
#pragma once

#include <vector>

#include "simulation/step/stepper.h"

namespace plab::simulation
{

/// Everything that the phases of a step may change, bit for bit; keeps its memory, so that taking one is a copy of arrays. What only
/// scripts and requests change (parameters, structure) is not in it.
class StepMemento
{
public:
    void save(const world::World& world, const Stepper& stepper);
    /// The stepper is built anew: what a step that was broken off left in its working memory is of no use.
    void restore(world::World& world, Stepper& stepper) const;

private:
    world::MotionMemento motion_;
    ByteWriter cells_;  ///< states and outputs
    ContactCache contacts_;
    std::vector<double> work_;
    std::vector<ContactEnergy> contact_energy_;
    double departed_work_ = 0, requests_work_ = 0;
    Reported reported_;
    std::vector<std::uint32_t> split_;
    StepFrame frame_;
};

}  // namespace plab::simulation
