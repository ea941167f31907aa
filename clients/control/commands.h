/// All commands, in the order of the help.
#pragma once

#include "control/context.h"

namespace plab::control
{

void add_list_commands(CLI::App& app, Context& context);       // servers, objects, interactions, types
void add_show_command(CLI::App& app, Context& context);        // show
void add_watch_command(CLI::App& app, Context& context);       // watch
void add_scene_commands(CLI::App& app, Context& context);      // add, remove, swap, set, push
void add_clock_commands(CLI::App& app, Context& context);      // pause, resume, step, rate, dt, reset, load, shutdown
void add_past_commands(CLI::App& app, Context& context);       // snapshot, snapshots, restore, forget, rewind, branch, shadow
void add_wait_command(CLI::App& app, Context& context);        // wait
void add_recording_views(CLI::App& app, Context& context);     // diff, plot, report, log
void add_recording_commands(CLI::App& app, Context& context);  // info, export, recover
void add_record_command(CLI::App& app, Context& context);      // record
void add_play_command(CLI::App& app, Context& context);        // play

}  // namespace plab::control
