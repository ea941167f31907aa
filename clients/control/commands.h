/// All commands, in the order of the help.
#pragma once

#include "control/context.h"

namespace plab::cli
{

void add_list_commands(const Command& app, Context& context);       // servers, objects, interactions, types
void add_show_command(const Command& app, Context& context);        // show
void add_watch_command(const Command& app, Context& context);       // watch
const std::vector<std::string>& watch_streams();                    // what it can print
void add_scene_commands(const Command& app, Context& context);      // add, remove, swap, set, push
void add_clock_commands(const Command& app, Context& context);      // pause, resume, step, rate, dt, reset, load, shutdown
void add_past_commands(const Command& app, Context& context);       // snapshot, snapshots, restore, forget, rewind, branch, shadow
void add_wait_command(const Command& app, Context& context);        // wait
void add_recording_views(const Command& app, Context& context);     // diff, plot, report, log
void add_recording_commands(const Command& app, Context& context);  // info, export, recover
void add_record_command(const Command& app, Context& context);      // record
void add_play_command(const Command& app, Context& context);        // play

}  // namespace plab::cli
