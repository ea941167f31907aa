/// A call of commands of components of one type, and the only place that fills in what every such call needs: the rows of the type, which
/// component each of them belongs to, and the rows that are meant. The caller adds what the phase needs (host tables, a sink, an island).
#pragma once

#include "world/table.h"

namespace plab::world
{

/// An aggregate, so that the results of functions become its members without a copy: some calls are made for each body and stage.
struct CommandCall
{
    StepContext context;  ///< time and scope of the call
    PhaseCall arguments;  ///< what the phase needs; run() sets the context and the rows
    const Table* selected = nullptr;

    /// The calls that follow go to components of this type.
    void select(const Table& table)
    {
        selected = &table;
        context.component_of_row = table.component_of_row(), context.facet_of_row = table.host_of_row();
    }
    /// Calls one command for some rows of the selected type. Commands that run within a step report trouble as events, so the host may
    /// ignore what they return; those of Init return what is wrong with the scene.
    Result<void> run(const CommandInfo& command, Rows rows)
    {
        arguments.context = &context, arguments.rows = rows;
        return command.run(arguments, selected->rows());
    }
    /// Calls all commands that the type has for a phase, until one fails.
    Result<void> run(Phase phase, Rows rows)
    {
        for (const CommandInfo& command : selected->type().info.commands)
            if (command.phase == phase && command.run)
                if (auto done = run(command, rows); !done) return done;
        return {};
    }
};

}  // namespace plab::world
