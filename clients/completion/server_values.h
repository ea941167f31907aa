/// What stands for servers, ids and cameras on the command line of a client that is being typed. Silent: without an answer there are no
/// candidates.
#pragma once

#include "link/catalogue.h"
#include "program/completion.h"

namespace plab::completion
{

/// The process ends soon, whatever hangs: the terminal goes on.
void limit_time();

/// `options`, with what the line says of server, domain and interface.
link::SessionOptions options_on(const program::Wanted& wanted, link::SessionOptions options);

/// What the server reports about its scene; empty if there is no answer.
link::CatalogueContents snapshot_of(const link::SessionOptions& options, link::Parts parts);
/// Ids of objects and of interactions, with their types.
std::vector<program::Candidate> ids_in(const link::CatalogueContents& now);

/// What all clients have: --server, --interface; --object and --track (ids), --camera; names of files.
program::Values common_values(const program::Wanted& wanted, const link::SessionOptions& options);

}  // namespace plab::completion
