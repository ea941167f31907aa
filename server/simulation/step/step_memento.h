/// The state at the start of a step, to be restored if the step is aborted.
#pragma once

#include <vector>

#include "simulation/step/stepper.h"

namespace plab::simulation
{

/// Everything that the phases of a step may change, bit for bit. It keeps its memory, so that saving is a copy of arrays. Parameters and
/// structure, which only scripts and requests change, are not included.
class StepMemento
{
public:
    void save(const world::World& world, const Stepper& stepper);
    /// Also rebuilds the stepper, because an aborted step leaves its working memory in an undefined state.
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
