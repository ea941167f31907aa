#include "simulation/step/step_tree.h"

#include <iterator>

namespace plab::simulation
{

void Stepper::step(Tick tick, double start_time, double dt)
{
    step_.meter.start();
    ++step_.serial;
    step_.events.clear(), book_.begin_step();
    step_.report = {};
    motion_.clear_reports();
    step_.frame = {&step_.world,
                   &step_.schedule,
                   &step_.groups,
                   &step_.graph,
                   &motion_.start(),
                   start_time,
                   dt,
                   tick,
                   step_.world.scene().settings.seed,
                   interruption_,
                   progress_,
                   &step_.reported.contradictory};
    if (interruption_) interruption_->clear_interrupted();
    for (std::size_t i = 0; i < std::size(kStepTree) && !step_.frame.give_up(); ++i)
    {
        const StepNode& node = kStepTree[i];
        if (!(this->*node.needed)()) continue;
        if (progress_) progress_->enter(static_cast<std::uint8_t>(i), now_ns());
        (this->*node.run)();
    }
    collect_cost();
}

}  // namespace plab::simulation
