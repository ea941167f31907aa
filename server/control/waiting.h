/// Requests that wait for their step, as lines of text that a snapshot's file keeps (JSON).
#pragma once

#include <string>

#include "publish/records.h"

namespace plab::control
{

std::string text_of(const publish::RequestText& request);
/// Operations, step and revision of a text_of(); who asked is not kept.
Result<publish::RequestText> read_request(const std::string& text);

}  // namespace plab::control
