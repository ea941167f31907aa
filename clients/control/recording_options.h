/// Shared by the commands that read recordings.
#pragma once

#include "control/context.h"
#include "control/recordings/log.h"

namespace plab::cli
{

void add_file(const Command& command, std::string& file);
/// --from and --to.
void add_span(const Command& command, recordings::Span& span);
/// Reports what could not be read. Failed if there is anything: the result is incomplete.
Exit warn(const Context& context, const recordings::Troubles& troubles);

}  // namespace plab::cli
