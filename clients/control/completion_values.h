/// What stands for ids, types, servers, quantities on a command line that is being typed: asked of the server, or of the file that the
/// line names. Silent, and done within a second: without an answer there are no candidates.
#pragma once

#include "link/session.h"
#include "program/completion.h"

namespace plab::cli
{

/// `options`: those of the environment; what the line says of server and domain wins.
program::Values completion_values(const program::Wanted& wanted, link::SessionOptions options);

}  // namespace plab::cli
