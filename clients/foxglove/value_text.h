/// JSON as the values of a request are written.
#pragma once

#include <optional>
#include <string>

#include "idl/json/json.h"

namespace plab::foxglove
{

/// Numbers without loss, lists with spaces. Nothing: it is no such value.
std::optional<std::string> value_text(const wire::Json& value);

}  // namespace plab::foxglove
