/// The commands on a running server, in the order of the help.
#pragma once

#include "control/command/context.h"

namespace plab::cli
{

void add_list_commands(const Command& app, Context& context);    // servers, objects, interactions, types
void add_level_commands(const Command& app, Context& context);   // levels, why
void add_top_command(const Command& app, Context& context);      // top
void add_show_command(const Command& app, Context& context);     // show
void add_watch_command(const Command& app, Context& context);    // watch
const std::vector<std::string>& watch_streams();                 // what it can print
void add_scene_commands(const Command& app, Context& context);   // add, remove, swap, set, push
void add_people_commands(const Command& app, Context& context);  // grab, view
void add_clock_commands(const Command& app, Context& context);   // pause, resume, step, rate, dt, reset, load, shutdown
void add_past_commands(const Command& app, Context& context);    // snapshot, snapshots, restore, forget, rewind, branch, shadow
void add_wait_command(const Command& app, Context& context);     // wait

}  // namespace plab::cli
