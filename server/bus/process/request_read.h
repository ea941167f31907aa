/// Copies a request out of a DDS sample.
#pragma once

#include "idl/plab.h"
#include "plab/result.h"
#include "publish/records.h"

namespace plab::bus
{

/// Identifies the client.
wire::ClientId client_of(const plab_v2_Request& request);

/// The request with its text copied, or the first error in it. Reads no more of an oversized request than the limit.
Result<wire::Request> read_request(const plab_v2_Request& request);

}  // namespace plab::bus
