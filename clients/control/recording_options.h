/// What the commands that read recordings have in common.
#pragma once

#include "control/context.h"
#include "recordings/log.h"

namespace plab::cli
{

void add_file(const Command& command, std::string& file);
/// --from and --to.
void add_span(const Command& command, recordings::Span& span);
/// Says what could not be read. Failed if there is anything: what was asked for is not complete.
Exit warn(const Context& context, const recordings::Troubles& troubles);

}  // namespace plab::cli
