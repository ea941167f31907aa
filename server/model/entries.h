/// Open records (a script's declared state) as one line of text: name=value name=value.
#pragma once

#include <string>
#include <string_view>

#include "plab/schema.h"

namespace plab::model
{

/// Values are numbers, true, false, or texts in single quotes ('' is a quote within one).
Result<Value> parse_entries(std::string_view text, const Field& field);
std::string format_entries(const Entries& entries);

}  // namespace plab::model
