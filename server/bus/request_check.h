/// What a request must be before anybody looks at what it asks for. Sense is judged elsewhere, form here.
#pragma once

#include <string_view>

#include "idl/plab.h"
#include "plab/result.h"
#include "publish/records.h"

namespace plab::bus
{

/// UTF-8 as RFC 3629 has it: no overlong forms, no surrogates, nothing above U+10FFFF.
bool is_utf8(std::string_view text);

/// Who asks, and with which number.
publish::ClientId client_of(const plab_v2_Request& request);

/// What the limit on the text of all waiting requests counts: each text costs 32 bytes more than it has, about what it
/// takes to keep it, so that the limit bounds the number of empty ones too.
std::size_t bytes_of(const publish::RequestText& request);

/// One operation, and that is to end the server, and no more is said.
bool is_shutdown(const publish::RequestText& request);

/// The request with its text copied, or the first thing that is wrong with it. Reads no more of an oversized request
/// than the limit.
Result<publish::RequestText> read_request(const plab_v2_Request& request);

}  // namespace plab::bus
