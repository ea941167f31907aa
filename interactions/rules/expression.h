/// Arithmetic in templates: + - * / ( ), numbers, and names such as a.radius.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "plab/result.h"

namespace plab::rules
{

/// The value of a name; an error if it has none that is a number.
using Names = std::function<Result<double>(std::string_view)>;

/// Errors: the text is no expression; a name has no value; the result is not finite.
Result<double> evaluate(std::string_view text, const Names& names);
/// Whether the text is an expression; names are not looked up.
Result<void> check_expression(std::string_view text);
/// Whether the text is a single name, which may stand for something that is no number.
bool is_name(std::string_view text);

}  // namespace plab::rules
