/// A call of one component's commands within a step, with the arguments that each such call gets: time and number of the step, where events
/// go, and the host tables. The caller adds the argument of the phase (a sink, an island, an impact).
#pragma once

#include "simulation/motion/step_state.h"
#include "world/command_call.h"

namespace plab::simulation
{

class ComponentCall : public world::CommandCall
{
public:
    ComponentCall(StepState& step, const world::Table& table, Row row) : CommandCall{step.context(), step.arguments()}, row_(row)
    {
        context.events = &step, context.workers = &step.workers;
        select(table);
    }
    ComponentCall(StepState& step, std::uint32_t component)
        : ComponentCall(step, step.world.table_of(component), step.world.component(component).row)
    {
    }

    Result<void> run(const CommandInfo& command) { return CommandCall::run(command, Rows(&row_, 1)); }
    /// Of a phase whose commands report trouble as events only.
    void run(Phase phase) { (void)CommandCall::run(phase, Rows(&row_, 1)); }

private:
    Row row_;
};

}  // namespace plab::simulation
