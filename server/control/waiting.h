/// Requests that wait for their step, as lines of text (JSON) in the file of a snapshot.
#pragma once

#include <string>

#include "idl/values/values.h"
#include "plab/result.h"

namespace plab::control
{

std::string text_of(const wire::Request& request);
/// Operations, step and revision of a text made by text_of(); the client is not kept.
Result<wire::Request> read_request(const std::string& text);

}  // namespace plab::control
