/// Requests that components of the scene make in their own name (Phase::Decide): the words of a client's request, in one line.
#pragma once

#include "model/compile.h"
#include "simulation/run/run.h"

namespace plab::control
{

/// Reads verb, target and argument as RequestSink::ask() gets them:
///
///   add FILE         argument: a blueprint, XML text; the file's name is for messages and may be empty
///   remove ID        no argument
///   swap ID          argument: the new type, then NAME=VALUE ...
///   set ID           argument: NAME=VALUE ...
///   push ID          argument: NAME=VALUE ..., as a client's push
///   pause, resume, step, rate, dt   as a client's
///
/// Other verbs are refused: a component cannot begin another run, end the server, or keep snapshots. `types` must outlive the result.
simulation::RequestReader component_request_reader(model::TypeSource& types, const model::CompileLimits& limits);

}  // namespace plab::control
