/// Requests that set nothing but inputs (Field::is_input): the samples of users and viewers, up to a thousand times a second.
///
/// By its declaration an input changes nothing else when it is set: no other component is prepared, nothing is derived from it outside a
/// step, and no energy is put in. So such a request needs no transaction. All values are checked first, and then all of them are written,
/// or none; the cost is that of the values, whatever the size of the scene is.
#pragma once

#include <optional>

#include "simulation/run/run.h"

namespace plab::simulation
{

/// Carries the request out and answers it. Nothing: the request has another operation, or concerns a component that has to be tried anew
/// (quarantined) or that needs to be searched for, and must be carried out as a transaction.
std::optional<Reply> set_inputs(Run& run, const Request& request);

}  // namespace plab::simulation
