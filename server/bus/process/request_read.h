/// A request as DDS gives it, copied.
#pragma once

#include "idl/plab.h"
#include "plab/result.h"
#include "publish/records.h"

namespace plab::bus
{

/// Who asks.
publish::ClientId client_of(const plab_v2_Request& request);

/// The request with its text copied, or the first thing that is wrong with it. Reads no more of an oversized request
/// than the limit.
Result<publish::RequestText> read_request(const plab_v2_Request& request);

}  // namespace plab::bus
