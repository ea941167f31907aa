/// What the commands that read recordings have in common.
#pragma once

#include "control/context.h"
#include "recordings/log.h"

namespace plab::control
{

void add_file(CLI::App& command, std::string& file);
/// --from and --to.
void add_span(CLI::App& command, recordings::Span& span);
/// Says what could not be read. Failed if there is anything: what was asked for is not complete.
Exit warn(const Context& context, const recordings::Troubles& troubles);

}  // namespace plab::control
