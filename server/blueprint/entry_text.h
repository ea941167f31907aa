/// Entries (a script's declared state) as text: <state name="count">0</state>.
#pragma once

#include <string>
#include <string_view>

#include "plab/result.h"
#include "plab/value.h"

namespace plab::blueprint
{

/// true and false are truth values, numbers are numbers, and anything in quotes or any other word is a text. What looks like a
/// number but is not one ("1,5", "3 cm", "inf") is refused rather than taken for a text.
Result<std::variant<bool, double, std::string>> parse_entry(std::string_view text);

/// The text that parse_entry() reads as the same value; texts are always quoted.
std::string format_entry(const std::variant<bool, double, std::string>& value);

}  // namespace plab::blueprint
