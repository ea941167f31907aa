/// All commands, in the order of the help.
#pragma once

#include "control/context.h"

namespace plab::control
{

void add_list_commands(CLI::App& app, Context& context);   // servers, objects, interactions, types
void add_show_command(CLI::App& app, Context& context);    // show
void add_watch_command(CLI::App& app, Context& context);   // watch
void add_scene_commands(CLI::App& app, Context& context);  // add, remove, swap, set, push
void add_clock_commands(CLI::App& app, Context& context);  // pause, resume, step, rate, dt, reset, load, shutdown
void add_wait_command(CLI::App& app, Context& context);    // wait

}  // namespace plab::control
