/// The template of a rule: blueprint text in which ${...} stands for what is known of the two objects.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "plab/result.h"
#include "plab/value.h"

namespace plab::rules
{

/// What a name stands for; no value: nothing.
using Known = std::function<std::optional<Value>(std::string_view)>;

/// Whether each ${...} is closed and is a name or an expression.
Result<void> check_template(std::string_view text);
/// The text with each ${...} replaced: a name by its value, an expression by its number, in all digits. Texts are escaped for XML.
Result<std::string> fill_template(std::string_view text, const Known& known);
/// An expression by the same names.
Result<double> number_of(std::string_view expression, const Known& known);
/// In all digits.
std::string in_digits(double value);
/// The id of the first component in the text; empty: it has none.
std::string first_id(std::string_view blueprint);

}  // namespace plab::rules
