/// What plabctl prints with --json.
#pragma once

#include "control/console/console.h"
#include "link/json.h"

namespace plab::cli
{

using link::Json;
using link::json_of;
using link::line_of;

/// Prints one object, on one line.
inline void print(const Console& console, const Json& json) { console.out(line_of(json) + "\n"); }

}  // namespace plab::cli
