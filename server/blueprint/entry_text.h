/// Entries (a script's declared state) as text: <state name="count">0</state>.
#pragma once

#include <string>
#include <string_view>

#include "plab/result.h"
#include "plab/value.h"

namespace plab::blueprint
{

/// true and false are truth values, numbers are numbers, anything in quotes is a text, and so is any other word; what
/// looks like a number and is none ("1,5", "3 cm", "inf") is refused rather than taken for a text.
Result<std::variant<bool, double, std::string>> parse_entry(std::string_view text);

/// The text that parse_entry() reads as the same value; texts are always quoted.
std::string format_entry(const std::variant<bool, double, std::string>& value);

}  // namespace plab::blueprint
