/// The commands that make, play and examine recordings, in the order of the help.
#pragma once

#include "control/command/context.h"

namespace plab::cli
{

void add_file_commands(const Command& app, Context& context);   // info, export, recover
void add_diff_command(const Command& app, Context& context);    // diff
void add_view_commands(const Command& app, Context& context);   // plot, report, log
void add_record_command(const Command& app, Context& context);  // record
void add_play_command(const Command& app, Context& context);    // play

}  // namespace plab::cli
