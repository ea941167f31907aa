/// What became of a request, as the reply of the wire.
#pragma once

#include "idl/values/values.h"
#include "simulation/requests/requests.h"

namespace plab::control
{

wire::SwapReport report_of(const simulation::SwapReport& swap);
/// Without what only the server knows: whose request it was, the run, the time, and how long it waited.
wire::Reply reply_of(const simulation::Reply& reply);

}  // namespace plab::control
