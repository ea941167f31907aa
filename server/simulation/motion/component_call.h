/// A call of a component's commands within a step, with the arguments that each such call gets: time and number of the step, the rows of
/// the component's table, and the host tables. The caller adds the argument of the phase (a sink, an island, an impact).
#pragma once

#include "simulation/motion/step_state.h"

namespace plab::simulation
{

class ComponentCall
{
public:
    ComponentCall(StepState& step, world::Table& table, Row row) : context(step.context()), call(step.call()), table_(table), row_(row)
    {
        context.events = &step, context.workers = &step.workers;
        context.component_of_row = table.component_of_row(), context.facet_of_row = table.host_of_row();
        call.context = &context, call.rows = Rows(&row_, 1);
    }
    ComponentCall(StepState& step, std::uint32_t component)
        : ComponentCall(step, step.world.table_of(component), step.world.component(component).row)
    {
    }
    ComponentCall(const ComponentCall&) = delete;
    ComponentCall& operator=(const ComponentCall&) = delete;

    Result<void> run(const CommandInfo& command) { return command.run(call, table_.rows()); }
    /// Runs all commands of its type for a phase and ignores their results.
    void run(Phase phase)
    {
        for (const CommandInfo& command : table_.type().info.commands)
            if (command.phase == phase && command.run) (void)run(command);
    }

    StepContext context;
    PhaseCall call;

private:
    world::Table& table_;
    Row row_;
};

}  // namespace plab::simulation
